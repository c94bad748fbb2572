// The formulas of a mechanism, recorded once and run as programs (framework/graph).
//
// Each function of a state is a program of its own, of which entries that are constant are no part.
// All take one block of numbers, MechanismState: the element, xi, and what is known outside of the
// formulas at that time: coordinates of joints with springs, efforts of motors and of forces
// (force_formulas.hpp), feet of contacts, coordinates and closures of couplings, rates, slopes and
// gaps of prescribed rows.
//
// The accelerations are solved in a frame of the admissible velocities (elimination.hpp): xi' = E
// y'
// + particular of A xi' = db/dt - (dA/dt) xi, and with f the forces, T(xi') the efforts that
// accelerations take (body_formulas.hpp),
//   E^T I E y' = E^T (f - T(particular)),
// by L D L^T within the program. Its pivots are outputs: where one of them has lost nine tenths of
// what it was when it was chosen, another frame is recorded. xi stays the full velocity, so that a
// change of frame is no part of a motion.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <hamel/framework/graph/code.hpp>
#include <hamel/framework/graph/row_fields.hpp>
#include <hamel/framework/lie/geometry.hpp>
#include <hamel/systems/mechanisms/forces.hpp>
#include <hamel/systems/mechanisms/rows.hpp>

namespace hamel::mechanisms {

/// A mechanism, and the rows of ConstraintRows::each() that it keeps, in their order.
struct MechanismParts {
  const Tree& tree;
  const ConstraintRows& rows;
  const Forces& forces;
  const std::vector<int>& kept;
  int holonomic;  // the last so many of them
  const Geometry& geometry;

  size_t state_size() const;
  /// Writes the coordinates that couplings depend on into a state whose element is there.
  void find_coupled(std::span<double> state) const;
  /// Writes the feet of contacts (ground_contact.hpp) at a tree that was placed.
  void find_feet(std::span<double> state) const;
  /// Writes the closures of couplings.
  void find_closures(std::span<double> state) const;

 private:
  size_t first_foot() const;
  size_t first_coupled() const;
};

/// A vector or matrix as a program: its constants, and the places of what it computes. Copies share
/// the program.
class FilledProgram {
 public:
  /// values: column by column, of a recording that is complete when they are first evaluated.
  FilledProgram(std::shared_ptr<const graph::Recording> recording,
                const std::vector<graph::Number>& values);
  bool is_constant() const { return places_.empty(); }
  /// out: entry i at the place to(i).
  template <class To>
  void operator()(const double* state, double* out, const To& to) {
    for (size_t i = 0; i < constants_.size(); ++i) out[to(i)] = constants_[i];
    evaluate(state);
    for (size_t i = 0; i < places_.size(); ++i) out[to(places_[i])] = results_[i];
  }
  void operator()(const double* state, double* out) {
    (*this)(state, out, [](size_t i) { return i; });
  }

 private:
  void evaluate(const double* state);
  std::shared_ptr<const graph::Recording> recording_;
  std::optional<graph::Code> code_;    // made when it is first called
  std::vector<graph::Number> values_;  // at the places
  std::vector<double> constants_;      // 0 at the places
  std::vector<size_t> places_;
  std::vector<double> results_, work_;
};

/// Functions of a state that hold everywhere.
struct MechanismPrograms {
  explicit MechanismPrograms(const MechanismParts& parts);

  FilledProgram inertia;         // n x n
  FilledProgram rows, drift;     // A, k x n; b
  FilledProgram row_values;      // A xi - b
  FilledProgram holonomic;       // phi
  FilledProgram momentum;        // I xi, then 1/2 d(xi^T I xi)
  FilledProgram inertial_force;  // that alone
  FilledProgram applied_force;   // f - dV
  FilledProgram given_force;     // f
  FilledProgram weight;          // what the weights do on xi
  FilledProgram potential;       // V

 private:
  struct Recorded;
  explicit MechanismPrograms(const Recorded& recorded);
};

/// db/dt - (dA/dt) xi, then ad*_xi I xi + F - (dI/dt) xi: recorded apart, as it is half of all and
/// few schemes ask for it.
FilledProgram record_rates(const MechanismParts& parts);

/// The rows that are kept, and what moves the numbers of a state; without values of these.
graph::RowFields record_row_fields(const MechanismParts& parts);

/// The accelerations, in one frame.
class MotionProgram {
 public:
  /// More independent velocities are solved faster by the dense factors (metric/metric.hpp).
  static constexpr int kMostIndependent = 12;

  /// Recorded at a state. Throws std::domain_error where the rows depend on each other there.
  MotionProgram(const MechanismParts& parts, std::span<const double> state);

  /// xi' at a state. False where the frame is lost: nothing is written.
  bool operator()(const double* state, double* xi_rate);

 private:
  static std::shared_ptr<const graph::Program> record(const MechanismParts& parts,
                                                      std::span<const double> state);
  graph::Code code_;
  std::vector<double> pivots_;  // as they were
  std::vector<double> results_, work_;
};

}  // namespace hamel::mechanisms
