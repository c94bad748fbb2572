// Statistics over members, in an order that depends on their indices alone: chunks of 1024 members
// one after the other, joined by a binary tree over the chunks. Not installed.
#pragma once

#include <span>
#include <vector>

#include <hamel/framework/ensemble/ensemble.hpp>

namespace hamel::ensemble {

constexpr long kChunk = 1024;

/// Moments of the values that are there (NaN: none), in their order.
Moments moments_of(std::span<const double> values);
/// The tree: neighbours first, then neighbours of these; an odd one goes up alone.
Moments joined(std::vector<Moments> chunks);
/// The value of member `first` is the first.
Moments moments_of_column(std::span<const double> values, long first);

/// Quantile of sorted values, with linear interpolation between them; NaN of none.
double quantile(std::span<const double> sorted, double part);
Histogram histogram_of(std::span<const double> values, const HistogramRequest& request,
                       const Moments& moments);
/// Each entry over the members that have both values, and n - 1 of these: the diagonal is the
/// square of the deviation.
Covariance covariance_of(const std::vector<std::span<const double>>& columns, long first);

}  // namespace hamel::ensemble
