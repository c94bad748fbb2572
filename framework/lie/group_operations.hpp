// The operations of a group with a retraction on elements of its type, with out-parameters:
// called by the steps of schemes where the types are known. geometry.hpp has the same operations
// with the type erased.
#pragma once

#include <concepts>
#include <limits>
#include <type_traits>

#include <hamel/framework/lie/coordinates.hpp>
#include <hamel/framework/lie/packing.hpp>
#include <hamel/framework/lie/recover_step.hpp>
#include <hamel/framework/lie/trivialised.hpp>

namespace hamel {

/// Out-parameters may be the in-parameters. T: a number, or one in each lane (lanes/lane.hpp).
template <class Tau_, class T = double>
struct GroupOperations {
  using Tau = Tau_;
  using Scalar = T;
  using G = typename Tau::Group;
  static constexpr int n = G::dim;
  using Element = typename G::template Element<T>;
  using Vector = VecT<T, n>;
  using Matrix = MatT<T, n, n>;

  static constexpr int dim() { return n; }
  static constexpr bool symmetric() { return Tau::symmetric; }
  static constexpr bool one_parameter() { return Tau::one_parameter; }
  static constexpr bool commuting() {
    if constexpr (requires { Tau::commuting; }) return Tau::commuting || Tau::one_parameter;
    else return Tau::one_parameter;
  }

  /// An element to write into.
  static Element element() { return G::template identity<T>(); }
  static void compose(const Element& g, const Element& h, Element& out) { out = G::compose(g, h); }
  static void inverse(const Element& g, Element& out) { out = G::inverse(g); }
  static void normalise(Element& g) { g = G::normalise(g); }
  static double defect(const Element& g) { return G::defect(g); }
  /// How far g turns, in radians; NaN where the group has no rotation_angle(g).
  static double rotation_angle([[maybe_unused]] const Element& g) {
    if constexpr (requires { G::rotation_angle(g); }) return G::rotation_angle(g);
    else return std::numeric_limits<double>::quiet_NaN();
  }
  /// Are these the same numbers?
  static bool same(const Element& g, const Element& h) {
    if constexpr (std::equality_comparable<Element>) return g == h;
    else return G::coordinates(g) == G::coordinates(h);
  }
  /// Ad_g^T mu and ad_xi^T mu.
  static void Ad_transpose(const Element& g, const Vector& mu, Vector& out) {
    out = G::Ad_transpose(g, mu);
  }
  static void ad_transpose(const Vector& xi, const Vector& mu, Vector& out) {
    if constexpr (requires { G::ad_transpose(xi, mu); }) out = G::ad_transpose(xi, mu);
    else out = (G::coad(mu) * xi).eval();
  }
  static void tau(const Vector& xi, Element& out) { out = Tau::tau(xi); }
  /// (dR tau_xi)^T m.
  static void dtau_right_transpose(const Vector& xi, const Vector& m, Vector& out) {
    out = (Tau::dtau_right(xi).transpose() * m).eval();
  }
  /// (dR tau_xi)^-T p.
  static void dtau_right_inverse_transpose(const Vector& xi, const Vector& p, Vector& out) {
    out = Tau::dtau_right_inverse_transpose(xi, p);
  }
  /// (dL tau_xi)^-1 eta.
  static void dtau_left_inverse(const Vector& xi, const Vector& eta, Vector& out) {
    out = apply_dtau_left_inverse<Tau>(xi, eta);
  }
  /// tau(xi) and (dL tau_xi)^-1 eta.
  static void tau_with_rate(const Vector& xi, const Vector& eta, Element& g, Vector& rate) {
    g = hamel::tau_with_rate<Tau>(xi, eta, rate);
  }
  /// mixed_momentum of trivialised.hpp.
  static void mixed_momentum(double s, const Vector& xi, const Vector& p, const Vector& nu,
                             Vector& q) {
    q = hamel::mixed_momentum<Tau, T>(s, xi, p, nu);
  }
  /// (M50): mu0 = even + odd, mu1 = even - odd, of a step xi about its middle without forces.
  static void end_momenta(const Vector& xi, const Vector& p, Vector& even,
                          Vector& odd) requires has_end_momenta<Tau> {
    Tau::end_momenta(xi, p, even, odd);
  }
  static bool in_domain(const Vector& xi) { return Tau::in_domain(xi); }
  /// xi with tau_s(xi) = delta; false where there is none.
  static bool recover_step(const Element& delta, double s, Vector& xi) {
    xi = hamel::recover_step<Tau>(delta, s);
    return xi.allFinite();
  }

  /// The doubles of an element, and it as a block of them.
  static constexpr int element_size() { return Packing<G>::size; }
  static void store(const Element& g, double* out) { Packing<G>::store(g, out); }
  static void load(const double* from, Element& out) { out = Packing<G>::load(from); }
  // CSV columns.
  static constexpr int columns() { return static_cast<int>(coordinate_count<G>); }
  static void coordinates(const Element& g, double* out) {
    const auto values = G::coordinates(g);
    std::copy(values.begin(), values.end(), out);
  }
  static void from_coordinates(std::span<const double> values, Element& out) {
    out = G::from_coordinates(values);
  }
  /// The element next to values that are no element.
  static void nearest(std::span<const double> values, Element& out) {
    out = nearest_element<G>(values);
  }
};

}  // namespace hamel
