// A function of time that dips below 0 between looks at which it is positive.
#pragma once

#include <cmath>
#include <optional>

namespace hamel {

struct ValueAt {
  double time, value;
};

/// The parabola through three looks, in either direction of time.
struct Parabola {
  double time, least, curvature;  // of its vertex
  Parabola(const ValueAt& a, const ValueAt& b, const ValueAt& c) {
    const double left = b.time - a.time, right = c.time - b.time;
    const double down = (a.value - b.value) / left, up = (c.value - b.value) / right;
    const double slope = (up * left - down * right) / (left + right);
    curvature = (down + up) / (left + right);
    time = b.time - slope / (2 * curvature);
    least = b.value - slope * slope / (4 * curvature);
  }
};

/// The least value of f between the first and the last of three looks with f > 0: a look below 0 as
/// soon as there is one; else where it turns, as a parabola has it; none where it does not turn
/// there, or stays far from 0.
template <class F>
std::optional<ValueAt> find_dip(const F& f, ValueAt a, ValueAt b, ValueAt c) {
  constexpr int tries = 12;
  for (int k = 0; k < tries; ++k) {
    const Parabola p(a, b, c);
    if (!(p.curvature > 0 && (p.time - a.time) * (c.time - p.time) > 0)) return {};
    const bool found = k > 0 && p.least > 0.3 * b.value;
    if (found || std::abs(p.time - b.time) < 1e-9 * std::abs(c.time - a.time))
      return ValueAt{p.time, std::fmax(p.least, 0)};
    const ValueAt now = {p.time, f(p.time)};
    if (now.value < 0) return now;
    if (!(now.value < b.value)) return {};
    ((p.time - b.time) * (b.time - a.time) < 0 ? c : a) = b;
    b = now;
  }
  return {};
}

}  // namespace hamel
