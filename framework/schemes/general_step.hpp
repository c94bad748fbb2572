// The step of a scheme on a general system: from one node to the next, for sizes known at run time.
//
// A node is (t, g, xi) with A(g) xi = b. begin() takes the node, residual() is the implicit equation
// of the step, finish() the next node. A scheme with no equation has size() = 0.
#pragma once

#include <memory>

#include <Eigen/Core>

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>

namespace hamel {

/// A node: time, element (as Packing lays it out), admissible body velocity.
struct Node {
  double t = 0;
  Eigen::VectorXd g, xi;
  Eigen::VectorXd memory = {};  // what else a scheme carries from node to node; empty at the start
};

class GeneralStep {
 public:
  // What Newton asks of a step (solvers/newton.hpp).
  using Unknown = Eigen::VectorXd;
  using Jacobian = Eigen::MatrixXd;

  virtual ~GeneralStep() = default;
  virtual int size() const = 0;
  virtual void begin(const Node& node, double h) = 0;
  /// A first x, when there is no history to extrapolate from.
  virtual void guess(Unknown& x) const = 0;
  /// The squared size of the terms that the equation balances, in the units of F.
  virtual double scale_squared() const = 0;
  /// F(x).
  virtual void residual(const Unknown& x, Unknown& f) const = 0;
  /// F and dF/dx, by central differences, error about 1e-10: it only steers the solver.
  void linearise(const Unknown& x, Unknown& f, Jacobian& j) const { differentiate(x, f, j, false); }
  /// Coordinates of corrections in which the Jacobian changes little along a motion: z -> dx, in place.
  virtual void from_frame(Unknown& /*z*/) const {}
  /// F and dF/dz, x + from_frame(z).
  void linearise_in_frame(const Unknown& x, Unknown& f, Jacobian& j) const {
    differentiate(x, f, j, true);
  }
  /// The next node; false when the step leaves the domain of the retraction.
  virtual bool finish(const Unknown& x, Node& next) const = 0;

 private:
  void differentiate(const Unknown& x, Unknown& f, Jacobian& j, bool in_frame) const;
  mutable Unknown direction_, shifted_, shifted_f_;
};

/// What a scheme needs to make its step.
struct GeneralSetup {
  std::shared_ptr<const Geometry> geometry;
  std::shared_ptr<const Mechanics> mechanics;
  double s = 0.5;
};

/// Step<n, k>: fixed for a body of space that rolls (6, 3), at run time otherwise.
template <template <int, int> class Step>
std::unique_ptr<GeneralStep> make_sized(const GeneralSetup& setup) {
  if (setup.mechanics->dim() == 6 && setup.mechanics->rows() == 3) {
    return std::make_unique<Step<6, 3>>(setup);
  }
  return std::make_unique<Step<Eigen::Dynamic, Eigen::Dynamic>>(setup);
}

}  // namespace hamel
