// The one-sided lift equation in the Hamel frame, contracted once: structure constants instead of matrices.
//
// For a retraction whose inverse derivative is quadratic up to a scalar weight (exp and Cayley on SO(3) and
// SE(2)),  (dR_xi^-1)^T p = p + B(xi) p + w(x) Q(xi, xi) p,  x = |omega|^2,  B odd, Q even, and with
// xi = h E y, p = I E y, y = (u, v) in R^2, E^T I E = Id:
//   E^T (dR_xi^-1)^T p = y + h b(y, y) + h^2 w(h^2 g(y, y)) t(y, y, y),
//   E^T (dL_xi^-1)^T p = the same with -h (tau symmetric),
// where b (2 x 3, on u^2, uv, v^2), t (2 x 4, on u^3, u^2 v, u v^2, v^3) and g (3) are constants of the body:
// b holds the structure constants of the frame. They are found from dR^-1 itself by polarisation at
// |xi| about 1, with an error of a few eps.
#pragma once

#include <hamel/framework/schemes/problem.hpp>

namespace hamel {

/// Does Tau give its weight w(x) and its x = angle_squared(xi), and is m = 2?
template <class Problem, class Tau>
inline constexpr bool has_hamel_form = Problem::m_at_compile_time == 2 &&
                                       Tau::symmetric&& requires(const Vec<Problem::n>& xi,
                                                                 double x) {
  Tau::quadratic_weight(x);
  Tau::angle_squared(xi);
};

template <class Problem, class Tau>
class HamelForm {
 public:
  static constexpr int n = Problem::n;
  using Reduced = Vec<2>;

  explicit HamelForm(const Problem& problem) {
    const double scale = 1 / problem.frame.norm();
    // (odd, even) parts of E^T (dR^-1)^T p at y.
    const auto parts = [&](double u, double v) {
      const Reduced y(u, v);
      const Vec<n> xi = scale * problem.velocity(y), p = problem.momentum(y);
      const Reduced plus = problem.reduce(Tau::dtau_right_inverse_transpose(xi, p));
      const Reduced minus = problem.reduce(Tau::dtau_right_inverse_transpose(Vec<n>(-xi), p));
      const double x = Tau::angle_squared(xi);
      const Reduced odd = (plus - minus) / (2 * scale);
      const Reduced even = ((plus + minus) / 2 - y) / (scale * scale * Tau::quadratic_weight(x));
      return std::pair{odd, even};
    };
    const auto angle = [&](double u, double v) {
      return Tau::angle_squared(Vec<n>(problem.velocity(Reduced(u, v))));
    };
    const auto [b_u, t_u] = parts(1, 0);
    const auto [b_v, t_v] = parts(0, 1);
    const auto [b_sum, t_sum] = parts(1, 1);
    const auto [b_difference, t_difference] = parts(1, -1);
    b_.col(0) = b_u;
    b_.col(1) = (b_sum - b_difference) / 2;
    b_.col(2) = b_v;
    t_.col(0) = t_u;
    t_.col(1) = (t_sum - t_difference) / 2 - t_v;
    t_.col(2) = (t_sum + t_difference) / 2 - t_u;
    t_.col(3) = t_v;
    g_ = Vec<3>(angle(1, 0), (angle(1, 1) - angle(1, -1)) / 2, angle(0, 1));
  }

  /// E^T (dR_xi^-1)^T p for h, E^T (dL_xi^-1)^T p for -h.
  Reduced operator()(const Reduced& y, double h) const {
    const double u = y[0], v = y[1], uu = u * u, uv = u * v, vv = v * v, hh = h * h;
    const double w = hh * Tau::quadratic_weight(hh * (g_[0] * uu + g_[1] * uv + g_[2] * vv));
    const double p0 = b_(0, 0) * uu + b_(0, 1) * uv + b_(0, 2) * vv;
    const double p1 = b_(1, 0) * uu + b_(1, 1) * uv + b_(1, 2) * vv;
    const double q0 = u * (t_(0, 0) * uu + t_(0, 1) * uv + t_(0, 2) * vv) + t_(0, 3) * v * vv;
    const double q1 = u * (t_(1, 0) * uu + t_(1, 1) * uv + t_(1, 2) * vv) + t_(1, 3) * v * vv;
    return {u + h * p0 + w * q0, v + h * p1 + w * q1};
  }

 private:
  Mat<2, 3> b_;
  Mat<2, 4> t_;
  Vec<3> g_;
};

}  // namespace hamel
