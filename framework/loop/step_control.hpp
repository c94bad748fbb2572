// Sizes of symmetric steps that follow the motion.
//
// h = eps / rho at every step, rho carried from one to the next by
//   rho_{n+1/2} = rho_{n-1/2} + eps G(z_n),   G = d/dt log r,   r(z)^2 = |xi|^2 + |xi'|   (1/s^2),
// so that rho follows r, (M46). r is even in time and G odd: the steps of a motion, taken back, are
// the same, which no controller that looks back at an error can do. rho_{1/2} = r(z_0) + eps/2
// G(z_0). eps = tolerance^{1/p} for a step of order p. Source: Hairer, Soderlind, Explicit, time
// reversible, adaptive step size control, SIAM J. Sci. Comput. 26 (2005); Hairer, Lubich, Wanner,
// VIII.3.
#pragma once

#include <cmath>

#include <hamel/framework/mechanics/equations_of_motion.hpp>
#include <hamel/framework/schemes/problem.hpp>

namespace hamel {

/// r along a motion.
class MotionRate {
 public:
  virtual ~MotionRate() = default;
  /// At the node.
  virtual double here() = 0;
  /// At d seconds from it along the tangent; after here().
  virtual double beside(double d) = 0;
};

class ReversibleControl {
 public:
  /// The size of the step from a node, of the sign of direction.
  double next(MotionRate& motion, double epsilon, double direction);
  void forget() { started_ = false; }

 private:
  double density_ = 0, direction_ = 0;
  bool started_ = false;
};

/// That of a problem.
template <class P>
class RateOf final : public MotionRate {
 public:
  using Node = hamel::Node<P>;
  explicit RateOf(const P& problem)
      : problem_(problem),
        motion_(problem),
        moved_(problem),
        xi_(P::Vector::Zero(problem.dim())),
        rate_(xi_),
        step_(xi_),
        x_rate_(P::State::Zero(problem.state_size())),
        moved_rate_(x_rate_) {}

  /// The node from which it counts; it outlives the calls.
  void look_at(const Node& node) { node_ = &node; }
  double here() override { return rate(*node_, xi_, x_rate_); }
  double beside(double d) override {
    moved_.t = node_->t + d;
    step_ = d * xi_;
    problem_.tau(step_, moved_.g);
    problem_.compose(node_->g, moved_.g, moved_.g);
    moved_.x = node_->x + d * x_rate_;
    return rate(moved_, step_, moved_rate_);
  }

 private:
  double rate(const Node& node, typename P::Vector& xi, typename P::State& x_rate) {
    problem_.velocity(node.x, xi);
    motion_(node.t, node.g, node.x, x_rate);
    problem_.velocity(x_rate, rate_);
    return std::sqrt(xi.squaredNorm() + rate_.norm());
  }

  P problem_;
  EquationsOfMotion<P> motion_;
  const Node* node_ = nullptr;
  Node moved_;
  typename P::Vector xi_, rate_, step_;
  typename P::State x_rate_, moved_rate_;
};

}  // namespace hamel
