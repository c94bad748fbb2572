// lift in the Hamel frame, contracted once: structure constants instead of matrices.
//
// Let A(xi) = dR_xi^-1 = 1 + O + w(x) Q, O odd (linear) and Q even (quadratic) in xi, x =
// |omega|^2, as for exp and Cayley on SO(3) and SE(2), tau symmetric. The end momenta of lift are
// mu0(xi) and mu1 = mu0(-xi), with
//   s = 0, 1, or exp:     mu0 = A(xi)^T p
//   s = 1/2, Cayley:      mu0 = (1 + 2 O + Q + O (1 + Q)^-1 O)^T p at xi/2,
//                         where O (1 + Q)^-1 O = O^2
// (the odd parts of C = (dR_{xi/2} + dR_{-xi/2})^T/2 cancel, and Q is z times a row, O z = -ad_z
// z/2 = 0). Both are p plus a part linear in xi plus a weight times a quadratic one. With xi = h E
// y, p = I E y, y = (u, v) in R^2, E^T I E = Id:
//   E^T mu0 = y + h b(y, y) + h^2 w(h^2 g(y, y)) t(y, y, y),   E^T mu1 = the same with -h,
// where b (2 x 3, on u^2, uv, v^2), t (2 x 4, on u^3, u^2 v, u v^2, v^3) and g (3) are constants of
// the body: b holds the structure constants of the frame. They are found from mu0 itself by
// polarisation at |xi| about 1, with an error of several eps.
#pragma once

#include <utility>

#include <hamel/framework/lie/types.hpp>

namespace hamel {

template <class Problem>
class HamelForm {
  using Tau = typename Problem::Tau;
  using T = typename Problem::Scalar;

 public:
  static constexpr int n = Problem::n;
  using Reduced = VecT<T, 2>;

  /// Does Tau give its weight w(x) and its x = angle_squared(xi), and is m = 2?
  static constexpr bool exists() {
    return Problem::m == 2 && Tau::symmetric && requires(const Vec<n>& xi, double x) {
      Tau::quadratic_weight(x);
      Tau::angle_squared(xi);
    };
  }
  /// Is there one for this s? One half requires w = 1.
  static bool exists(double s) {
    return exists() &&
           (s == 0 || s == 1 || Tau::one_parameter ||
            (s == 0.5 && requires(const Vec<n>& xi) { Tau::solve_even_transposed(xi, s, xi); }));
  }

  /// end_momentum(xi, p): mu0.
  template <class EndMomentum>
  HamelForm(const Problem& problem, const EndMomentum& end_momentum) {
    const double scale = 1 / problem.frame().norm();
    const auto xi_of = [&problem](const Reduced& y) {
      Vec<n> xi;
      problem.velocity(y, xi);
      return xi;
    };
    // (odd, even) parts of E^T mu0 at y.
    const auto parts = [&](double u, double v) {
      const Reduced y(u, v);
      Vec<n> p;
      problem.momentum({}, y, p);
      const Vec<n> xi = scale * xi_of(y);
      const Reduced plus = problem.reduce(end_momentum(xi, p));
      const Reduced minus = problem.reduce(end_momentum(Vec<n>(-xi), p));
      const double x = Tau::angle_squared(xi);
      const Reduced odd = (plus - minus) / (2 * scale);
      const Reduced even = ((plus + minus) / 2 - y) / (scale * scale * Tau::quadratic_weight(x));
      return std::pair{odd, even};
    };
    const auto angle = [&](double u, double v) { return Tau::angle_squared(xi_of({u, v})); };
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

  /// That of bodies in lanes, each with its own.
  template <class One, class Each>
  static HamelForm joined(const Each& each) {
    HamelForm out;
    each(&One::b_, out.b_);
    each(&One::t_, out.t_);
    each(&One::g_, out.g_);
    return out;
  }

  /// For steps of h: before what follows.
  void scale(double h) {
    hb_ = h * b_;
    ht_ = (h * h) * t_;
    hg_ = (h * h) * g_;
  }
  /// E^T mu0.
  Reduced start_momentum(const Reduced& y) const {
    const auto [odd, even] = terms(y);
    return {y[0] + odd[0] + even[0], y[1] + odd[1] + even[1]};
  }
  /// E^T mu1.
  Reduced end_momentum(const Reduced& y) const {
    const auto [odd, even] = terms(y);
    return {y[0] - odd[0] + even[0], y[1] - odd[1] + even[1]};
  }
  /// Is w = 1? Then the derivative of E^T mu0 by y is a polynomial.
  static constexpr bool has_derivative() { return exists() && weight_is_one(); }
  void derivative(const Reduced& y, MatT<T, 2, 2>& out) const {
    const T u = y[0], v = y[1], uu = u * u, uv = u * v, vv = v * v;
    for (int i = 0; i < 2; ++i) {
      const T p_u = 2.0 * hb_(i, 0) * u + hb_(i, 1) * v, p_v = hb_(i, 1) * u + 2.0 * hb_(i, 2) * v;
      const T q_u = 3.0 * ht_(i, 0) * uu + 2.0 * ht_(i, 1) * uv + ht_(i, 2) * vv;
      const T q_v = ht_(i, 1) * uu + 2.0 * ht_(i, 2) * uv + 3.0 * ht_(i, 3) * vv;
      out(i, 0) = p_u + q_u;
      out(i, 1) = p_v + q_v;
    }
    out(0, 0) += 1.0;
    out(1, 1) += 1.0;
  }

 private:
  HamelForm() = default;
  static constexpr bool weight_is_one() {
    return requires { requires Tau::quadratic_weight_is_one; };
  }
  struct Terms {
    Reduced odd, even;
  };
  // h b(y, y) and h^2 w t(y, y, y).
  Terms terms(const Reduced& y) const {
    const T u = y[0], v = y[1], uu = u * u, uv = u * v, vv = v * v, vvv = v * vv;
    const T p0 = hb_(0, 0) * uu + hb_(0, 1) * uv + hb_(0, 2) * vv;
    const T p1 = hb_(1, 0) * uu + hb_(1, 1) * uv + hb_(1, 2) * vv;
    const T q0 = u * (ht_(0, 0) * uu + ht_(0, 1) * uv + ht_(0, 2) * vv) + ht_(0, 3) * vvv;
    const T q1 = u * (ht_(1, 0) * uu + ht_(1, 1) * uv + ht_(1, 2) * vv) + ht_(1, 3) * vvv;
    if constexpr (weight_is_one()) {
      return {{p0, p1}, {q0, q1}};
    } else {
      const auto w = Tau::quadratic_weight(hg_[0] * uu + hg_[1] * uv + hg_[2] * vv);
      return {{p0, p1}, {w * q0, w * q1}};
    }
  }
  template <class>
  friend class HamelForm;
  MatT<T, 2, 3> b_;
  MatT<T, 2, 4> t_;
  VecT<T, 3> g_;
  MatT<T, 2, 3> hb_;  // h b, h^2 t, h^2 g
  MatT<T, 2, 4> ht_;
  VecT<T, 3> hg_;
};

}  // namespace hamel
