// Steps chosen by the error.
//
// Explicit pairs: a step of size h whose estimate err (1 at the tolerance, O(h^k)) is above 1 is taken again; the next one is
//   h clip(0.85 err^-a err_before^b, 0.2, 5),   a = 0.7/k,  b = 0.4/k,
// which does not grow after a rejection, (M45). Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I,
// II.4 (PI control: Gustafsson).
//
// Symmetric steps: h = eps / rho at every step, rho carried from one to the next by
//   rho_{n+1/2} = rho_{n-1/2} + eps G(z_n),   G = d/dt log r,   r(z)^2 = |xi|^2 + |xi'|   (1/s^2),
// so that rho follows r, (M46). r is even in time and G odd: the steps of a motion, taken back, are the same, which no controller
// that looks back at an error can do. rho_{1/2} = r(z_0) + eps/2 G(z_0). eps = tolerance^{1/p} for a step of order p.
// Source: Hairer, Soderlind, Explicit, time reversible, adaptive step size control, SIAM J. Sci. Comput. 26 (2005);
// Hairer, Lubich, Wanner, VIII.3.
#pragma once

#include <cmath>

#include <hamel/framework/loop/status.hpp>
#include <hamel/framework/mechanics/equations_of_motion.hpp>
#include <hamel/framework/schemes/problem.hpp>

namespace hamel {

class ErrorControl {
 public:
  explicit ErrorControl(int estimated_order)
      : alpha_(0.7 / estimated_order), beta_(0.4 / estimated_order) {}

  struct Taken {
    Reason reason;
    long rejected;  // steps before it
    bool whole;     // it ends at the limit
  };
  /// A step of size h, and of the time left at most: taken again, smaller, until its error is good. h is then the size of the
  /// next. take_step() says the error of a step of size h; one above 1 leaves the state alone.
  template <class TakeStep>
  Taken take(double& h, double left, double smallest, TakeStep&& take_step) {
    constexpr int most = 100;
    for (int tries = 0; tries < most; ++tries) {
      const double wanted = h;
      const bool whole = std::abs(h) >= std::abs(left);
      if (whole) h = left;
      if (accept(take_step(), h)) {
        if (whole && std::abs(h) < std::abs(wanted)) h = wanted;
        return {Reason::converged, tries, whole};
      }
      if (std::abs(h) < smallest) return {Reason::too_small, tries + 1, false};
    }
    return {Reason::too_many, most, false};
  }

 private:
  // Is a step of size h with this error good? Changes h to the next one, or to that of the repetition.
  bool accept(double error, double& h) {
    if (!(error <= 1)) {
      rejected_ = true;
      h *= std::isfinite(error) ? std::fmax(0.2, 0.85 * std::pow(error, -alpha_)) : 0.2;
      return false;
    }
    error = std::fmax(error, 1e-10);
    const double most = rejected_ ? 1 : 5;
    h *=
        std::fmin(most, std::fmax(0.2, 0.85 * std::pow(error, -alpha_) * std::pow(before_, beta_)));
    before_ = std::fmax(error, 1e-4);
    rejected_ = false;
    return true;
  }

  double alpha_, beta_, before_ = 1e-4;
  bool rejected_ = false;
};

template <class P>
class ReversibleControl {
 public:
  using Node = hamel::Node<P>;
  explicit ReversibleControl(const P& problem)
      : problem_(problem),
        motion_(problem),
        moved_(problem),
        xi_(P::Vector::Zero(problem.dim())),
        rate_(xi_),
        x_rate_(P::State::Zero(problem.state_size())) {}

  /// The size of the step from a node, of the sign of direction.
  double next(const Node& node, double epsilon, double direction) {
    epsilon = std::copysign(epsilon, direction);
    if (!started_) {
      density_ = rate(node) + epsilon / 2 * growth(node);
      started_ = true;
    } else if (direction * direction_ > 0) {
      density_ += epsilon * growth(node);
    }  // else the last step is taken back
    direction_ = direction;
    if (!(density_ > 0)) density_ = rate(node);  // (a rate that falls faster than the steps see)
    return density_ > 0 ? epsilon / density_ : direction;  // at rest: of the last size
  }
  void forget() { started_ = false; }

 private:
  // r.
  double rate(const Node& node) {
    problem_.velocity(node.x, xi_);
    motion_(node.t, node.g, node.x, x_rate_);
    problem_.velocity(x_rate_, rate_);
    return std::sqrt(xi_.squaredNorm() + rate_.norm());
  }
  // G, by a symmetric difference along the motion: odd whatever its error, and wide, so that round-off does not show.
  double growth(const Node& node) {
    const double size = rate(node), d = 0.01 / size;
    const typename P::Vector xi = xi_;
    const typename P::State x_rate = x_rate_;
    double ends[2];
    for (const int sign : {-1, 1}) {
      moved_.t = node.t + sign * d;
      xi_ = (sign * d) * xi;
      problem_.tau(xi_, moved_.g);
      problem_.compose(node.g, moved_.g, moved_.g);
      moved_.x = node.x + (sign * d) * x_rate;
      ends[sign > 0 ? 1 : 0] = rate(moved_);
    }
    return size > 0 ? (std::log(ends[1]) - std::log(ends[0])) / (2 * d) : 0;
  }

  P problem_;
  EquationsOfMotion<P> motion_;
  Node moved_;
  typename P::Vector xi_, rate_;
  typename P::State x_rate_;
  double density_ = 0, direction_ = 0;
  bool started_ = false;
};

}  // namespace hamel
