// Derivatives along g tau(e eta) at e = 0 by central differences of order 6, error about 1e-12: for functions
// that a system states by their values only.
#pragma once

#include <algorithm>
#include <cmath>

#include <hamel/framework/lie/geometry.hpp>

namespace hamel {

/// d/de f(g tau(e eta)) is the sum of weight * f(moved) over the calls of add(e, weight), moved = g tau(e eta).
/// step (n numbers) and moved (an element) are the caller's work space.
template <class Add>
void differentiate_along(const Geometry& geometry, const double* g, const Eigen::VectorXd& eta,
                         Eigen::VectorXd& step, Eigen::VectorXd& moved, Add&& add) {
  constexpr double weights[] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
  const double unit = 2e-3 / std::max(1.0, eta.norm());
  for (int k = 1; k <= 3; ++k) {
    for (const double side : {unit, -unit}) {
      step = (k * side) * eta;
      geometry.tau(step.data(), moved.data());
      geometry.compose(g, moved.data(), moved.data());
      add(k * side, weights[k - 1] / side);
    }
  }
}

}  // namespace hamel
