// Measures of a run, the same in one run (simulation.cpp) and in a study's cells (study/measure.cpp). Not installed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace hamel {

/// (E - E0) / |E0|; E where E0 = 0.
inline double energy_error(double energy, double start) {
  return (energy - start) / (start != 0 ? std::abs(start) : 1.0);
}

/// Euclidean distance of two elements' columns, or of two velocities.
inline double euclidean_distance(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < b.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

/// The largest |value| so far; NaN for good once a value was not finite.
inline void raise(double& largest, double value) {
  if (std::isnan(largest)) return;
  largest = std::isfinite(value) ? std::max(largest, std::abs(value))
                                 : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace hamel
