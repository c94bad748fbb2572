// my_name: the Heisenberg group in exponential coordinates, [e1, e2] = e3, and its retraction exp.
// Your group in its place: all members that a group may have are listed in
// hamel/framework/lie/group_defaults.hpp, those of a retraction in concepts.hpp beside it.
#pragma once

#include <string>

#include <hamel/hamel.hpp>

struct MyNameExp;

struct MyName : hamel::GroupDefaults<MyName, 3> {
  using V = hamel::Vec<3>;
  using M = hamel::Mat<3, 3>;
  template <class T>
  using Element = hamel::VecT<T, 3>;
  using Retractions = hamel::TypeList<MyNameExp>;

  static std::string name() { return "my_name"; }
  template <class T = double>
  static Element<T> identity() {
    return Element<T>::Zero();
  }
  static V compose(const V& g, const V& h) { return g + h + 0.5 * ad(g) * h; }
  static V inverse(const V& g) { return -g; }
  static M ad(const V& xi) { return M{{0, 0, 0}, {0, 0, 0}, {-xi[1], xi[0], 0}}; }
  static M Ad(const V& g) { return M::Identity() + ad(g); }
};

/// tau(xi) = xi, the exponential in these coordinates: dR^-1 = id - ad/2.
struct MyNameExp : hamel::RetractionDefaults<MyNameExp, MyName> {
  using V = hamel::Vec<3>;
  using M = hamel::Mat<3, 3>;
  static constexpr bool symmetric = true, one_parameter = true;

  static std::string name() { return "exp"; }
  static V tau(const V& xi) { return xi; }
  static V tau_inverse(const V& g) { return g; }
  static M dtau_right_inverse(const V& xi) { return M::Identity() - 0.5 * MyName::ad(xi); }
  static M dtau_right_inverse_transpose_derivative(const V& /*xi*/, const V& p) {
    return -0.5 * MyName::coad(p);
  }
};
