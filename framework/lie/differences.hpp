// Derivatives by central differences of order 6, for functions that are known by their values only:
// along g tau(e eta), and in time.
//
//   f' = (45 (f_1 - f_-1) - 9 (f_2 - f_-2) + (f_3 - f_-3)) / (60 h) + h^6 f^(7) / 140
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace hamel {

/// d/de f(g tau(e eta)) is the sum of weight * f(moved) over the calls of add(e, weight), moved = g
/// tau(e eta). operations: tau(xi, out), compose(g, h, out). step (n numbers) and moved (an
/// element) are the caller's work space.
template <class Operations, class From, class Vector, class Element, class Add>
void differentiate_along(const Operations& operations, const From& g, const Vector& eta,
                         Vector& step, Element& moved, Add&& add) {
  constexpr double weights[] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
  // Error of sin(kappa e)' / kappa:  unit    kappa = 1   10      50      100
  //                                  2e-3    2e-13       5e-13   7e-9    5e-7
  //                                  5e-4    1e-12       3e-14   2e-12   1e-10
  //                                  1e-4    5e-12       6e-13   3e-14   4e-14
  const double unit = 5e-4 / std::max(1.0, eta.norm());
  for (int k = 1; k <= 3; ++k) {
    for (const double side : {unit, -unit}) {
      step = (k * side) * eta;
      operations.tau(step, moved);
      operations.compose(g, moved, moved);
      add(k * side, weights[k - 1] / side);
    }
  }
}

/// out = df/dt of a function of time of unknown scale: of units 14 ms, 4 ms, ... 1 ns the
/// one at which the derivative changes least, or no more than by round-off. f(t) returns a vector
/// that holds until the next call; work has two of its size.
template <class Function, class Vector>
void differentiate_in_time(double t, Function&& f, std::array<Vector, 2>& work, Vector& out) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  constexpr double weights[] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
  const double grain = std::ldexp(epsilon, std::ilogb(1 + std::abs(t)) + 2);
  double size = 0;  // of f
  const auto difference = [&](double h, Vector& to) {
    to.setZero();
    for (int k = 1; k <= 3; ++k) {
      for (const double side : {h, -h}) {
        const auto& value = f(t + k * side);
        size = value.norm();
        to += (weights[k - 1] / side) * value;
      }
    }
  };
  double least = std::numeric_limits<double>::infinity();
  Vector *last = &work[0], *next = &work[1];
  for (double unit = 0.0137; unit > 1e-9; unit *= 0.27) {  // no two of them share a period
    const double h = std::max(1.0, std::rint(unit / grain)) * grain;  // t + k h is exact
    difference(h, *next);
    const double change = unit == 0.0137 ? least : (*next - *last).norm();
    if (unit == 0.0137 || change < least) {
      least = change;
      out = *next;
    }
    // Round-off of f, and of t in it.
    if (change <= 4 * epsilon * (size + std::abs(t) * next->norm()) / h) return;
    std::swap(last, next);
  }
}

}  // namespace hamel
