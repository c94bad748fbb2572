// Taylor coefficients of functions of one number. Not installed.
#pragma once

#include <array>

#include <hamel/framework/graph/operation.hpp>

namespace hamel::graph {

constexpr int kMostUnits = 16;
/// f^(j)(a)/j!, up to an order of at most kMostUnits.
using Series = std::array<double, kMostUnits + 1>;

/// x^p about a: binomial coefficients, which end with an exponent that is an integer.
Series power_series(double a, double p, int order);
Series inverse_series(double a, int order);
Series log_series(double a, int order);
/// A function of one number.
Series series_of(Op op, double a, int order);

}  // namespace hamel::graph
