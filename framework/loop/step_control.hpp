// Sizes of symmetric steps that follow the motion.
//
// h = eps / rho at every step, rho carried from one to the next by
//   rho_{n+1/2} = rho_{n-1/2} + eps G(z_n),   G = d/dt log r,   r(z)^2 = |xi|^2 + |xi'|   (1/s^2),
// so that rho follows r, (M46). r is even in time and G odd: the steps of a motion, taken back, are
// the same, which no controller that looks back at an error can do. rho_{1/2} = r(z_0) + eps/2
// G(z_0). eps = tolerance^{1/p} for a step of order p.
// |v|^2 = v.I v / L^2 is free of the units of lengths and masses. L^2 is the largest inertia of a
// rotation among the coordinates of xi at the start: |v| is that of a turn about it with the same
// energy. Where nothing turns, L^2 = (v.I v + a.I a / kappa^2) / kappa^2, a = xi', v = xi: the
// amplitude of an oscillation of the frequency kappa, the change of a over a first displacement.
// Source: Hairer, Soderlind, Explicit, time reversible, adaptive step size control, SIAM J. Sci.
// Comput. 26 (2005); Hairer, Lubich, Wanner, VIII.3.
#pragma once

#include <cmath>

#include <hamel/framework/metric/equations_of_motion.hpp>
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
  /// The size of the step from a node.
  /// direction: the last step, of the sign of the next; one of the other sign takes it back.
  double next(MotionRate& motion, double epsilon, double direction);
  bool started() const { return started_; }
  void clear_history() { started_ = false; }

 private:
  double density_ = 0, direction_ = 0;
  bool started_ = false;
};

/// Rate of the motion of a problem.
template <class P>
class RateOf final : public MotionRate {
 public:
  using Node = hamel::Node<P>;
  explicit RateOf(const P& problem)
      : problem_(problem),
        motion_(OfMotion<P>(problem)),
        moved_(problem),
        xi_(P::Vector::Zero(problem.dim())),
        rate_(xi_),
        step_(xi_),
        x_rate_(P::State::Zero(problem.state_size())),
        moved_rate_(x_rate_) {}

  /// The node from which it counts; it outlives the calls.
  void look_at(const Node& node) { node_ = &node; }
  /// L, at the node; h: a time over which its motion changes little.
  [[gnu::noinline, gnu::cold]] void set_length(double h) {
    typename P::Matrix inertia(problem_.dim(), problem_.dim());
    problem_.inertia(node_->g, inertia);
    constexpr double turn = 1e-3;
    double largest = 0;
    for (int i = 0; i < problem_.dim(); ++i) {
      step_.setZero();
      step_[i] = turn;
      problem_.tau(step_, moved_.g);
      if (problem_.rotation_angle(moved_.g) > turn / 2) largest = std::fmax(largest, inertia(i, i));
    }
    length_ = largest > 0 ? std::sqrt(largest) : length_of_motion(h);
  }
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
    evaluate(node, x_rate);
    if (!(length_ > 0)) return 0;
    const double v = motion_.size(node.x) / length_;
    return std::sqrt(v * v + motion_.size(x_rate) / length_);
  }
  // The rate of x, and the metric there.
  void evaluate(const Node& node, typename P::State& x_rate) {
    motion_(node.t, node.g, node.x, x_rate);
    if constexpr (!P::left_invariant) {
      if (motion_.gives_accelerations()) motion_.set(node.t, node.g);
    }
  }
  double length_of_motion(double h) {
    rate(*node_, xi_, x_rate_);
    const double v = motion_.size(node_->x), a = motion_.size(x_rate_);
    problem_.velocity(x_rate_, rate_);
    step_ = h * xi_ + (h * h / 2) * rate_;
    problem_.tau(step_, moved_.g);
    problem_.compose(node_->g, moved_.g, moved_.g);
    moved_.t = node_->t;
    moved_.x = h * node_->x + (h * h / 2) * x_rate_;
    const double moved = motion_.size(moved_.x);
    moved_.x = node_->x + h * x_rate_;
    evaluate(moved_, moved_rate_);
    moved_rate_ -= x_rate_;
    const double square = motion_.size(moved_rate_) / moved;  // kappa^2
    return square > 0 ? std::sqrt((v * v + a * a / square) / square) : 0;
  }

  P problem_;
  EquationsOfMotion<OfMotion<P>> motion_;
  const Node* node_ = nullptr;
  Node moved_;
  typename P::Vector xi_, rate_, step_;
  typename P::State x_rate_, moved_rate_;
  double length_ = 0;  // L
};

}  // namespace hamel
