// Figures as the blocks of a report page (tools/report/README.md).
#pragma once

#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include <hamel/framework/figures/figure.hpp>

namespace hamel::figures {

using Json = nlohmann::ordered_json;

/// Six digits are more than a plot shows, and keep a page small; null of what is not finite.
constexpr int kDigits = 6;
Json number(double value, int digits = kDigits);
Json numbers(std::span<const double> values, int digits = kDigits);
/// Numbers with more digits where their range is narrow.
Json coordinates(std::span<const double> values);
Json cells(const std::vector<Cell>& values);

Json json_of(const Figure& figure);

}  // namespace hamel::figures
