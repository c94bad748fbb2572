// Derivatives of trivialised maps: (M36) of framework/schemes/README.md.
//
// R = dR tau_z (n x n), D(z, p) = d/dz [ R^-T p ] with p fixed, K(mu) eta = (ad_eta)^T mu, f =
// tau(z). With every covector on the right held fixed:
//   (a)  d/dz [ R^T m ]           = -R^T D(z, R^T m)       (differentiate R^-T (R^T m) = m)
//   (b)  d/dz [ Ad_f^T m ]        =  K(Ad_f^T m) dL tau_z  (f varies as f dL dz)
//   (c)  d/dz [ Ad_{f^-1}^T mu ]  = -K(Ad_{f^-1}^T mu) R   (f varies as (R dz) f)
//   (d)  d/dz [ dL^T mu ]         = -R^T ( D(z, R^T m) + K(m) R ),  m = Ad_{f^-1}^T mu
// where (d) is (a) and (c) applied to dL^T mu = R^T Ad_{f^-1}^T mu.
#pragma once

#include <hamel/framework/lie/concepts.hpp>
#include <hamel/framework/lie/linear_solve.hpp>

namespace hamel {

/// The momenta of the cotangent lift at the base point, m0 and m1 = m0 + nu, by (M13) of
/// framework/schemes/README.md:
///   s dR_{z0}^T m0 + (1-s) dR_{z1}^T (m0 + nu) = p,            z0 = -s xi, z1 = (1-s) xi
///   m0 = A_0^T q,  q = M^-T (A_1^T p - (1-s) nu),  A_i = dR_{z_i}^-1,  M = s A_1 + (1-s) A_0
/// and at its end mu0 = Ad_{tau(z0)}^T m0 = dL_{z0}^-T q; with a symmetric tau dR_{-z0}^-T q.
/// This is q. No dR is formed. Where A is quadratic, A(xi) = 1 + odd + even (Cayley), the odd
/// parts cancel:
///   M = 1 + s (1-s) even(xi),
/// which the retraction solves in closed form.
template <class Tau, class T = double>
VecT<T, Tau::Group::dim> mixed_momentum(double s,
                                        const VecT<std::type_identity_t<T>, Tau::Group::dim>& xi,
                                        const VecT<std::type_identity_t<T>, Tau::Group::dim>& p,
                                        const VecT<std::type_identity_t<T>, Tau::Group::dim>& nu) {
  using G = typename Tau::Group;
  constexpr int n = G::dim;
  if (s == 0) return Tau::dtau_right_inverse_transpose(xi, p) - nu;
  const VecT<T, n> z1 = (1 - s) * xi;
  VecT<T, n> m = Tau::dtau_right_inverse_transpose(z1, p) - (1 - s) * nu;
  if constexpr (requires { Tau::solve_even_transposed(xi, s, m); }) {
    m = Tau::solve_even_transposed(xi, s * (1 - s), m);
  } else {
    MatT<T, n, n> mix =
        s * Tau::dtau_right_inverse(z1) + (1 - s) * Tau::dtau_right_inverse(VecT<T, n>(-s * xi));
    if constexpr (requires { G::solve_transposed(mix, m); }) m = G::solve_transposed(mix, m);
    else if constexpr (n <= 4) m = (mix.transpose().inverse() * m).eval();
    else {
      mix.transposeInPlace();
      solve_linear(mix.data(), m.data(), n, 1);
    }
  }
  return m;
}
/// Has Tau the momenta of (M50) in closed form? Those at the ends of a step xi about its middle, s
/// = 1/2, with nu = 0:
///   mu0 = dR_{xi/2}^-T q = even + odd,   mu1 = the same with -xi = even - odd.
template <class Tau>
concept has_end_momenta = requires(const Vec<Tau::Group::dim>& xi, Vec<Tau::Group::dim>& part) {
  Tau::end_momenta(xi, xi, part, part);
};
/// m0.
template <class Tau, class T = double>
VecT<T, Tau::Group::dim> base_momentum(double s,
                                       const VecT<std::type_identity_t<T>, Tau::Group::dim>& xi,
                                       const VecT<std::type_identity_t<T>, Tau::Group::dim>& p,
                                       const VecT<std::type_identity_t<T>, Tau::Group::dim>& nu) {
  const VecT<T, Tau::Group::dim> q = mixed_momentum<Tau, T>(s, xi, p, nu);
  if (s == 0) return q;
  return Tau::dtau_right_inverse_transpose(VecT<T, Tau::Group::dim>(-s * xi), q);
}

/// tau and its right derivative at one point z.
template <class Tau>
struct At {
  using G = typename Tau::Group;
  static constexpr int n = G::dim;

  Vec<n> z;
  typename G::template Element<double> f;
  Mat<n, n> right;  // dR tau_z

  explicit At(const Vec<n>& point) : z(point), f(Tau::tau(point)), right(Tau::dtau_right(point)) {}

  /// Ad_f^T m.
  Vec<n> pull(const Vec<n>& m) const { return G::Ad_transpose(f, m); }
  /// Ad_{f^-1}^T mu.
  Vec<n> push(const Vec<n>& mu) const { return G::Ad_transpose(G::inverse(f), mu); }

  /// (a): derivative of dR^T m.
  Mat<n, n> right_transpose_derivative(const Vec<n>& m) const {
    const Vec<n> p = right.transpose() * m;
    return -right.transpose() * Tau::dtau_right_inverse_transpose_derivative(z, p);
  }
  /// (b): derivative of Ad_f^T m, given mu = Ad_f^T m.
  Mat<n, n> pull_derivative(const Vec<n>& mu) const { return G::coad(mu) * Tau::dtau_left(z); }
  /// (c): derivative of m = Ad_{f^-1}^T mu, given m.
  Mat<n, n> push_derivative(const Vec<n>& m) const { return -G::coad(m) * right; }
  /// (d): derivative of dL^T mu, given m = Ad_{f^-1}^T mu.
  Mat<n, n> left_transpose_derivative(const Vec<n>& m) const {
    const Vec<n> p = right.transpose() * m;
    const Mat<n, n> inner = Tau::dtau_right_inverse_transpose_derivative(z, p) + G::coad(m) * right;
    return -right.transpose() * inner;
  }
};

/// (dL_xi)^-1 eta, without the matrix where Tau has it so.
template <class Tau, class T, int N>
Eigen::Matrix<T, N, 1> apply_dtau_left_inverse(const Eigen::Matrix<T, N, 1>& xi,
                                               const Eigen::Matrix<T, N, 1>& eta) {
  if constexpr (requires { Tau::dtau_left_inverse(xi, eta); }) {
    return Tau::dtau_left_inverse(xi, eta);
  } else {
    return Tau::dtau_left_inverse(xi).lazyProduct(eta);
  }
}

/// tau(xi), and (dL_xi)^-1 eta in `rate` (which may be eta): what a stage of an explicit scheme
/// needs, evaluated together where Tau has it so.
template <class Tau, class T, int N>
auto tau_with_rate(const Eigen::Matrix<T, N, 1>& xi, const Eigen::Matrix<T, N, 1>& eta,
                   Eigen::Matrix<T, N, 1>& rate) {
  if constexpr (requires { Tau::tau_with_rate(xi, eta, rate); }) {
    return Tau::tau_with_rate(xi, eta, rate);
  } else {
    rate = apply_dtau_left_inverse<Tau>(xi, eta);
    return Tau::tau(xi);
  }
}

}  // namespace hamel
