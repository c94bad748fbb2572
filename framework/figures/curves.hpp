// Curves as many points as a figure shows.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <hamel/framework/figures/figure.hpp>

namespace hamel::figures {

/// At most about `points` points: of each of equal windows those with the smallest and the largest
/// y, or only the largest (peaks, for errors on a logarithmic axis), the last window like the
/// others; else with both ends. NaN is never dropped.
Curve thinned(std::string name, const std::vector<double>& x, const std::vector<double>& y,
              bool peaks, size_t points = 1200);

/// Thins values of either sign; of a curve that goes up and down more often than a figure can
/// show, a band from the least to the greatest value of each of equal windows.
Curve drawable(std::string name, const std::vector<double>& x, const std::vector<double>& y);

/// The curve with this unit.
Curve in_unit(Curve curve, std::string unit);

/// From the least to the greatest value of all curves.
double range_of(std::span<const Curve> curves);

/// "omega [rad/s]"; the name alone without a unit, the unit alone without a name.
std::string with_unit(const std::string& name, const std::string& unit);

}  // namespace hamel::figures
