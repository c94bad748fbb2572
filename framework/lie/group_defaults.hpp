// Defaults of a group, from its identity, compose, inverse, Ad and ad.
//
// A user's group derives from GroupDefaults<YourGroup, n> and defines name, Element,
// identity, compose, inverse, Ad, ad. It inherits, where it does not define them itself:
//   Ad_transpose(g, mu) = Ad(g)^T mu,  coad(mu) = [(ad_{e_1})^T mu, ..., (ad_{e_n})^T mu],
//   normalise(g) = g and defect = 0 (no redundant numbers in the element),
//   matrix(g) = Ad(g) (the adjoint representation, trivial on the centre),
//   columns x1 ... xN, coordinates and from_coordinates when Element is a column vector.
// Members that any group may define for its velocities and coordinates, without a default
// (GroupFactor, group_info.hpp):
//   components()         names and units of xi, std::vector<Component>: {{"omega", "rad/s"}, ...};
//                        else xi1 ... xin
//   units()              of the columns: {"rad", "m", "m"}
//   is_shape             static constexpr bool: the coordinates are the integrals of the components
//   coordinate_rates(x, xi, out), add_pulled_back(x, slope, out)
//                        out = C(g) xi, the rates of the coordinates x of g along g' = g xi, and
//                        out += C(g)^T slope, on std::span<const double>, std::span<double>; else
//                        differences of order 6
// The Heisenberg group in full, with a retraction by automatic differentiation: groups/README.md.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <hamel/framework/lie/coordinates.hpp>
#include <hamel/framework/lie/types.hpp>

namespace hamel {

template <class Derived, int N>
struct GroupDefaults {
  static constexpr int dim = N;

  /// Ad(g)^T mu.
  template <class Element, class T>
  static VecT<T, N> Ad_transpose(const Element& g, const VecT<T, N>& mu) {
    return Derived::Ad(g).transpose() * mu;
  }
  /// Column j: (ad_{e_j})^T mu.
  template <class T>
  static MatT<T, N, N> coad(const VecT<T, N>& mu) {
    MatT<T, N, N> m;
    for (int j = 0; j < N; ++j) {
      const VecT<T, N> unit = VecT<T, N>::Unit(j);
      m.col(j) = Derived::ad(unit).transpose() * mu;
    }
    return m;
  }
  template <class Element>
  static Element normalise(const Element& g) {
    return g;
  }
  template <class Element>
  static double defect(const Element&) {
    return 0.0;
  }
  /// The adjoint representation.
  template <class Element>
  static auto matrix(const Element& g) {
    return Derived::Ad(g);
  }

  /// x1, x2, ...
  static std::vector<std::string> columns() {
    std::vector<std::string> names;
    for (int i = 1; i <= rows<Derived>(); ++i) names.push_back("x" + std::to_string(i));
    return names;
  }
  template <class T, int Rows>
  static auto coordinates(const Eigen::Matrix<T, Rows, 1>& g) {
    Coordinates<T, static_cast<std::size_t>(Rows)> values;
    std::copy_n(g.data(), Rows, values.begin());
    return values;
  }
  /// Throws std::invalid_argument on a wrong length or a value that is not finite.
  static auto from_coordinates(std::span<const double> values) {
    check_coordinates<Derived>(values);
    return Vec<rows<Derived>()>(values.data());
  }

 private:
  template <class G>
  static constexpr int rows() {
    using Element = typename G::template Element<double>;
    static_assert(
        requires { Element::RowsAtCompileTime; },
        "Element is not an Eigen column vector: give columns, coordinates and from_coordinates");
    return Element::RowsAtCompileTime;
  }
};

}  // namespace hamel
