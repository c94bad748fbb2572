// Defaults of a retraction, from tau, tau^-1, dR^-1 and its Newton derivative.
//
//   dR     = (dR^-1)^-1
//   dL_xi  = Ad_{tau(xi)}^-1 dR_xi,   dL_xi = dR_{-xi} if tau is symmetric
// All functions are templates on the scalar. Also TypeList, in which a group lists its retractions.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <hamel/framework/lie/linear_solve.hpp>
#include <hamel/framework/lie/types.hpp>
#include <string>
#include <type_traits>

namespace hamel {

/// A list of types: `TypeList<Exp<SO3>, Cayley<SO3>>`.
template <class... Ts>
struct TypeList {
  static constexpr int size = sizeof...(Ts);
  /// Is T one of them?
  template <class T>
  static constexpr bool contains = (std::is_same_v<T, Ts> || ...);
  /// visit(type) for each: `List::for_each([]<class R>(std::type_identity<R>) { ... });`
  template <class Visitor>
  static constexpr void for_each(Visitor&& visit) {
    (visit(std::type_identity<Ts>{}), ...);
  }
};

/// The lists one after another: Concatenate<TypeList<A>, TypeList<B, C>>::type.
template <class... Lists>
struct Concatenate {
  using type = TypeList<>;
};
template <class... Ts>
struct Concatenate<TypeList<Ts...>> {
  using type = TypeList<Ts...>;
};
template <class... As, class... Bs, class... Rest>
struct Concatenate<TypeList<As...>, TypeList<Bs...>, Rest...> {
  using type = typename Concatenate<TypeList<As..., Bs...>, Rest...>::type;
};

/// The first of a list.
template <class List>
struct FirstOf;
template <class T, class... Ts>
struct FirstOf<TypeList<T, Ts...>> {
  using type = T;
};

/// Is every entry a finite number? (Works for automatic-differentiation scalars.)
template <class T, int N>
bool all_finite(const Eigen::Matrix<T, N, 1>& xi) {
  using std::isfinite;
  for (int i = 0; i < N; ++i) {
    if (!isfinite(xi[i])) return false;
  }
  return true;
}

/// CRTP base: `struct MyMap : RetractionDefaults<MyMap, SO3>` defines name, symmetric, tau,
/// tau_inverse, dtau_right_inverse, dtau_right_inverse_transpose_derivative and inherits the rest.
/// A member that Derived defines itself hides the default.
template <class Derived, class G>
struct RetractionDefaults {
  using Group = G;
  static constexpr int dim = G::dim;
  static constexpr bool one_parameter = false;
  /// tau(a xi) tau(b xi) = tau(b xi) tau(a xi)?
  static constexpr bool commuting = false;

  /// dR_xi = (dR_xi^-1)^-1 by elimination.
  template <class T>
  static MatT<T, dim, dim> dtau_right(const VecT<T, dim>& xi) {
    const MatT<T, dim, dim> inverse = Derived::dtau_right_inverse(xi);
    return inverse_of(inverse);
  }
  /// dL_xi = dR_{-xi} (symmetric) or Ad_{tau(xi)^-1} dR_xi.
  template <class T>
  static MatT<T, dim, dim> dtau_left(const VecT<T, dim>& xi) {
    if constexpr (Derived::symmetric) {
      return Derived::dtau_right(VecT<T, dim>(-xi));
    } else {
      return G::Ad(G::inverse(Derived::tau(xi))) * Derived::dtau_right(xi);
    }
  }
  /// dL_xi^-1 = dR_{-xi}^-1 (symmetric) or dR_xi^-1 Ad_{tau(xi)}.
  template <class T>
  static MatT<T, dim, dim> dtau_left_inverse(const VecT<T, dim>& xi) {
    if constexpr (Derived::symmetric) {
      return Derived::dtau_right_inverse(VecT<T, dim>(-xi));
    } else {
      return Derived::dtau_right_inverse(xi) * G::Ad(Derived::tau(xi));
    }
  }
  /// (dR_xi^-1)^T p; a map with a cheaper form than its matrix hides this.
  template <class T>
  static VecT<T, dim> dtau_right_inverse_transpose(const VecT<T, dim>& xi, const VecT<T, dim>& p) {
    return Derived::dtau_right_inverse(xi).transpose() * p;
  }
  /// (dL_xi^-1)^T p = (dR_{-xi}^-1)^T p (symmetric) or Ad_{tau(xi)}^T (dR_xi^-1)^T p.
  template <class T>
  static VecT<T, dim> dtau_left_inverse_transpose(const VecT<T, dim>& xi, const VecT<T, dim>& p) {
    if constexpr (Derived::symmetric) {
      return Derived::dtau_right_inverse_transpose(VecT<T, dim>(-xi), p);
    } else {
      return G::Ad_transpose(Derived::tau(xi), Derived::dtau_right_inverse_transpose(xi, p));
    }
  }
  template <class T>
  static bool in_domain(const VecT<T, dim>& xi) {
    return all_finite(xi);
  }
  static std::string domain() { return "all finite xi"; }
  static std::string formula() { return "tau(xi) = " + std::string(Derived::name()) + "(xi)"; }
  static std::string source() { return ""; }
};

}  // namespace hamel
