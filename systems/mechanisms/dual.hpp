// A number with its rate: a formula evaluated with it returns its value and d/dt along the motion.
#pragma once

#include <cmath>

#include <hamel/systems/mechanisms/screw.hpp>

namespace hamel::mechanisms {

struct Dual {
  double value = 0, rate = 0;

  Dual() = default;
  Dual(double v, double v_rate = 0) : value(v), rate(v_rate) {}

  Dual operator-() const { return {-value, -rate}; }
  friend Dual operator+(const Dual& a, const Dual& b) {
    return {a.value + b.value, a.rate + b.rate};
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    return {a.value - b.value, a.rate - b.rate};
  }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.rate * b.value + a.value * b.rate};
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double quotient = a.value / b.value;
    return {quotient, (a.rate - quotient * b.rate) / b.value};
  }
  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.value > b.value; }
};

}  // namespace hamel::mechanisms

template <>
struct Eigen::NumTraits<hamel::mechanisms::Dual> : GenericNumTraits<double> {
  using Real = hamel::mechanisms::Dual;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = Real;
  enum { RequireInitialization = 1, ReadCost = 2, AddCost = 2, MulCost = 4 };
};

namespace hamel::mechanisms {

inline Dual sqrt(const Dual& a) {
  const double root = std::sqrt(a.value);
  return {root, 0.5 * a.rate / root};
}

/// A vector of them, from its value and rate.
inline VecT<Dual, 3> dual(const Vec3& value, const Vec3& rate) {
  return {Dual(value[0], rate[0]), Dual(value[1], rate[1]), Dual(value[2], rate[2])};
}
inline Vec3 value(const VecT<Dual, 3>& v) { return {v[0].value, v[1].value, v[2].value}; }
inline Vec3 rate(const VecT<Dual, 3>& v) { return {v[0].rate, v[1].rate, v[2].rate}; }
inline Wrench value(const VecT<Dual, 6>& v) {
  return {v[0].value, v[1].value, v[2].value, v[3].value, v[4].value, v[5].value};
}
/// Value of a formula evaluated without rates.
inline const Vec3& value(const Vec3& v) { return v; }
inline const Wrench& value(const Wrench& v) { return v; }

/// The force along u at the point q (screw.hpp), and a moment.
inline VecT<Dual, 6> force_at(const VecT<Dual, 3>& q, const VecT<Dual, 3>& u) {
  VecT<Dual, 6> out;
  out.head<3>() = q.cross(u);
  out.tail<3>() = u;
  return out;
}
inline Wrench moment_of(const Vec3& m) { return stack(m, Vec3::Zero()); }
inline VecT<Dual, 6> moment_of(const VecT<Dual, 3>& m) {
  VecT<Dual, 6> out = VecT<Dual, 6>::Constant(Dual());
  out.head<3>() = m;
  return out;
}
/// d/dt (F . V) of a wrench on a link whose twist V changes by this.
inline double power_rate(const VecT<Dual, 6>& wrench, const Twist& twist, const Twist& change) {
  double sum = 0;
  for (int i = 0; i < 6; ++i) sum += wrench[i].rate * twist[i] + wrench[i].value * change[i];
  return sum;
}

}  // namespace hamel::mechanisms
