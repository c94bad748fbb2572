// gni: reflect the momentum at the node, then take a free variational step.
//
// The momentum p- = I v- that arrives at a node leaves it as p+ = 2 p~ - p-, p~ = I xi the part of
// p- that no reaction can carry (metric/metric.hpp); as velocities v+ = 2 xi - v-.
// Then the unconstrained step of the cotangent lift, mu0 = p+, p- = mu1: lift of the problem
// without its rows, which starts from v+ and ends in v-. A node carries v-. Order 2 (s = 1/2, or V
// = f = 0 with a symmetric tau). Weakness: |det| of the map is 1, while systems such as Suslov's
// with full inertia contract phase volume, e^{-A t}: the momentum across the constraint, O(h) at
// the start, is multiplied by -e^{+A h} in a step, the nodes see its square, h^2 e^{2 A t}, and
// half the step puts the end of the run off by log(2)/A only. The velocity of a step is admissible
// to O(h) only. A teaching baseline. Measured: tests/verification/baselines.cpp. Source: Ferraro,
// Iglesias, Martin de Diego, Momentum and energy preserving integrators for nonholonomic dynamics,
// Nonlinearity 21 (2008).
#pragma once

#include <hamel/framework/schemes/lift.hpp>

namespace hamel {

struct Gni : SchemeDefaults {
  static std::string name() { return "gni"; }
  static std::string formula() { return "p+ = (2 P - 1)* p-, then the free variational step"; }
  static std::string source() { return "Ferraro, Iglesias, Martin de Diego 2008"; }
  static constexpr std::optional<double> fixed_s = std::nullopt;
  static constexpr ConstraintKept constraint_kept = ConstraintKept::nodes;
  static ClaimedOrder claim(double s, TauTraits tau, bool left_invariant) {
    return {s == 0.5 || (tau.symmetric && left_invariant) ? 2 : 1, false};
  }

  template <class P>
  class Step;
};

template <class P>
class Gni::Step {
  using Free = Lift::General<typename P::Unconstrained>;

 public:
  using Problem = P;
  using Unknown = typename Free::Unknown;
  using Jacobian = typename Free::Jacobian;
  using Node = hamel::Node<P>;

  Step(const P& problem, double s) : problem_(problem), free_(problem.unconstrained(), s) {}

  int size() const { return free_.size(); }
  /// The forces may have changed: an input jumps at the node.
  void clear_history() { free_.clear_history(); }
  void begin(const Node& node, double h) {
    leaving_.t = node.t;
    leaving_.g = node.g;
    velocity(node, velocity_);
    leaving_.x = 2 * velocity_ - node.x;
    free_.begin(leaving_, h);
  }
  void guess(Unknown& x) const { free_.guess(x); }
  double scale_squared() const { return free_.scale_squared(); }
  void residual(const Unknown& x, Unknown& f) const { free_.residual(x, f); }
  void expand(Unknown& z) const { free_.expand(z); }
  bool finish(const Unknown& x, Node& next) const { return free_.finish(x, next); }
  /// The nodal velocity: the admissible part of v-.
  void velocity(const Node& node, typename P::Vector& xi) const {
    place_.set(problem_, node.t, node.g);
    problem_.momentum(place_.inertia, node.x, momentum_);
    place_.admissible(momentum_, xi);
  }

 private:
  P problem_;
  Free free_;
  mutable typename P::Metric place_{problem_};
  Node leaving_{problem_};
  mutable typename P::Vector momentum_ = P::Vector::Zero(problem_.dim()), velocity_ = momentum_;
};

}  // namespace hamel
