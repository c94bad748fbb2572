// The retractions of a product of groups: factor by factor.
//
//   tau(xi_1, xi_2, ...) = (tau_1(xi_1), tau_2(xi_2), ...);   dR, dL are block diagonal.
// Exp<Product<SE2, SO2>> and its like take the same family for every factor;
// ProductRetraction<Exp<SE2>, Cayley<SO2>> mixes families. The headers of the factors' retractions
// are to be included too.
#pragma once

#include <cstddef>
#include <hamel/framework/lie/types.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/retractions.hpp>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

namespace hamel {

/// Members for the Hamel form (framework/schemes/hamel_form.hpp) of R, the retraction of factor I,
/// where tau is addition on all other factors.
template <class G, std::size_t I, class R>
struct OfOneFactor {
  static constexpr bool quadratic_weight_is_one = requires { requires R::quadratic_weight_is_one; };
  static auto quadratic_weight(const auto& x) requires(requires { R::quadratic_weight(x); }) {
    return R::quadratic_weight(x);
  }
  static double angle_squared(const Vec<G::dim>& xi) requires(requires(const Vec<R::dim>& own) {
    R::angle_squared(own);
  }) {
    return R::angle_squared(G::template segment<I>(xi));
  }
  template <class T>
  static VecT<T, G::dim> solve_even_transposed(
      const VecT<T, G::dim>& xi, double c,
      const VecT<T, G::dim>& m) requires(requires(const VecT<T, R::dim>& own) {
    R::solve_even_transposed(own, c, own);
  }) {
    const VecT<T, R::dim> part = G::template segment<I>(xi), own = G::template segment<I>(m);
    VecT<T, G::dim> out = m;
    out.template segment<R::dim>(G::offsets[I]) = R::solve_even_transposed(part, c, own);
    return out;
  }
};
struct OfNoFactor {};
/// OfOneFactor of the one factor on which tau is not addition, where there is one.
template <class... Rs>
struct OneFactorOf {
  static constexpr std::size_t index() {
    const bool add[] = {adds<Rs>()...};
    std::size_t i = 0;
    while (i + 1 < sizeof...(Rs) && add[i]) ++i;
    return i;
  }
  template <class R>
  static constexpr bool adds() {
    return requires { requires R::addition; };
  }
  static constexpr bool exists = ((adds<Rs>() ? 0 : 1) + ...) == 1;
  using type = std::conditional_t<exists,
                                  OfOneFactor<Product<typename Rs::Group...>, index(),
                                              std::tuple_element_t<index(), std::tuple<Rs...>>>,
                                  OfNoFactor>;
};

/// tau = (tau_1, tau_2, ...): one retraction for each factor.
template <class... Rs>
struct ProductRetraction : OneFactorOf<Rs...>::type {
  using Group = Product<typename Rs::Group...>;
  static constexpr int dim = Group::dim;
  static constexpr bool symmetric = (Rs::symmetric && ...);
  static constexpr bool one_parameter = (Rs::one_parameter && ...);
  static constexpr bool commuting = (GroupOperations<Rs>::commuting() && ...);
  template <std::size_t I>
  using Part = std::tuple_element_t<I, std::tuple<Rs...>>;

  /// "exp", or "exp*cayley" when the factors' names differ.
  static std::string name() {
    const std::vector<std::string> names = {Rs::name()...};
    std::string joined = names.front();
    bool same = true;
    for (std::size_t i = 1; i < names.size(); ++i) {
      same = same && names[i] == names[0];
      joined += "*" + names[i];
    }
    return same ? names.front() : joined;
  }
  static std::string domain() { return join({Rs::domain()...}); }
  static std::string formula() { return join({Rs::formula()...}); }

  template <class T>
  static ProductElement<T, typename Rs::Group...> tau(const VecT<T, dim>& xi) {
    return Group::template each<T>(
        [&](auto i) { return Part<i>::tau(Group::template segment<i>(xi)); });
  }
  template <class T>
  static VecT<T, dim> tau_inverse(const ProductElement<T, typename Rs::Group...>& g) {
    VecT<T, dim> xi;
    Group::for_each_factor([&](auto i) {
      xi.template segment<Part<i>::Group::dim>(Group::offsets[i]) =
          Part<i>::tau_inverse(g.template part<i>());
    });
    return xi;
  }
  /// Factor by factor (framework/lie/recover_step.hpp).
  static Vec<dim> recover_step(const ProductElement<double, typename Rs::Group...>& delta,
                               double s) {
    Vec<dim> xi;
    Group::for_each_factor([&](auto i) {
      xi.template segment<Part<i>::Group::dim>(Group::offsets[i]) =
          hamel::recover_step<Part<i>>(delta.template part<i>(), s);
    });
    return xi;
  }
  template <class T>
  static MatT<T, dim, dim> dtau_right(const VecT<T, dim>& xi) {
    return Group::template block_diagonal<T>(
        [&](auto i) { return Part<i>::dtau_right(Group::template segment<i>(xi)); });
  }
  template <class T>
  static MatT<T, dim, dim> dtau_right_inverse(const VecT<T, dim>& xi) {
    return Group::template block_diagonal<T>(
        [&](auto i) { return Part<i>::dtau_right_inverse(Group::template segment<i>(xi)); });
  }
  template <class T>
  static MatT<T, dim, dim> dtau_left(const VecT<T, dim>& xi) {
    return Group::template block_diagonal<T>(
        [&](auto i) { return Part<i>::dtau_left(Group::template segment<i>(xi)); });
  }
  template <class T>
  static MatT<T, dim, dim> dtau_left_inverse(const VecT<T, dim>& xi) {
    return Group::template block_diagonal<T>(
        [&](auto i) { return Part<i>::dtau_left_inverse(Group::template segment<i>(xi)); });
  }
  template <class T>
  static VecT<T, dim> dtau_left_inverse(const VecT<T, dim>& xi, const VecT<T, dim>& eta) {
    VecT<T, dim> out;
    Group::for_each_factor([&](auto i) {
      const auto part = Group::template segment<i>(xi), own = Group::template segment<i>(eta);
      out.template segment<Part<i>::Group::dim>(Group::offsets[i]) =
          apply_dtau_left_inverse<Part<i>>(part, own);
    });
    return out;
  }
  /// tau(xi), and dL_xi^-1 eta in `rate`.
  template <class T>
  static ProductElement<T, typename Rs::Group...> tau_with_rate(const VecT<T, dim>& xi,
                                                                const VecT<T, dim>& eta,
                                                                VecT<T, dim>& rate) {
    return Group::template each<T>([&](auto i) {
      VecT<T, Part<i>::Group::dim> own = Group::template segment<i>(eta);
      auto g = hamel::tau_with_rate<Part<i>>(Group::template segment<i>(xi), own, own);
      rate.template segment<Part<i>::Group::dim>(Group::offsets[i]) = own;
      return g;
    });
  }
  template <class T>
  static VecT<T, dim> dtau_right_inverse_transpose(const VecT<T, dim>& xi, const VecT<T, dim>& p) {
    VecT<T, dim> q;
    Group::for_each_factor([&](auto i) {
      q.template segment<Part<i>::Group::dim>(Group::offsets[i]) =
          Part<i>::dtau_right_inverse_transpose(Group::template segment<i>(xi),
                                                Group::template segment<i>(p));
    });
    return q;
  }
  template <class T>
  static void end_momenta(const VecT<T, dim>& xi, const VecT<T, dim>& p, VecT<T, dim>& even,
                          VecT<T, dim>& odd) requires(has_end_momenta<Rs>&&...) {
    Group::for_each_factor([&](auto i) {
      constexpr int size = Part<i>::Group::dim, at = Group::offsets[i];
      VecT<T, size> own_even, own_odd;
      Part<i>::end_momenta(Group::template segment<i>(xi), Group::template segment<i>(p), own_even,
                           own_odd);
      even.template segment<size>(at) = own_even;
      odd.template segment<size>(at) = own_odd;
    });
  }
  template <class T>
  static VecT<T, dim> dtau_left_inverse_transpose(const VecT<T, dim>& xi, const VecT<T, dim>& p) {
    VecT<T, dim> q;
    Group::for_each_factor([&](auto i) {
      q.template segment<Part<i>::Group::dim>(Group::offsets[i]) =
          Part<i>::dtau_left_inverse_transpose(Group::template segment<i>(xi),
                                               Group::template segment<i>(p));
    });
    return q;
  }
  template <class T>
  static MatT<T, dim, dim> dtau_right_inverse_transpose_derivative(const VecT<T, dim>& xi,
                                                                   const VecT<T, dim>& p) {
    return Group::template block_diagonal<T>([&](auto i) {
      return Part<i>::dtau_right_inverse_transpose_derivative(Group::template segment<i>(xi),
                                                              Group::template segment<i>(p));
    });
  }
  template <class T>
  static bool in_domain(const VecT<T, dim>& xi) {
    bool inside = true;
    Group::for_each_factor(
        [&](auto i) { inside = inside && Part<i>::in_domain(Group::template segment<i>(xi)); });
    return inside;
  }

 private:
  /// "1: |omega| < pi; 2: all finite xi".
  static std::string join(const std::vector<std::string>& texts) {
    std::string joined;
    for (std::size_t i = 0; i < texts.size(); ++i) {
      joined += (i == 0 ? "" : "; ") + std::to_string(i + 1) + ": " + texts[i];
    }
    return joined;
  }
};

template <class... Gs>
struct Exp<Product<Gs...>> : ProductRetraction<Exp<Gs>...> {};
template <class... Gs>
struct Cayley<Product<Gs...>> : ProductRetraction<Cayley<Gs>...> {};
/// On the factors that have it, Cayley on the others.
template <class... Gs>
struct CayleyLiteral<Product<Gs...>>
    : ProductRetraction<std::conditional_t<has_retraction<Gs, CayleyLiteral<Gs>>, CayleyLiteral<Gs>,
                                           Cayley<Gs>>...> {
  static std::string name() { return "cayley_literal"; }
};
template <class... Gs>
struct Polar<Product<Gs...>> : ProductRetraction<Polar<Gs>...> {};
template <class... Gs>
struct SecondKind<Product<Gs...>> : ProductRetraction<SecondKind<Gs>...> {};
template <class... Gs>
struct SecondKindSymmetric<Product<Gs...>> : ProductRetraction<SecondKindSymmetric<Gs>...> {};

}  // namespace hamel
