// Number: a scalar whose operations are recorded as an expression graph.
//
// Formulas that are templates over a scalar T are evaluated with T = Number once per run. While a
// Recording exists, each operation on numbers of this thread adds a node to its graph, of which
// programs are made (program.hpp). Number is a scalar of Eigen.
//
// Constants are doubles and are folded: an operation on constants is computed at once. A constant 0
// is structural: 0 x is 0 and 0 + x is x for every x recorded, also where x could become infinite,
// not a number or -0. Products of constants, k (l x), and sums of multiples of one value, k x + l
// x, are combined. Equal operations on equal operands are one node. Nothing else is rearranged.
//
// Formulas do not branch on values: a comparison of Numbers is a Condition, which select() takes,
// and neither converts to bool.
#pragma once

#include <concepts>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/graph/operation.hpp>

namespace hamel::graph {

/// Constant, or a node of the thread's recording.
class Number {
 public:
  Number() = default;  ///< 0
  template <class T>
  requires std::floating_point<T> || std::integral<T> Number(T value)
      : value_(static_cast<double>(value)) {}  // NOLINT: implicit, as for double

  bool constant() const { return node_ < 0; }
  /// Value of a constant; 0 otherwise.
  double value() const { return value_; }
  /// Is it the constant v?
  bool is(double v) const { return constant() && value_ == v; }
  /// Index of its node, -1 for a constant.
  int node() const { return node_; }

  /// Formulas are recorded without branches: use select(condition, a, b).
  explicit operator bool() const = delete;

  Number& operator+=(const Number& b);
  Number& operator-=(const Number& b);
  Number& operator*=(const Number& b);
  Number& operator/=(const Number& b);

 private:
  friend class Recording;
  double value_ = 0;
  int node_ = -1;
};

/// Result of a comparison: true, false, or a node.
class Condition {
 public:
  Condition(bool value) : value_(value) {}  // NOLINT: implicit, as for bool
  bool constant() const { return node_ < 0; }
  bool value() const { return value_; }
  int node() const { return node_; }
  /// Formulas are recorded without branches: use select(condition, a, b).
  explicit operator bool() const = delete;

 private:
  friend class Recording;
  bool value_ = false;
  int node_ = -1;
};

/// Operation on earlier nodes a, b, c (-1: none), the index of an input (a), or the value of a
/// constant.
struct Node {
  Op op;
  int a = -1, b = -1, c = -1;
  double value = 0;
};

/// Graph of all operations of this thread on Numbers since its construction. Recordings of a thread
/// nest: the last one is current. A Number belongs to the recording in which it was made.
class Recording {
 public:
  Recording();
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /// Is current no longer: its graph is complete, and may be read by every thread.
  void end();
  /// Recording of this thread. Throws std::logic_error where there is none.
  static Recording& current();

  /// Adds an input, which all programs of this recording have, in the order of these calls.
  Number input(std::string name);

  const std::vector<std::string>& inputs() const { return inputs_; }
  const std::vector<Node>& nodes() const { return nodes_; }
  /// Number of a node, folded as constants are.
  Number number(int node) const;
  /// Condition of a node.
  Condition condition(int node) const;

  // Shared nodes, without folding.
  Number make(Op op, const Number& a, const Number& b = {});
  Number make_select(const Condition& c, const Number& a, const Number& b);
  Condition compare(Op op, const Number& a, const Number& b);
  Condition combine(Op op, const Condition& a, const Condition& b);

 private:
  int share(const Node& node);
  int node_of(const Number& x);
  void grow();

  std::vector<std::string> inputs_;
  std::vector<Node> nodes_;
  std::vector<int> table_;  // of nodes by hash, open addressing; -1: free
  Recording* outer_;
  bool ended_ = false;
};

Number operator+(const Number& a, const Number& b);
Number operator-(const Number& a, const Number& b);
Number operator*(const Number& a, const Number& b);
Number operator/(const Number& a, const Number& b);
Number operator-(const Number& a);
inline Number operator+(const Number& a) { return a; }

Number sqrt(const Number& x);
Number abs(const Number& x);
/// To the nearest integer, ties to even, as std::rint.
Number rint(const Number& x);
Number sin(const Number& x);
Number cos(const Number& x);
/// sin x / cos x.
Number tan(const Number& x);
Number exp(const Number& x);
Number log(const Number& x);
Number asin(const Number& x);
Number acos(const Number& x);
Number atan(const Number& x);
Number sinh(const Number& x);
Number cosh(const Number& x);
Number tanh(const Number& x);
Number atan2(const Number& y, const Number& x);
/// x^y; products where y is the constant -1, 0, 1, 2, 3 or 4.
Number pow(const Number& x, const Number& y);
Number min(const Number& a, const Number& b);
Number max(const Number& a, const Number& b);

Condition operator<(const Number& a, const Number& b);
Condition operator<=(const Number& a, const Number& b);
Condition operator==(const Number& a, const Number& b);
Condition operator&&(const Condition& a, const Condition& b);
Condition operator||(const Condition& a, const Condition& b);
Condition operator!(const Condition& a);
inline Condition operator>(const Number& a, const Number& b) { return b < a; }
inline Condition operator>=(const Number& a, const Number& b) { return b <= a; }
inline Condition operator!=(const Number& a, const Number& b) { return !(a == b); }

/// c ? a : b. Both are evaluated.
Number select(const Condition& c, const Number& a, const Number& b);
template <std::floating_point T>
T select(bool c, T a, T b) {
  return c ? a : b;
}

inline Number& Number::operator+=(const Number& b) { return *this = *this + b; }
inline Number& Number::operator-=(const Number& b) { return *this = *this - b; }
inline Number& Number::operator*=(const Number& b) { return *this = *this * b; }
inline Number& Number::operator/=(const Number& b) { return *this = *this / b; }

}  // namespace hamel::graph

namespace Eigen {

template <>
struct NumTraits<hamel::graph::Number> : NumTraits<double> {
  using Real = hamel::graph::Number;
  using NonInteger = hamel::graph::Number;
  using Nested = hamel::graph::Number;
  using Literal = hamel::graph::Number;
  enum { RequireInitialization = 1, ReadCost = 1, AddCost = 4, MulCost = 4 };
};
template <class Operation>
struct ScalarBinaryOpTraits<hamel::graph::Number, double, Operation> {
  using ReturnType = hamel::graph::Number;
};
template <class Operation>
struct ScalarBinaryOpTraits<double, hamel::graph::Number, Operation> {
  using ReturnType = hamel::graph::Number;
};

}  // namespace Eigen
