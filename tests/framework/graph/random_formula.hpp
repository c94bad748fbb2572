// Random formulas of every operation, over a scalar: the same formula for each scalar with the same
// seed.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <hamel/framework/graph/program.hpp>

namespace hamel::graph::test {

enum class Kind {
  arithmetic,  // exact where the inputs are small integers
  smooth,      // functions too, with derivatives; no selections
  every,
};

template <class T>
class RandomFormula {
 public:
  RandomFormula(std::vector<T> inputs, unsigned seed, Kind kind, int operations)
      : numbers_(std::move(inputs)), random_(seed), kind_(kind) {
    for (const double c : {0.0, 1.0, -1.0, 2.0, 0.5, -3.0}) numbers_.push_back(T(c));
    if (kind == Kind::every) {
      for (const double c : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, 1e-310, -0.0}) {
        numbers_.push_back(T(c));
      }
    }
    const T a = number(), b = number(), c = number();  // in this order for every scalar
    conditions_ = {a < b, a == c, b <= c};
    for (int i = 0; i < operations; ++i) step();
  }
  const std::vector<T>& numbers() const { return numbers_; }

 private:
  using Condition = decltype(T() < T());

  size_t below(size_t n) { return std::uniform_int_distribution<size_t>(0, n - 1)(random_); }
  // Mostly late ones: formulas become deep.
  T number() {
    const size_t n = numbers_.size();
    return numbers_[below(3) == 0 ? below(n) : n - 1 - below(std::min<size_t>(n, 12))];
  }
  Condition condition() { return conditions_[below(conditions_.size())]; }

  void step() {
    using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cos, std::cosh, std::exp,
        std::log, std::max, std::min, std::pow, std::rint, std::sin, std::sinh, std::sqrt, std::tan,
        std::tanh;
    const size_t choices = kind_ == Kind::arithmetic ? 12 : kind_ == Kind::smooth ? 36 : 42;
    const size_t choice = kind_ == Kind::smooth ? smooth_choice() : below(choices);
    const T a = number(), b = number();
    T out = a;
    switch (choice) {
      case 0:
      case 1: out = a + b; break;
      case 2:
      case 3: out = a - b; break;
      case 4: out = kind_ == Kind::arithmetic ? T(0.5) * a : a * b; break;
      case 5: out = -a; break;
      case 6: out = abs(a); break;
      case 7: out = min(a, b); break;
      case 8: out = max(a, b); break;
      case 9: out = rint(a); break;
      case 10: out = select(condition(), a, b); break;
      case 11: change_conditions(a, b); return;
      case 12:
      case 13: out = a * b; break;
      case 14: out = a / b; break;
      case 15: out = sqrt(abs(a)); break;
      case 16: out = sin(a); break;
      case 17: out = cos(a); break;
      case 18: out = exp(T(0) - abs(a)); break;
      case 19: out = log(abs(a) + T(0.1)); break;
      case 20: out = asin(sin(a)); break;
      case 21: out = acos(T(0.5) * tanh(a)); break;
      case 22: out = atan(a); break;
      case 23: out = sinh(tanh(a)); break;
      case 24: out = cosh(sin(a)); break;
      case 25: out = tanh(a); break;
      case 26: out = atan2(a, b); break;
      case 27: out = pow(abs(a) + T(0.5), tanh(b)); break;
      case 28: out = pow(a, T(3)); break;
      case 29: out = tan(a); break;
      case 30: out = a / (b * b + T(1)); break;
      case 31: out = sqrt(a * a + T(1)); break;
      case 32: out = T(1) / (T(2) + sin(a)); break;
      case 33: out = a * T(-1.25); break;
      case 34: out = sin(a) * cos(b); break;
      case 35: out = a * T(0.25) + b; break;
      case 36: out = sqrt(a); break;
      case 37: out = log(a); break;
      case 38: out = pow(a, b); break;
      case 39: out = exp(a); break;
      case 40: out = asin(a); break;
      default: out = tanh(a) * T(3e5); break;  // angles beyond the polynomials
    }
    numbers_.push_back(out);
  }
  size_t smooth_choice() {
    constexpr size_t kSmooth[] = {0, 2, 16, 17, 18, 22, 23, 24, 25, 27, 30, 31, 32, 33, 34, 35, 21};
    return kSmooth[below(std::size(kSmooth))];
  }
  void change_conditions(const T& a, const T& b) {
    const Condition p = condition(), q = condition();
    const Condition fresh[] = {a < b, a <= b, a == b, a != b, p && q, p || q, !p};
    conditions_[below(conditions_.size())] = fresh[below(std::size(fresh))];
  }

  std::vector<T> numbers_;
  std::vector<Condition> conditions_;
  std::mt19937 random_;
  Kind kind_;
};

/// Program of a random formula of this many inputs: all of its numbers as outputs, or the last
/// ones.
inline std::shared_ptr<const Program> random_program(unsigned seed, int inputs, int operations,
                                                     bool all, Kind kind = Kind::every) {
  Recording recording;
  std::vector<Number> x;
  for (int i = 0; i < inputs; ++i) x.push_back(recording.input("x" + std::to_string(i)));
  const RandomFormula<Number> formula(x, seed, kind, operations);
  Program::Outputs outputs;
  const std::vector<Number>& numbers = formula.numbers();
  for (size_t i = all || numbers.size() < 8 ? 0 : numbers.size() - 8; i < numbers.size(); ++i) {
    outputs.push_back({"y" + std::to_string(i), numbers[i]});
  }
  return std::make_shared<const Program>(recording, outputs);
}

/// Program in layers, of whose values many more are live at once than a machine has registers.
inline std::shared_ptr<const Program> wide_program(unsigned seed, int inputs, size_t live) {
  Recording recording;
  std::vector<Number> layer;
  for (int i = 0; i < inputs; ++i) layer.push_back(recording.input("x" + std::to_string(i)));
  std::mt19937 random(seed);
  const auto below = [&](size_t n) {
    return std::uniform_int_distribution<size_t>(0, n - 1)(random);
  };
  for (int k = 0; k < 5; ++k) {
    std::vector<Number> next;
    for (size_t i = 0; i < live; ++i) {
      const Number a = layer[below(layer.size())], b = layer[below(layer.size())],
                   c = layer[below(layer.size())];
      switch (below(11)) {
        case 0: next.push_back(sqrt(a)); break;
        case 1: next.push_back(rint(a)); break;
        case 2: next.push_back(select(a < b, c, a)); break;
        case 3: next.push_back(select(a <= b && b == c, b, c)); break;
        case 4: next.push_back(min(a, b) / c); break;
        case 5: next.push_back(abs(a) * b); break;
        case 6: next.push_back(a - -b); break;
        case 7: next.push_back(atan2(a, b)); break;
        case 8: next.push_back(sin(a)); break;
        case 9: next.push_back(max(a * b, c)); break;
        default: next.push_back(a * b + c); break;
      }
    }
    layer = next;
  }
  Number sum = 0;
  for (size_t i = layer.size(); i-- > 0;) sum = atan(sum) + layer[i];
  return std::make_shared<const Program>(
      recording, Program::Outputs{{"sum", sum}, {"first", layer.front()}, {"last", layer.back()}});
}

}  // namespace hamel::graph::test
