// The concepts Group and Retraction: a comment per requirement.
//
// Conventions (framework/README.md): left trivialisation, xi = g^-1 g' in the algebra, mu in its
// dual; coadjoint maps are plain transposes, Ad*_g = (Ad_g)^T, ad*_xi = (ad_xi)^T.
#pragma once

#include <concepts>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <hamel/framework/lie/types.hpp>

namespace hamel {

/// Raised by an inverse retraction outside its range (e.g. a logarithm at a rotation by pi).
struct DomainError : std::domain_error {
  using std::domain_error::domain_error;
};

/// A fixed-size matrix or vector (or expression) of R rows and C columns. convertible_to does not
/// suffice: Eigen declares conversions that then fail to compile.
template <class X, int R, int C>
concept Shape =
    std::remove_cvref_t<X>::RowsAtCompileTime == R&& std::remove_cvref_t<X>::ColsAtCompileTime == C;

/// A Lie group G of dimension n; what it may state beside this: group_defaults.hpp. Everything is
/// static and templated on the scalar T:
///   `template <class T> using Element`   the representation of a group element;
///   operations deduce T from their arguments (pass evaluated elements, not Eigen expressions).
template <class G>
concept Group = requires(const typename G::template Element<double>& g, const Vec<G::dim>& xi,
                         std::span<const double> values) {
  // n.
  { G::dim } -> std::convertible_to<int>;
  // Registered name: "so3", "r2", "se2*so2".
  { G::name() } -> std::convertible_to<std::string>;
  // e, g h, g^-1.
  { G::template identity<double>() } -> std::convertible_to<typename G::template Element<double>>;
  { G::compose(g, g) } -> std::convertible_to<typename G::template Element<double>>;
  { G::inverse(g) } -> std::convertible_to<typename G::template Element<double>>;
  // Ad_g (matrix of eta -> g eta g^-1) and ad_xi (matrix of eta -> [xi, eta]), n x n.
  { G::Ad(g) } -> Shape<G::dim, G::dim>;
  { G::ad(xi) } -> Shape<G::dim, G::dim>;
  // (Ad_g)^T mu, and the n x n matrix K(mu) with K(mu) eta = (ad_eta)^T mu.
  { G::Ad_transpose(g, xi) } -> Shape<G::dim, 1>;
  { G::coad(xi) } -> Shape<G::dim, G::dim>;
  // The nearest group element to one that carries round-off, and how far g is from the group.
  { G::normalise(g) } -> std::convertible_to<typename G::template Element<double>>;
  { G::defect(g) } -> std::convertible_to<double>;
  // Defining (or homogeneous) matrix.
  {G::matrix(g)};
  // CSV columns of an element: names, values, and back (std::invalid_argument when not in the
  // group).
  { G::columns() } -> std::convertible_to<std::vector<std::string>>;
  { G::coordinates(g) } -> std::convertible_to<std::vector<double>>;
  { G::coordinates(g).count } -> std::convertible_to<std::size_t>;  // Coordinates<double, N>
  { G::from_coordinates(values) } -> std::convertible_to<typename G::template Element<double>>;
};

/// Properties of tau on which a scheme's claims depend.
struct TauTraits {
  bool symmetric;  // tau(-xi) = tau(xi)^-1
  bool commuting;  // tau(a xi) tau(b xi) = tau(b xi) tau(a xi)
  constexpr TauTraits(bool symmetric_, bool commuting_ = false)
      : symmetric(symmetric_), commuting(commuting_) {}
};

/// A retraction map tau: algebra -> G with tau(0) = e and tau'(0) = id.
/// dR tau_xi eta = (d/de tau(xi + e eta)) tau(xi)^-1, dL tau_xi eta = tau(xi)^-1 d/de tau(xi + e
/// eta).
template <class R>
concept Retraction = requires(const Vec<R::Group::dim>& xi, const Vec<R::Group::dim>& p,
                              const typename R::Group::template Element<double>& g) {
  requires Group<typename R::Group>;
  // Registered name: "exp", "cayley", ...
  { R::name() } -> std::convertible_to<std::string>;
  // tau(-xi) = tau(xi)^-1 ?
  { R::symmetric } -> std::convertible_to<bool>;
  // tau(-s xi)^-1 tau((1-s) xi) = tau(xi) for every s? (exp on any group.)
  { R::one_parameter } -> std::convertible_to<bool>;
  { R::tau(xi) } -> std::convertible_to<typename R::Group::template Element<double>>;
  // Throws DomainError outside the range of tau.
  { R::tau_inverse(g) } -> Shape<R::Group::dim, 1>;
  // dR, its inverse, dL, its inverse: n x n.
  { R::dtau_right(xi) } -> Shape<R::Group::dim, R::Group::dim>;
  { R::dtau_right_inverse(xi) } -> Shape<R::Group::dim, R::Group::dim>;
  { R::dtau_left(xi) } -> Shape<R::Group::dim, R::Group::dim>;
  { R::dtau_left_inverse(xi) } -> Shape<R::Group::dim, R::Group::dim>;
  // (dR^-1)^T p and (dL^-1)^T p, evaluated in each step.
  { R::dtau_right_inverse_transpose(xi, p) } -> Shape<R::Group::dim, 1>;
  { R::dtau_left_inverse_transpose(xi, p) } -> Shape<R::Group::dim, 1>;
  // For Newton's Jacobian: the n x n matrix of d/dxi [ (dR tau_xi)^-T p ] with the covector p held
  // fixed.
  { R::dtau_right_inverse_transpose_derivative(xi, p) } -> Shape<R::Group::dim, R::Group::dim>;
  // Is xi inside the ball (or box) on which tau is a diffeomorphism with inverse tau_inverse?
  { R::in_domain(xi) } -> std::convertible_to<bool>;
  // Domain as text, for `hamel describe` and errors: "|omega| < pi".
  { R::domain() } -> std::convertible_to<std::string>;
  // One-line formula for `hamel describe`.
  { R::formula() } -> std::convertible_to<std::string>;
};

}  // namespace hamel
