// Addition, the retraction of the commutative groups: on R^n, and of the angle of SO(2), under
// every name but cayley_literal (groups/README.md). dR = id.
#pragma once

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/lie/retraction_defaults.hpp>
#include <hamel/groups/dexp.hpp>
#include <hamel/groups/retractions.hpp>
#include <hamel/groups/rn.hpp>
#include <hamel/groups/rotation.hpp>
#include <hamel/groups/so2.hpp>
#include <string>
#include <string_view>

namespace hamel {

/// The identity map with derivative the identity: any retraction of R^n.
template <class Derived, class G>
struct IdentityRetraction : RetractionDefaults<Derived, G> {
  static constexpr int N = G::dim;
  static constexpr bool symmetric = true;
  static constexpr bool one_parameter = true;
  static constexpr bool addition = true;
  static std::string formula() { return "tau(x) = x"; }
  template <class T>
  static VecT<T, N> tau(const VecT<T, N>& xi) {
    return xi;
  }
  template <class T>
  static VecT<T, N> tau_inverse(const VecT<T, N>& g) {
    return g;
  }
  template <class T>
  static VecT<T, N> dtau_left_inverse(const VecT<T, N>&, const VecT<T, N>& eta) {
    return eta;
  }
  using RetractionDefaults<Derived, G>::dtau_left_inverse;
  template <class T>
  static MatT<T, N, N> dtau_right(const VecT<T, N>&) {
    return MatT<T, N, N>::Identity();
  }
  template <class T>
  static MatT<T, N, N> dtau_right_inverse(const VecT<T, N>&) {
    return MatT<T, N, N>::Identity();
  }
  template <class T>
  static MatT<T, N, N> dtau_right_inverse_transpose_derivative(const VecT<T, N>&,
                                                               const VecT<T, N>&) {
    return MatT<T, N, N>::Zero();
  }
  template <class T>
  static void end_momenta(const VecT<T, N>&, const VecT<T, N>& p, VecT<T, N>& even,
                          VecT<T, N>& odd) {
    even = p;
    odd.setZero();
  }
};

/// theta, the unwrapped angle: angles add, so that any retraction of SO(2) is this one
/// (groups/README.md).
template <class Derived>
struct AddedAngle : RetractionDefaults<Derived, SO2> {
  static constexpr bool symmetric = true;
  static constexpr bool one_parameter = true;
  static constexpr bool addition = true;
  static std::string formula() { return "tau(omega) = the rotation by omega, turns counted"; }

  template <class T>
  static SO2Element<T> tau(const VecT<T, 1>& xi) {
    const T x = xi[0] * xi[0];
    if constexpr (SO2Element<T>::in_lanes) {
      using namespace detail;
      SO2Element<T> g{1.0 - x * polynomial<cosc_minimax.size()>(cosc_minimax, x),
                      xi[0] * polynomial<sinc_minimax.size()>(sinc_minimax, x), 0};
      const auto near = below(x, minimax_end);
      if (!all(near)) [[unlikely]]
        put_others(near, xi[0], g, [](double omega) { return SO2::from_angle(omega); });
      return g;
    } else {
      if (x < detail::minimax_end) [[likely]] {
        return {1.0 - x * cosc(x), xi[0] * sinc(x), 0};
      }
      return SO2::from_angle(xi[0]);
    }
  }
  template <class T>
  static VecT<T, 1> dtau_left_inverse(const VecT<T, 1>&, const VecT<T, 1>& eta) {
    return eta;
  }
  using RetractionDefaults<Derived, SO2>::dtau_left_inverse;
  /// The angle with its turns.
  template <class T>
  static VecT<T, 1> tau_inverse(const SO2Element<T>& g) {
    return VecT<T, 1>(g.angle());
  }
  template <class T>
  static MatT<T, 1, 1> dtau_right(const VecT<T, 1>&) {
    return MatT<T, 1, 1>::Ones();
  }
  template <class T>
  static MatT<T, 1, 1> dtau_right_inverse(const VecT<T, 1>&) {
    return MatT<T, 1, 1>::Ones();
  }
  template <class T>
  static MatT<T, 1, 1> dtau_right_inverse_transpose_derivative(const VecT<T, 1>&,
                                                               const VecT<T, 1>&) {
    return MatT<T, 1, 1>::Zero();
  }
  template <class T>
  static void end_momenta(const VecT<T, 1>&, const VecT<T, 1>& p, VecT<T, 1>& even,
                          VecT<T, 1>& odd) {
    even = p;
    odd.setZero();
  }
};

/// The angle in (-pi, pi), turns ignored. Throws DomainError at pi.
template <class T>
T principal_angle(const SO2Element<T>& g, const std::string_view map) {
  const T t = half_angle_tangent(g.c, g.s, map);
  return 2.0 * atanc(T(t * t)) * t;
}

}  // namespace hamel
