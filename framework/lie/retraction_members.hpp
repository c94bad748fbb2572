// The message for a retraction that lacks a member, or has it in another shape: one sentence that
// names the member, in place of what the compiler finds in every function that calls it.
#pragma once

#include <concepts>
#include <string>

#include <hamel/framework/lie/concepts.hpp>

namespace hamel {
namespace detail {

// Static members of a retraction, as the concept Retraction requires them.
template <class R>
struct RetractionMembers {
  using G = typename R::Group;
  static constexpr int n = G::dim;
  using V = Vec<n>;
  using Element = typename G::template Element<double>;

  static constexpr bool name = requires {
    { R::name() } -> std::convertible_to<std::string>;
  };
  static constexpr bool symmetric = requires {
    { R::symmetric } -> std::convertible_to<bool>;
  };
  static constexpr bool one_parameter = requires {
    { R::one_parameter } -> std::convertible_to<bool>;
  };
  static constexpr bool tau = requires(const V& xi) {
    { R::tau(xi) } -> std::convertible_to<Element>;
  };
  static constexpr bool tau_inverse = requires(const Element& g) {
    { R::tau_inverse(g) } -> Shape<n, 1>;
  };
  static constexpr bool dtau_right_inverse = requires(const V& xi) {
    { R::dtau_right_inverse(xi) } -> Shape<n, n>;
  };
  static constexpr bool derivative = requires(const V& xi, const V& p) {
    { R::dtau_right_inverse_transpose_derivative(xi, p) } -> Shape<n, n>;
  };
  static constexpr bool dtau_right = requires(const V& xi) {
    { R::dtau_right(xi) } -> Shape<n, n>;
    { R::dtau_left(xi) } -> Shape<n, n>;
    { R::dtau_left_inverse(xi) } -> Shape<n, n>;
  };
};

template <class R>
constexpr bool has_group = requires {
  requires Group<typename R::Group>;
};

}  // namespace detail

/// Does not compile for a type that is no Retraction, with the member that it lacks.
template <class R>
constexpr void refuse_incomplete() {
#define HAMEL_REQUIRE(condition, member) \
  static_assert(condition, "this type does not satisfy hamel::Retraction: it has no " member)
  if constexpr (!detail::has_group<R>) {
    HAMEL_REQUIRE(detail::has_group<R>, "Group, a type that satisfies hamel::Group");
  } else if constexpr (!Retraction<R>) {
    using Has = detail::RetractionMembers<R>;
    constexpr bool inherited = Has::name && Has::symmetric && Has::one_parameter && Has::tau &&
                               Has::tau_inverse && Has::dtau_right_inverse && Has::derivative;
    HAMEL_REQUIRE(Has::name, "static std::string name()");
    HAMEL_REQUIRE(Has::symmetric, "static constexpr bool symmetric: tau(-xi) = tau(xi)^-1?");
    HAMEL_REQUIRE(Has::one_parameter, "static constexpr bool one_parameter (RetractionDefaults)");
    HAMEL_REQUIRE(Has::tau, "static tau(xi) that returns an Element of its Group");
    HAMEL_REQUIRE(Has::tau_inverse, "static tau_inverse(g) that returns a vector of n numbers");
    HAMEL_REQUIRE(Has::dtau_right_inverse, "static dtau_right_inverse(xi) that is an n x n matrix");
    HAMEL_REQUIRE(Has::derivative,
                  "static dtau_right_inverse_transpose_derivative(xi, p) that is an n x n matrix");
    HAMEL_REQUIRE(Has::dtau_right || !inherited,
                  "dtau_right, dtau_left, dtau_left_inverse that are n x n (RetractionDefaults)");
    HAMEL_REQUIRE(!Has::dtau_right || !inherited,
                  "part of what RetractionDefaults adds: dtau_right_inverse_transpose, "
                  "dtau_left_inverse_transpose, in_domain, domain or formula");
  }
#undef HAMEL_REQUIRE
}

}  // namespace hamel
