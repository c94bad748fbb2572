// A number between bounds as a function of an unbounded one. Not installed.
#pragma once

#include <algorithm>
#include <cmath>

namespace hamel {

// The unbounded variable u of a number x between bounds: x = middle + half sin u, or of one bound
// low - 1 + sqrt(u^2 + 1) (James, MINUIT).
struct BoundedNumber {
  double low, high;
  double x(double u) const {
    if (std::isfinite(low) && std::isfinite(high))
      return 0.5 * (low + high) + 0.5 * (high - low) * std::sin(u);
    if (std::isfinite(low)) return low - 1 + std::sqrt(u * u + 1);
    if (std::isfinite(high)) return high + 1 - std::sqrt(u * u + 1);
    return u;
  }
  double slope(double u) const {
    if (std::isfinite(low) && std::isfinite(high)) return 0.5 * (high - low) * std::cos(u);
    if (std::isfinite(low)) return u / std::sqrt(u * u + 1);
    if (std::isfinite(high)) return -u / std::sqrt(u * u + 1);
    return 1;
  }
  double u(double at) const {
    if (std::isfinite(low) && std::isfinite(high))
      return std::asin(std::clamp((2 * at - low - high) / (high - low), -1.0, 1.0));
    if (std::isfinite(low)) return std::sqrt((at - low + 1) * (at - low + 1) - 1);
    if (std::isfinite(high)) return std::sqrt((high - at + 1) * (high - at + 1) - 1);
    return at;
  }
};

}  // namespace hamel
