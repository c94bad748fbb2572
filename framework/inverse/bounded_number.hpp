// A number between bounds as a function of an unbounded one. Not installed.
#pragma once

#include <algorithm>
#include <cmath>

namespace hamel {

// The unbounded variable u of a number x between bounds: x = middle + half sin u, or of one bound
// low + w (sqrt(u^2 + 1) - 1) (James, MINUIT, with w = 1). w is the distance of a guess, so that u
// has no unit.
struct BoundedNumber {
  BoundedNumber(double low_bound, double high_bound, double guess)
      : low(low_bound), high(high_bound) {
    const double distance = std::isfinite(low) ? guess - low : high - guess;
    if (distance > 0 && std::isfinite(distance)) width = distance;
  }
  double low, high, width = 1;
  double x(double u) const {
    if (std::isfinite(low) && std::isfinite(high))
      return 0.5 * (low + high) + 0.5 * (high - low) * std::sin(u);
    if (std::isfinite(low)) return low + width * (std::sqrt(u * u + 1) - 1);
    if (std::isfinite(high)) return high - width * (std::sqrt(u * u + 1) - 1);
    return u;
  }
  double slope(double u) const {
    if (std::isfinite(low) && std::isfinite(high)) return 0.5 * (high - low) * std::cos(u);
    if (std::isfinite(low)) return width * u / std::sqrt(u * u + 1);
    if (std::isfinite(high)) return -width * u / std::sqrt(u * u + 1);
    return 1;
  }
  double u(double at) const {
    if (std::isfinite(low) && std::isfinite(high))
      return std::asin(std::clamp((2 * at - low - high) / (high - low), -1.0, 1.0));
    if (std::isfinite(low)) return unbounded((at - low) / width);
    if (std::isfinite(high)) return unbounded((high - at) / width);
    return at;
  }
  bool bounded() const { return std::isfinite(low) || std::isfinite(high); }

 private:
  static double unbounded(double part) { return std::sqrt((part + 1) * (part + 1) - 1); }
};

}  // namespace hamel
