// Derivatives along g tau(e eta) at e = 0 by central differences of order 6, error about 1e-12: for functions
// that a system states by their values only.
#pragma once

#include <algorithm>
#include <cmath>

namespace hamel {

/// d/de f(g tau(e eta)) is the sum of weight * f(moved) over the calls of add(e, weight), moved = g tau(e eta).
/// operations: tau(xi, out), compose(g, h, out). step (n numbers) and moved (an element) are the caller's work
/// space.
template <class Operations, class From, class Vector, class Element, class Add>
void differentiate_along(const Operations& operations, const From& g, const Vector& eta,
                         Vector& step, Element& moved, Add&& add) {
  constexpr double weights[] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
  const double unit = 2e-3 / std::max(1.0, eta.norm());
  for (int k = 1; k <= 3; ++k) {
    for (const double side : {unit, -unit}) {
      step = (k * side) * eta;
      operations.tau(step, moved);
      operations.compose(g, moved, moved);
      add(k * side, weights[k - 1] / side);
    }
  }
}

}  // namespace hamel
