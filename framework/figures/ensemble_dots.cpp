#include <hamel/framework/figures/ensemble_dots.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace hamel::figures {
namespace {

constexpr size_t kMostDots = 4000;  // of a figure, of evenly chosen members
constexpr size_t kMostColumns = 6;  // of a scatter matrix

using Numbers = std::vector<double>;

// Pearson's coefficient over the members that have both values; NaN where one of them is constant.
double correlation(const Numbers& x, const Numbers& y) {
  double count = 0, mean_x = 0, mean_y = 0;
  const auto each = [&](const auto& visit) {
    for (size_t k = 0; k < x.size(); ++k)
      if (!std::isnan(x[k]) && !std::isnan(y[k])) visit(x[k], y[k]);
  };
  each([&](double a, double b) { ++count, mean_x += a, mean_y += b; });
  mean_x /= count;
  mean_y /= count;
  double xx = 0, yy = 0, xy = 0;
  each([&](double a, double b) {
    xx += (a - mean_x) * (a - mean_x);
    yy += (b - mean_y) * (b - mean_y);
    xy += (a - mean_x) * (b - mean_y);
  });
  return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

const std::vector<double>& numbers_of(const EnsembleResult& result, const std::string& name) {
  return std::get<Numbers>(result.table.column(name).values);
}

std::string unit_of(const EnsembleResult& result, const std::string& name) {
  const std::string& unit = result.table.column(name).unit;
  return unit == "1" ? "" : unit;
}

Numbers chosen(const Numbers& all, const std::vector<long>& index) {
  Numbers out;
  for (const long k : index) out.push_back(all[static_cast<size_t>(k)]);
  return out;
}

std::vector<long> every(size_t count, size_t stride) {
  std::vector<long> out;
  for (size_t k = 0; k < count; k += stride) out.push_back(static_cast<long>(k));
  return out;
}

std::vector<bool> failed_members(const EnsembleResult& result) {
  std::vector<bool> out(static_cast<size_t>(result.members));
  for (const MemberFailure& failure : result.failures)
    out[static_cast<size_t>(failure.member)] = true;
  return out;
}

size_t stride_of_dots(const EnsembleResult& result) {
  size_t out = (static_cast<size_t>(result.members) + kMostDots - 1) / kMostDots;
  const auto meets = [&](const Variation& v) {
    return v.law == Variation::Law::values && std::gcd(out, v.numbers.size()) > 1;
  };
  while (out > 1 && result.config.grid && std::ranges::any_of(result.config.vary, meets)) ++out;
  return out;
}

std::string ordinal(size_t n) {
  const char* end = n % 100 / 10 == 1 ? "th"
                    : n % 10 == 1     ? "st"
                    : n % 10 == 2     ? "nd"
                    : n % 10 == 3     ? "rd"
                                      : "th";
  return fmt::format("{}{}", n, end);
}

std::string sampled(size_t stride) {
  return stride > 1 ? fmt::format("Each {} member.", ordinal(stride)) : "";
}

std::vector<long long> classes_of(const EnsembleResult& result) {
  if (result.config.classes.names.empty())
    return std::vector<long long>(static_cast<size_t>(result.members), 0);
  return std::get<std::vector<long long>>(result.table.column("class").values);
}

void add_scatter_matrix(std::vector<Figure>& out, const EnsembleResult& result) {
  std::vector<std::string> names, more, constant;
  for (const std::string& name : result.kept) {
    const Moments& m = result.moments.at(name);
    const bool varies = m.count > 1 && m.least < m.most;
    (!varies ? constant : names.size() < kMostColumns ? names : more).push_back(name);
  }
  if (names.size() < 2) return;
  const size_t count = static_cast<size_t>(result.members), stride = stride_of_dots(result);
  ScatterMatrix matrix;
  const bool classes = !result.config.classes.names.empty();
  if (classes) matrix.classes = result.config.classes.names;
  const std::vector<bool> failed = failed_members(result);
  const std::vector<long long> class_of = classes_of(result);
  for (const long k : every(count, stride)) {
    if (failed[static_cast<size_t>(k)]) continue;
    const long long c = class_of[static_cast<size_t>(k)];
    if (c < 0) continue;
    matrix.members.push_back(k);
    if (classes) matrix.class_of.push_back(static_cast<long>(c));
  }
  for (const std::string& name : names) {
    const Numbers& values = numbers_of(result, name);
    ScatterMatrix::Column& column = matrix.columns.emplace_back(
        ScatterMatrix::Column{name, unit_of(result, name), chosen(values, matrix.members)});
    for (const std::string& other : names)
      column.correlation.push_back(correlation(values, numbers_of(result, other)));
  }
  std::string note = sampled(stride);
  const auto add = [&](const std::string& text) { note += (note.empty() ? "" : " ") + text; };
  add(fmt::format("Above the diagonal: Pearson's correlation over all members{}.",
                  result.failures.empty() ? "" : " that have not failed"));
  if (!more.empty()) add(fmt::format("Left out: {}.", fmt::join(more, ", ")));
  if (!constant.empty())
    add(fmt::format("The same in all members: {}.", fmt::join(constant, ", ")));
  out.push_back({.title = "What is kept, in pairs",
                 .drawing = std::move(matrix),
                 .note = std::move(note),
                 .name = "scatter-matrix",
                 .section = "Kept quantities in pairs"});
}

}  // namespace hamel::figures
