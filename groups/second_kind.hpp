// Canonical coordinates of the second kind and their symmetric version. (M35) of
// framework/schemes/README.md.
//
//   second_kind             tau(xi) = exp(xi_1 e_1) exp(xi_2 e_2) ... exp(xi_n e_n)
//   second_kind_symmetric   tau(xi) = exp(xi_1 e_1/2) ... exp(xi_n e_n) ... exp(xi_1 e_1/2)
// Only the second is symmetric. On SO(2) and R^n both are exp.
//
// Derivatives. A product of stages k = 1, 2, ... has coordinate i_k and weight c_k in stage k. With
// a_k = Ad_{product of the stages before k} e_{i_k}:
//   dR                  = sum_k c_k a_k e_{i_k}^T
//   d a_k / d xi_j      = sum_{l < k, i_l = j} c_l [a_l, a_k]
//   d/dxi_j [dR^-T p]   = -dR^-T (d dR/dxi_j)^T y,   y = dR^-T p
//
// All inverses are closed forms. On SO(3) the symmetric version has the quaternion (w, x, y, z),
//   w = cos(xi_3/2) cos(xi_2/2) cos(xi_1/2)
//   x = cos(xi_3/2) cos(xi_2/2) sin(xi_1/2)
//   y = cos(xi_3/2) sin(xi_2/2)
//   z = sin(xi_3/2)
// which are spherical coordinates: every rotation by less than pi is reached, without gimbal lock.
// Source: Owren, Marthinsen, Integration methods based on canonical coordinates of the second kind
// (2001).
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <hamel/framework/lie/linear_solve.hpp>

#include <hamel/framework/lie/retraction_defaults.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/retractions.hpp>
#include <hamel/groups/rotation.hpp>

namespace hamel {

/// tau, dR^-1 and its Newton derivative for a sequence of one-parameter subgroups.
template <class Derived, class G, bool Symmetric>
struct StagedRetraction : RetractionDefaults<Derived, G> {
  static constexpr int N = G::dim;
  static constexpr bool symmetric = Symmetric;
  static constexpr int stages = Symmetric ? 2 * N - 1 : N;

  static std::string name() { return Symmetric ? "second_kind_symmetric" : "second_kind"; }
  static std::string formula() {
    return Symmetric ? "tau(xi) = exp(xi_1 e_1/2) ... exp(xi_n e_n) ... exp(xi_1 e_1/2)"
                     : "tau(xi) = exp(xi_1 e_1) ... exp(xi_n e_n)";
  }
  static std::string source() {
    return "Owren, Marthinsen, Integration methods based on canonical coordinates of the second "
           "kind (2001)";
  }

  template <class T>
  static typename G::template Element<T> tau(const VecT<T, N>& xi) {
    auto g = step(xi, 0);
    for (int k = 1; k < stages; ++k) g = G::compose(g, step(xi, k));
    return g;
  }
  template <class T>
  static MatT<T, N, N> dtau_right(const VecT<T, N>& xi) {
    return sum(directions(xi));
  }
  template <class T>
  static MatT<T, N, N> dtau_right_inverse(const VecT<T, N>& xi) {
    const MatT<T, N, N> forward = sum(directions(xi));
    return inverse_of(forward);
  }
  template <class T>
  static MatT<T, N, N> dtau_right_inverse_transpose_derivative(const VecT<T, N>& xi,
                                                               const VecT<T, N>& p) {
    const auto a = directions(xi);
    const MatT<T, N, N> forward = sum(a);
    const MatT<T, N, N> back = inverse_of(forward).transpose();
    const MatT<T, N, N> bracket = G::coad(VecT<T, N>(back * p));  // [b, a].y = (K(y) b).a
    MatT<T, N, N> s = MatT<T, N, N>::Zero();
    for (int k = 0; k < stages; ++k) {
      for (int l = 0; l < k; ++l) {
        const VecT<T, N> turned = bracket * a.col(l);
        s(index(k), index(l)) += weight(k) * weight(l) * turned.dot(a.col(k));
      }
    }
    return -(back * s);
  }

 private:
  static constexpr int index(int k) { return k < N ? k : 2 * N - 2 - k; }
  static constexpr double weight(int k) { return Symmetric && index(k) != N - 1 ? 0.5 : 1.0; }

  template <class T>
  static typename G::template Element<T> step(const VecT<T, N>& xi, int k) {
    VecT<T, N> along = VecT<T, N>::Zero();
    along[index(k)] = weight(k) * xi[index(k)];
    return Exp<G>::tau(along);
  }
  template <class T>
  static MatT<T, N, stages> directions(const VecT<T, N>& xi) {
    MatT<T, N, stages> a;
    auto g = G::template identity<T>();
    for (int k = 0; k < stages; ++k) {
      a.col(k) = G::Ad(g).col(index(k));
      if (k + 1 < stages) g = G::compose(g, step(xi, k));
    }
    return a;
  }
  template <class T>
  static MatT<T, N, N> sum(const MatT<T, N, stages>& a) {
    MatT<T, N, N> m = MatT<T, N, N>::Zero();
    for (int k = 0; k < stages; ++k) m.col(index(k)) += weight(k) * a.col(k);
    return m;
  }
};

template <int N>
struct SecondKind<Rn<N>> : IdentityRetraction<SecondKind<Rn<N>>, Rn<N>> {
  static std::string name() { return "second_kind"; }
};
template <int N>
struct SecondKindSymmetric<Rn<N>> : IdentityRetraction<SecondKindSymmetric<Rn<N>>, Rn<N>> {
  static std::string name() { return "second_kind_symmetric"; }
};
template <>
struct SecondKind<SO2> : AddedAngle<SecondKind<SO2>> {
  static std::string name() { return "second_kind"; }
};
template <>
struct SecondKindSymmetric<SO2> : AddedAngle<SecondKindSymmetric<SO2>> {
  static std::string name() { return "second_kind_symmetric"; }
};

/// The domain of R = Rx(xi_1) Ry(xi_2) Rz(xi_3): gimbal lock at |xi_2| = pi/2.
template <>
struct SecondKind<SO3> : StagedRetraction<SecondKind<SO3>, SO3, false> {
  static std::string domain() { return "|xi_2| < pi/2 (gimbal lock), |xi_1|, |xi_3| < pi"; }
  template <class T>
  static bool in_domain(const VecT<T, 3>& xi) {
    using std::abs;
    return abs(xi[0]) < std::numbers::pi && abs(xi[1]) < std::numbers::pi / 2 &&
           abs(xi[2]) < std::numbers::pi;
  }
  /// xi_2 = asin R13, xi_1 = atan2(-R23, R33), xi_3 = atan2(-R12, R11). DomainError at |xi_2| =
  /// pi/2.
  template <class T>
  static VecT<T, 3> tau_inverse(const MatT<T, 3, 3>& g) {
    using std::atan2;
    using std::sqrt;
    const T square = g(1, 2) * g(1, 2) + g(2, 2) * g(2, 2);
    if (!(square > 1e-24)) {
      throw DomainError("second_kind^-1: gimbal lock, |xi_2| = " + to_text(std::numbers::pi / 2) +
                        " rad (pi/2, to 1e-12), where the inverse is singular");
    }
    return {atan2(T(-g(1, 2)), g(2, 2)), atan2(g(0, 2), T(sqrt(square))),
            atan2(T(-g(0, 1)), g(0, 0))};
  }
};

/// Rx(xi_1/2) Ry(xi_2/2) Rz(xi_3) Ry(xi_2/2) Rx(xi_1/2).
template <>
struct SecondKindSymmetric<SO3> : StagedRetraction<SecondKindSymmetric<SO3>, SO3, true> {
  static std::string domain() { return "|xi_1|, |xi_2|, |xi_3| < pi"; }
  template <class T>
  static bool in_domain(const VecT<T, 3>& xi) {
    using std::abs;
    return abs(xi[0]) < std::numbers::pi && abs(xi[1]) < std::numbers::pi &&
           abs(xi[2]) < std::numbers::pi;
  }
  /// From the Gibbs vector t: xi_i = 2 atan(t_i/sqrt(1 + t_1^2 + ... + t_{i-1}^2)).
  /// DomainError at a rotation by pi.
  template <class T>
  static VecT<T, 3> tau_inverse(const MatT<T, 3, 3>& g) {
    using std::atan;
    using std::sqrt;
    const VecT<T, 3> t = gibbs_vector(g, "so3 second_kind_symmetric^-1");
    const T first = 1.0 + t[0] * t[0], second = first + t[1] * t[1];
    return {2.0 * atan(t[0]), 2.0 * atan(T(t[1] / sqrt(first))),
            2.0 * atan(T(t[2] / sqrt(second)))};
  }
};

template <>
struct SecondKind<SE2> : StagedRetraction<SecondKind<SE2>, SE2, false> {
  static std::string domain() { return "|omega| < pi"; }
  template <class T>
  static bool in_domain(const VecT<T, 3>& xi) {
    return Exp<SE2>::in_domain(xi);
  }
  /// v = R^T p. DomainError at a rotation by pi.
  template <class T>
  static VecT<T, 3> tau_inverse(const SE2Element<T>& g) {
    const T omega = principal_angle(g.rotation, "se2 second_kind^-1");
    const VecT<T, 2> v = g.rotation.rotate_back(g.translation);
    return {omega, v[0], v[1]};
  }
};

template <>
struct SecondKindSymmetric<SE2> : StagedRetraction<SecondKindSymmetric<SE2>, SE2, true> {
  static std::string domain() { return "|omega| < pi"; }
  template <class T>
  static bool in_domain(const VecT<T, 3>& xi) {
    return Exp<SE2>::in_domain(xi);
  }
  /// v = R(omega/2)^T p. DomainError at a rotation by pi.
  template <class T>
  static VecT<T, 3> tau_inverse(const SE2Element<T>& g) {
    const T omega = principal_angle(g.rotation, "se2 second_kind_symmetric^-1");
    const VecT<T, 2> v = Exp<SO2>::tau(VecT<T, 1>(0.5 * omega)).rotate_back(g.translation);
    return {omega, v[0], v[1]};
  }
};

/// The rotation as on SO(3), then the translation in its frame.
template <>
struct SecondKind<SE3> : StagedRetraction<SecondKind<SE3>, SE3, false> {
  static std::string domain() { return SecondKind<SO3>::domain(); }
  template <class T>
  static bool in_domain(const VecT<T, 6>& xi) {
    return SecondKind<SO3>::in_domain(VecT<T, 3>(xi.template head<3>())) && all_finite(xi);
  }
  template <class T>
  static VecT<T, 6> tau_inverse(const SE3Element<T>& g) {
    VecT<T, 6> xi;
    xi << SecondKind<SO3>::tau_inverse(g.rotation), g.rotation.transpose() * g.translation;
    return xi;
  }
};

/// p = Rx(xi_1/2) Ry(xi_2/2) Rz(xi_3/2) v.
template <>
struct SecondKindSymmetric<SE3> : StagedRetraction<SecondKindSymmetric<SE3>, SE3, true> {
  static std::string domain() { return SecondKindSymmetric<SO3>::domain(); }
  template <class T>
  static bool in_domain(const VecT<T, 6>& xi) {
    return SecondKindSymmetric<SO3>::in_domain(VecT<T, 3>(xi.template head<3>())) && all_finite(xi);
  }
  template <class T>
  static VecT<T, 6> tau_inverse(const SE3Element<T>& g) {
    const VecT<T, 3> omega = SecondKindSymmetric<SO3>::tau_inverse(g.rotation);
    const MatT<T, 3, 3> half = SecondKind<SO3>::tau(VecT<T, 3>(0.5 * omega));
    VecT<T, 6> xi;
    xi << omega, half.transpose() * g.translation;
    return xi;
  }
};

}  // namespace hamel
