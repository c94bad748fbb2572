// Traced: a recorded number with its value at one place, a scalar for formulas that branch. Not
// installed.
//
// The formulas of groups and retractions branch on values: series or closed form. Recorded over
// Traced they take the branch of the place; each comparison is kept as a guard, whose sign says
// whether the record holds at another place too.
#pragma once

#include <cmath>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/graph/number.hpp>

namespace hamel {

struct Traced {
  graph::Number number;
  double a = 0;  // value at the place, under the name that jets give it

  Traced() = default;
  template <class T>
  requires std::is_arithmetic_v<T> Traced(T value)  // NOLINT: implicit, as for double
      : number(static_cast<double>(value)), a(static_cast<double>(value)) {}
  Traced(const graph::Number& of, double value) : number(of), a(value) {}

  Traced& operator+=(const Traced& b) { return *this = {number + b.number, a + b.a}; }
  Traced& operator-=(const Traced& b) { return *this = {number - b.number, a - b.a}; }
  Traced& operator*=(const Traced& b) { return *this = {number * b.number, a * b.a}; }
  Traced& operator/=(const Traced& b) { return *this = {number / b.number, a / b.a}; }
};

/// The comparisons since its construction, of this thread: of the difference of both sides. Not
/// inline: static libraries have each their own copy of an inline function and its variables
/// (tools/cmake/localise), and formulas of groups are compiled in another one.
class Guards {
 public:
  struct Guard {
    graph::Number difference;
    bool negative;
  };
  Guards();
  ~Guards();
  Guards(const Guards&) = delete;
  Guards& operator=(const Guards&) = delete;

  const std::vector<Guard>& all() const { return all_; }
  static bool below(const Traced& x, const Traced& y);

 private:
  std::vector<Guard> all_;
  Guards* outer_;
};

inline Traced operator+(Traced x, const Traced& y) { return x += y; }
inline Traced operator-(Traced x, const Traced& y) { return x -= y; }
inline Traced operator*(Traced x, const Traced& y) { return x *= y; }
inline Traced operator/(Traced x, const Traced& y) { return x /= y; }
inline Traced operator-(const Traced& x) { return {-x.number, -x.a}; }
inline bool operator<(const Traced& x, const Traced& y) { return Guards::below(x, y); }
inline bool operator>(const Traced& x, const Traced& y) { return Guards::below(y, x); }
inline bool operator<=(const Traced& x, const Traced& y) { return !Guards::below(y, x); }
inline bool operator>=(const Traced& x, const Traced& y) { return !Guards::below(x, y); }
/// Of values alone: two formulas that are equal at one place are held to be no case of their own.
inline bool operator==(const Traced& x, const Traced& y) { return x.a == y.a; }

inline Traced sqrt(const Traced& x) { return {sqrt(x.number), std::sqrt(x.a)}; }
inline Traced abs(const Traced& x) { return {abs(x.number), std::abs(x.a)}; }
inline Traced sin(const Traced& x) { return {sin(x.number), std::sin(x.a)}; }
inline Traced cos(const Traced& x) { return {cos(x.number), std::cos(x.a)}; }
inline Traced tan(const Traced& x) { return {tan(x.number), std::tan(x.a)}; }
inline Traced atan(const Traced& x) { return {atan(x.number), std::atan(x.a)}; }
inline Traced atan2(const Traced& y, const Traced& x) {
  return {atan2(y.number, x.number), std::atan2(y.a, x.a)};
}
inline bool isfinite(const Traced& x) { return std::isfinite(x.a); }

}  // namespace hamel

namespace Eigen {

template <>
struct NumTraits<hamel::Traced> : NumTraits<double> {
  using Real = hamel::Traced;
  using NonInteger = hamel::Traced;
  using Nested = hamel::Traced;
  using Literal = hamel::Traced;
  enum { RequireInitialization = 1, ReadCost = 1, AddCost = 4, MulCost = 4 };
};
template <class Operation>
struct ScalarBinaryOpTraits<hamel::Traced, double, Operation> {
  using ReturnType = hamel::Traced;
};
template <class Operation>
struct ScalarBinaryOpTraits<double, hamel::Traced, Operation> {
  using ReturnType = hamel::Traced;
};

}  // namespace Eigen
