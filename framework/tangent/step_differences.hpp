// Derivatives of values along a line by central differences of three sizes, extrapolated. Not
// installed.
//
//   O(e) = (f(e) - f(-e)) / 2e = f' + e^2 f'''/6 + ...,   T = (64 O(e/4) - 20 O(e/2) + O(e)) / 45
// with an error of order e^6; coarse, (4 O(e/4) - O(e/2)) / 3, of order e^4. Their difference
// bounds the error. plain, O(e/4) alone, of a small e: half the digits of a value or more, for
// Gauss-Newton steps. Source: Ridders, Adv. Eng. Softw. 4 (1982).
#pragma once

#include <array>

#include <Eigen/Core>

namespace hamel {

struct ThreeDifferences {
  static constexpr std::array<double, 3> parts = {1, 0.5, 0.25};  // of e
  static constexpr std::array<double, 3> fine = {1 / 45.0, -20 / 45.0, 64 / 45.0},
                                         coarse = {0, -1 / 3.0, 4 / 3.0}, plain = {0, 0, 1};

  /// f(x, out) -> bool; false, and so is this, where f has no value.
  template <class F>
  static bool derivative(const std::array<double, 3>& weights, double e, const F& f,
                         Eigen::VectorXd& out) {
    Eigen::VectorXd plus, minus;
    out.resize(0);
    for (size_t level = 0; level < parts.size(); ++level) {
      if (weights[level] == 0) continue;
      const double x = e * parts[level];
      if (!f(x, plus) || !f(-x, minus)) return false;
      const Eigen::VectorXd slope = weights[level] / (2 * x) * (plus - minus);
      if (out.size() == 0) out = slope;
      else out += slope;
    }
    return out.allFinite();
  }
};

}  // namespace hamel
