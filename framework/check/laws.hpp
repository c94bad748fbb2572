// The parts that every suite of laws is made of: a law with its largest violation, and how
// violations are measured.
//
// Bounds: algebraic laws 1e-12 (elements have entries of order 1 to 10 and a law chains some tens
// of operations: errors of 1e-15 are seen, a wrong sign gives order 1); laws of a retraction, few
// operations relative to the size of their maps, 1e-14 (2e-15 is the most that is seen of a
// registered one, so that a tau with an error of 1e-13 fails); with a derivative 1e-9, by central
// differences of order 6 with step 4e-3 (round-off about 1e-13, truncation below 1e-10).
#pragma once

#include <ostream>
#include <string>
#include <type_traits>
#include <vector>

namespace hamel {

/// Law with the largest violation that was seen, and the largest that round-off explains; 0 for a
/// law that holds or does not.
struct LawResult {
  std::string law;
  double measured = 0;
  double bound = 0;
  std::string seen = {};  // where the violation is no value of its own: "order 1.98, expected ..."
  /// NaN does not pass.
  bool passed() const { return measured <= bound; }
};
using LawReport = std::vector<LawResult>;

/// "FAILS  tau^-1(tau(xi)) = xi: 1e-13, expected at most 1e-14"; of a law with bound 0 that holds
/// its name alone.
inline std::ostream& operator<<(std::ostream& out, const LawResult& law) {
  out << (law.passed() ? "holds  " : "FAILS  ") << law.law;
  if (!law.seen.empty()) return out << ": " << law.seen;
  if (law.bound == 0) return law.passed() ? out : out << ": " << law.measured << ", expected 0";
  return out << ": " << law.measured << ", expected at most " << law.bound;
}

namespace check {

inline constexpr double algebraic = 1e-12;
inline constexpr double rounded = 1e-14;
inline constexpr double differentiated = 1e-9;

/// The largest of measured values; NaN is kept.
struct Largest {
  double value = 0;
  void operator()(double x) {
    if (!(x <= value)) value = x;
  }
};

inline void append(LawReport& report, const LawReport& more) {
  report.insert(report.end(), more.begin(), more.end());
}

/// f'(0) by central differences of order 6; f returns a number, an Eigen vector or an Eigen matrix.
template <class Function>
auto derivative(Function&& f, double step = 4e-3) {
  const auto slope = [&](double weight, int k) {
    const auto forwards = f(k * step), backwards = f(-k * step);
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(forwards)>>) {
      return weight / (60 * step) * (forwards - backwards);
    } else {
      return ((weight / (60 * step)) * (forwards - backwards)).eval();
    }
  };
  auto d = slope(45, 1);
  d += slope(-9, 2);
  d += slope(1, 3);
  return d;
}

}  // namespace check
}  // namespace hamel
