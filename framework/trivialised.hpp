// Derivatives of trivialised maps, from the four things a retraction gives.
//
// Write R = dR tau_z (n x n), D(z, p) = d/dz [ R^-T p ] with p fixed, K(mu) eta = (ad_eta)^T mu,
// f = tau(z). Then, with every covector on the right held fixed,
//   (a)  d/dz [ R^T m ]            = -R^T D(z, R^T m)                  (differentiate R^-T (R^T m) = m)
//   (b)  d/dz [ Ad_f^T m ]         =  K(Ad_f^T m) dL tau_z             (f varies as f dL dz)
//   (c)  d/dz [ Ad_{f^-1}^T mu ]   = -K(Ad_{f^-1}^T mu) R              (f varies as (R dz) f)
//   (d)  d/dz [ dL^T mu ]          = -R^T ( D(z, R^T m) + K(m) R ),  m = Ad_{f^-1}^T mu
// where (d) is (a) and (c) applied to dL^T mu = R^T Ad_{f^-1}^T mu.
#pragma once

#include <hamel/framework/concepts.hpp>

namespace hamel {

/// tau and its right derivative at one point z: what every scheme evaluates there.
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

}  // namespace hamel
