// R^n: translations, written additively.
//
// Element and algebra: n numbers. Formulas: g h = g + h, e = 0, Ad = I, ad = 0; every retraction is
// the identity map. The matrix is homogeneous, (n+1) x (n+1): [[I, x], [0, 1]].
// Source: any text; it is the abelian case of everything here.
#pragma once

#include <hamel/framework/types.hpp>
#include <hamel/groups/coordinates.hpp>
#include <hamel/groups/retractions.hpp>
#include <span>
#include <string>
#include <vector>

namespace hamel {

template <int N>
struct Rn {
  static_assert(N >= 1);
  static constexpr int dim = N;
  template <class T>
  using Element = VecT<T, N>;
  using Retractions = TypeList<Exp<Rn>, Cayley<Rn>, SecondKind<Rn>, SecondKindSymmetric<Rn>>;

  static std::string name() { return "r" + std::to_string(N); }

  template <class T = double>
  static Element<T> identity() {
    return Element<T>::Zero();
  }
  template <class T>
  static VecT<T, N> compose(const VecT<T, N>& g, const VecT<T, N>& h) {
    return g + h;
  }
  template <class T>
  static VecT<T, N> inverse(const VecT<T, N>& g) {
    return -g;
  }
  template <class T>
  static MatT<T, N, N> Ad(const VecT<T, N>&) {
    return MatT<T, N, N>::Identity();
  }
  template <class T>
  static MatT<T, N, N> ad(const VecT<T, N>&) {
    return MatT<T, N, N>::Zero();
  }
  template <class T>
  static VecT<T, N> Ad_transpose(const VecT<T, N>&, const VecT<T, N>& mu) {
    return mu;
  }
  template <class T>
  static MatT<T, N, N> coad(const VecT<T, N>&) {
    return MatT<T, N, N>::Zero();
  }
  template <class T>
  static VecT<T, N> normalise(const VecT<T, N>& g) {
    return g;
  }
  template <class T>
  static T defect(const VecT<T, N>&) {
    return T(0.0);
  }

  /// [[I, x], [0, 1]].
  template <class T>
  static MatT<T, N + 1, N + 1> matrix(const VecT<T, N>& g) {
    MatT<T, N + 1, N + 1> m = MatT<T, N + 1, N + 1>::Identity();
    m.template topRightCorner<N, 1>() = g;
    return m;
  }
  /// v -> [[0, v], [0, 0]].
  template <class T>
  static MatT<T, N + 1, N + 1> hat(const VecT<T, N>& v) {
    MatT<T, N + 1, N + 1> m = MatT<T, N + 1, N + 1>::Zero();
    m.template topRightCorner<N, 1>() = v;
    return m;
  }
  template <class T>
  static VecT<T, N> vee(const MatT<T, N + 1, N + 1>& m) {
    return m.template topRightCorner<N, 1>();
  }

  static std::vector<std::string> columns() {
    std::vector<std::string> names;
    for (int i = 1; i <= N; ++i) names.push_back("x" + std::to_string(i));
    return names;
  }
  template <class T>
  static std::vector<T> coordinates(const VecT<T, N>& g) {
    return std::vector<T>(g.data(), g.data() + N);
  }
  /// Throws std::invalid_argument on a wrong length or a value that is not finite.
  static Element<double> from_coordinates(std::span<const double> values) {
    check_coordinates(name(), values, columns());
    return Element<double>(values.data());
  }
};

}  // namespace hamel
