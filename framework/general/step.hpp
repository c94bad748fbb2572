// The step of a scheme on a general system: from one node to the next, for sizes known at run time.
//
// A node is (t, g, xi) with A(g) xi = b. begin() takes the node, residual() is the implicit equation
// of the step, finish() the next node. A scheme with no equation has size() = 0.
#pragma once

#include <memory>

#include <Eigen/Core>

#include <hamel/framework/geometry.hpp>
#include <hamel/framework/mechanics.hpp>

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
  /// The squared size of the momenta that the equation balances.
  virtual double scale_squared() const = 0;
  /// F(x), in momenta.
  virtual void residual(const Unknown& x, Unknown& f) const = 0;
  /// F and dF/dx, by central differences, error about 1e-10: it only steers Newton.
  virtual void linearise(const Unknown& x, Unknown& f, Jacobian& j) const;
  /// The next node; false when the step leaves the domain of the retraction.
  virtual bool finish(const Unknown& x, Node& next) const = 0;

 private:
  mutable Unknown shifted_, shifted_f_;
};

/// What a scheme needs to make its step.
struct GeneralSetup {
  std::shared_ptr<const Geometry> geometry;
  std::shared_ptr<const Mechanics> mechanics;
  double s = 0.5;
};

/// Step<n> for the dimension of the system: fixed for 6 (motions of space), at run time otherwise.
template <template <int> class Step>
std::unique_ptr<GeneralStep> make_sized(const GeneralSetup& setup) {
  switch (setup.mechanics->dim()) {
    case 6: return std::make_unique<Step<6>>(setup);
    default: return std::make_unique<Step<Eigen::Dynamic>>(setup);
  }
}

}  // namespace hamel
