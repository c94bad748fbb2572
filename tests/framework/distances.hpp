// Distances of the ends of two runs, and of two lists of numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <hamel/framework/run/record/measures.hpp>
#include <hamel/framework/run/record/result.hpp>

namespace hamel::test {

/// The Euclidean ones of the coordinates and of the velocity, added.
inline double distance(const Result& a, const Result& b) {
  return euclidean_distance(a.last.coordinates, b.last.coordinates) +
         euclidean_distance(a.last.velocity, b.last.velocity);
}

/// The largest difference of two entries; infinite where the lengths differ or one is no number.
inline double largest_difference(std::span<const double> a, std::span<const double> b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double out = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = std::abs(a[i] - b[i]);
    if (!(d <= out)) out = std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
  }
  return out;
}

}  // namespace hamel::test
