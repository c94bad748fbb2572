// The equations of motion of a system as formulas of its coordinates and velocities.
//
//   I xi' = change + A^T lambda,   A xi' = row_rates,   A xi = drift
//   change = ad*_xi I xi + F - (dI/dt) xi,   row_rates = db/dt - (dA/dt) xi
// A system that has them derives from HasMotionTerms, and records them when asked.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <hamel/framework/graph/system_formulas.hpp>

namespace hamel::graph {

/// A factor of a group by name: so2, so3, se2, se3, heisenberg, or one whose coordinates are the
/// integrals of its velocities.
struct FactorShape {
  std::string name;
  int dim = 0, columns = 0;
  bool is_shape = false;
};

/// A group as formulas: its factors, and ad*: (ad*_xi mu)_k = sum structure[(i n + j) n + k] xi_i
/// mu_j.
struct GroupShape {
  std::vector<FactorShape> factors;
  std::vector<double> structure;
};

/// The element at coordinates as its group lays it out; 0 for turns of a circle. Throws
/// std::domain_error for a group that is not known as formulas.
std::vector<Number> element_of(const std::vector<FactorShape>& factors,
                               std::span<const Number> coordinates);

/// Inputs of the current recording: t, coordinates, velocities, inputs of the run, by name; and
/// what a group makes of them.
class MotionVariables {
 public:
  using Numbers = std::vector<Number>;

  /// Throws std::domain_error for a group that is not known as formulas.
  MotionVariables(const GroupShape& group, const std::vector<std::string>& coordinates,
                  const std::vector<std::string>& velocities,
                  const std::vector<std::string>& inputs);

  Number t;
  Numbers coordinates, velocities, inputs;
  Numbers element;           ///< as the group lays it out; 0 for turns of a circle
  Numbers coordinate_rates;  ///< C(g) xi
  /// The coordinate of a velocity, in a factor of one coordinate for each velocity.
  Number coordinate(int velocity) const;
  /// In the order of HasSystemFormulas.
  Numbers all() const;

  /// ad*_xi mu.
  Numbers ad_transpose(const Numbers& mu) const;
  /// C(g)^T slope: derivatives by the coordinates as ones along the group.
  Numbers pulled_back(const Numbers& slope) const;

 private:
  void add_rates(const FactorShape& factor, size_t column, size_t velocity);

  GroupShape group_;
};

struct MotionTerms {
  using Numbers = std::vector<Number>;
  std::vector<Numbers> inertia, rows;  // I, A by rows
  Numbers drift, row_rates, change;
};

/// Terms of the formulas of a system, by their derivatives.
MotionTerms terms_of(const SystemFormulas& formulas, const MotionVariables& at);

/// A system that has these terms as formulas of its own, shorter than terms_of().
class HasMotionTerms {
 public:
  virtual ~HasMotionTerms() = default;
  /// Recorded in the current recording. Throws std::domain_error with the reason where the system
  /// has a part that is no formula.
  virtual MotionTerms motion_terms(const MotionVariables& at) const = 0;
};

}  // namespace hamel::graph
