// SO(2): rotations of the plane, with an angle that is not wrapped.
//
// Element: the unit complex number c + i s = exp(i theta) and a count of full turns, so that
//   angle = atan2(s, c) + 2 pi turns
// is continuous through composition and inverse. The turns are found from signs, without
// trigonometry. So counted, the elements are the universal cover of the circle, on which angles
// add; cayley_literal^-1 ignores the turns. Algebra: the angular velocity, 1 number.
//   (c, s)(c', s') = (c c' - s s', s c' + c s'),   Ad = 1,   ad = 0
// Source: Solà, Deray, Atchuthan, A micro Lie theory (arXiv:1812.01537), appendix A.
#pragma once

#include <cmath>
#include <cstdint>
#include <hamel/framework/lie/coordinates.hpp>
#include <hamel/framework/lie/types.hpp>
#include <hamel/groups/retractions.hpp>
#include <numbers>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace hamel {

/// exp(i theta) = c + i s and the full turns already made.
template <class T>
struct SO2Element {
  static constexpr bool in_lanes = requires { T::width; };  // a body in each (lanes/lane.hpp)
  T c{1.0}, s{0.0};
  // Integer as wide as a number, so that no byte of an element is unused.
  std::conditional_t<in_lanes, T, std::int64_t> turns = 0;

  bool operator==(const SO2Element&) const = default;

  /// The unwrapped angle [rad]. (s + 0 makes -0 into +0, so that a half turn is always +pi.)
  T angle() const {
    using std::atan2;
    return atan2(T(s + 0.0), c) + 2 * std::numbers::pi * turns;
  }
  /// [[c, -s], [s, c]].
  MatT<T, 2, 2> matrix() const {
    MatT<T, 2, 2> r;
    r << c, -s, s, c;
    return r;
  }
  /// R v.
  VecT<T, 2> rotate(const VecT<T, 2>& v) const {
    return {c * v[0] - s * v[1], s * v[0] + c * v[1]};
  }
  /// R^T v.
  VecT<T, 2> rotate_back(const VecT<T, 2>& v) const {
    return {c * v[0] + s * v[1], c * v[1] - s * v[0]};
  }
};

struct SO2 {
  static constexpr int dim = 1;
  template <class T>
  using Element = SO2Element<T>;
  using Retractions = TypeList<Exp<SO2>, Cayley<SO2>, SecondKind<SO2>, SecondKindSymmetric<SO2>,
                               CayleyLiteral<SO2>>;

  static std::string name() { return "so2"; }
  static std::string formula() {
    return "R(theta) in R^(2x2), R^T R = I, det R = 1; theta counts turns";
  }
  static std::string source() {
    return "Sola, Deray, Atchuthan, A micro Lie theory (arXiv:1812.01537), appendix A";
  }

  template <class T = double>
  static Element<T> identity() {
    return {};
  }

  /// exp(i theta) with its derivative along omega, as dual numbers.
  template <class Dual>
  static Element<Dual> along(const SO2Element<double>& g, const Vec<1>& xi) {
    Element<Dual> out{Dual(g.c), Dual(g.s), g.turns};
    out.c.v[0] = -xi[0] * g.s;
    out.s.v[0] = xi[0] * g.c;
    return out;
  }
  template <class T>
  static Element<T> compose(const SO2Element<T>& g, const SO2Element<T>& h) {
    Element<T> r{g.c * h.c - g.s * h.s, g.s * h.c + g.c * h.s, g.turns + h.turns};
    if constexpr (SO2Element<T>::in_lanes) {
      const T zero(0.0), negative = less(g.s, zero), other = negative - less(h.s, zero);
      const T none = equal(r.s, zero), one_way = 1.0 - other * other;
      const T below = less(zero, r.s) + none * less(r.c, zero);
      const T above = less(r.s, zero) + none * (less(g.c, zero) * less(h.c, zero));
      r.turns += one_way * ((1.0 - negative) * above - negative * below);
      return r;
    } else {
      count_turns(g, h, r);
      return r;
    }
  }
  /// The turns of r = g h.
  template <class T>
  static void count_turns(const SO2Element<T>& g, const SO2Element<T>& h, SO2Element<T>& r) {
    const bool negative = g.s < 0.0;
    if (negative == (h.s < 0.0)) {  // both angles point one way: their sum may leave (-pi, pi]
      if (negative) {
        if (r.s > 0.0 || (r.s == 0.0 && r.c < 0.0)) --r.turns;
      } else {
        if (r.s < 0.0 || (r.s == 0.0 && g.c < 0.0 && h.c < 0.0)) ++r.turns;
      }
    }
  }
  template <class T>
  static Element<T> inverse(const SO2Element<T>& g) {
    // -pi = pi - one turn.
    if constexpr (SO2Element<T>::in_lanes) {
      return {g.c, -g.s, -g.turns - equal(g.s, T(0.0)) * less(g.c, T(0.0))};
    } else {
      const bool half_turn = g.s == 0.0 && g.c < 0.0;
      return {g.c, -g.s, -g.turns - (half_turn ? 1 : 0)};
    }
  }

  /// g over another scalar, its derivatives zero.
  template <class T>
  static Element<T> constant(const SO2Element<double>& g) {
    return {T(g.c), T(g.s), g.turns};
  }

  template <class T>
  static MatT<T, 1, 1> Ad(const SO2Element<T>&) {
    return MatT<T, 1, 1>::Ones();
  }
  template <class T>
  static MatT<T, 1, 1> ad(const VecT<T, 1>&) {
    return MatT<T, 1, 1>::Zero();
  }
  template <class T>
  static VecT<T, 1> Ad_transpose(const SO2Element<T>&, const VecT<T, 1>& mu) {
    return mu;
  }
  template <class T>
  static MatT<T, 1, 1> coad(const VecT<T, 1>&) {
    return MatT<T, 1, 1>::Zero();
  }

  /// (c, s)(3 - c^2 - s^2)/2: one Newton step towards the unit circle.
  template <class T>
  static Element<T> normalise(const SO2Element<T>& g) {
    const T scale = 1.5 - 0.5 * (g.c * g.c + g.s * g.s);
    return {g.c * scale, g.s * scale, g.turns};
  }
  /// |c^2 + s^2 - 1|.
  template <class T>
  static T defect(const SO2Element<T>& g) {
    using std::abs;
    return abs(g.c * g.c + g.s * g.s - 1.0);
  }
  /// How far g turns, in radians.
  static double rotation_angle(const SO2Element<double>& g) { return std::abs(g.angle()); }

  template <class T>
  static MatT<T, 2, 2> matrix(const SO2Element<T>& g) {
    return g.matrix();
  }
  /// omega -> [[0, -omega], [omega, 0]].
  template <class T>
  static MatT<T, 2, 2> hat(const VecT<T, 1>& xi) {
    MatT<T, 2, 2> m;
    m << T(0.0), -xi[0], xi[0], T(0.0);
    return m;
  }
  template <class T>
  static VecT<T, 1> vee(const MatT<T, 2, 2>& m) {
    return VecT<T, 1>(0.5 * (m(1, 0) - m(0, 1)));
  }

  /// The rotation by theta [rad], turns included.
  template <class T>
  static Element<T> from_angle(const T& theta) {
    using std::cos;
    using std::sin;
    Element<T> g{cos(theta), sin(theta), 0};
    g.turns = nearest_integer((theta - g.angle()) * (0.5 / std::numbers::pi));
    return g;
  }

  static std::vector<std::string> columns() { return {"theta"}; }
  static std::vector<std::string> units() { return {"rad"}; }
  static std::vector<Component> components() { return {{"theta'", "rad/s", "angle'"}}; }
  static constexpr bool is_shape = true;
  template <class T>
  static Coordinates<T, 1> coordinates(const SO2Element<T>& g) {
    return {g.angle()};
  }
  /// theta [rad], |theta| < 1e9. Throws std::invalid_argument.
  static Element<double> from_coordinates(std::span<const double> values) {
    check_coordinates<SO2>(values);
    if (!(std::abs(values[0]) < 1e9)) {
      throw std::invalid_argument("so2: theta = " + to_text(values[0]) +
                                  ", expected an angle in radians below 1e9");
    }
    return from_angle(values[0]);
  }
  static Element<double> nearest(std::span<const double> values) { return from_angle(values[0]); }

 private:
  template <class T>
  static std::int64_t nearest_integer(const T& x) {
    if constexpr (std::is_arithmetic_v<T>) {
      return std::abs(x) < 1e15 ? std::llround(x) : 0;
    } else {
      return nearest_integer(x.a);  // an automatic-differentiation number: its value
    }
  }
};

}  // namespace hamel
