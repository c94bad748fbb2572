// R^n: translations, written additively; the abelian case.
//
// Element and algebra: n numbers.
//   g h = g + h,   e = 0,   Ad = I,   ad = 0;   every retraction is the identity map.
// Matrix: homogeneous, (n+1) x (n+1), [[I, x], [0, 1]].
#pragma once

#include <hamel/framework/lie/group_defaults.hpp>
#include <hamel/framework/lie/types.hpp>
#include <hamel/groups/retractions.hpp>
#include <string>
#include <vector>

namespace hamel {

template <int N>
struct Rn : GroupDefaults<Rn<N>, N> {
  static_assert(N >= 1);
  template <class T>
  using Element = VecT<T, N>;
  using Retractions = TypeList<Exp<Rn>, Cayley<Rn>, SecondKind<Rn>, SecondKindSymmetric<Rn>>;

  static std::string name() { return "r" + std::to_string(N); }
  static std::string formula() { return "x in R^n, composed by addition"; }

  template <class T = double>
  static Element<T> identity() {
    return Element<T>::Zero();
  }
  template <class T>
  static VecT<T, N> compose(const VecT<T, N>& g, const VecT<T, N>& h) {
    return g + h;
  }
  /// x with its derivative xi, as dual numbers.
  template <class Dual>
  static VecT<Dual, N> along(const Vec<N>& g, const Vec<N>& xi) {
    VecT<Dual, N> out;
    for (int i = 0; i < N; ++i) {
      out[i].a = g[i];
      out[i].v[0] = xi[i];
    }
    return out;
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

  static std::vector<std::string> units() { return std::vector<std::string>(N, "m"); }
  /// x1', x2', ...; x', y', z' are read too where N <= 3.
  static std::vector<Component> components() {
    std::vector<Component> out;
    for (int i = 0; i < N; ++i)
      out.push_back({"x" + std::to_string(i + 1) + "'", "m/s",
                     N <= 3 ? std::string{static_cast<char>('x' + i), '\''} : ""});
    return out;
  }
  static constexpr bool is_shape = true;

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
};

}  // namespace hamel
