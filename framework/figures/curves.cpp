#include <hamel/framework/figures/curves.hpp>

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace hamel::figures {
namespace {

constexpr size_t kMostTurns = 300;  // of a curve that is drawn
constexpr size_t kBand = 240;       // windows of a band
constexpr double kVisible = 0.02;   // of the range: smaller turns are not seen

// How often the curve turns round, by more than can be seen.
size_t turns_of(const std::vector<double>& y) {
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const double v : y) {
    least = std::fmin(least, v);
    most = std::fmax(most, v);
  }
  const double seen = kVisible * (most - least);
  size_t turns = 0;
  double low = HUGE_VAL, high = -HUGE_VAL;  // since the last turn
  int direction = 0;
  for (const double v : y) {
    low = std::fmin(low, v);
    high = std::fmax(high, v);
    const bool falls = direction >= 0 && v < high - seen, rises = direction <= 0 && v > low + seen;
    if (!falls && !rises) continue;
    turns += direction != 0;
    direction = rises ? 1 : -1;
    low = high = v;
  }
  return turns;
}

}  // namespace

Curve thinned(std::string name, const std::vector<double>& x, const std::vector<double>& y,
              bool peaks, size_t points) {
  Curve out{.name = std::move(name)};
  const auto add = [&](size_t i) {
    out.x.push_back(x[i]);
    out.y.push_back(y[i]);
  };
  const size_t count = y.size(), buckets = std::max<size_t>(points / 2, 1);
  if (count <= points) return {.name = out.name, .x = x, .y = y};
  const auto less = [&](size_t a, size_t b) {  // NaN first, so that it is never hidden
    return std::isnan(y[a]) ? !std::isnan(y[b]) : y[a] < y[b];
  };
  for (size_t b = 0; b < buckets; ++b) {
    const size_t begin = b * count / buckets, end = (b + 1) * count / buckets;
    size_t low = begin, high = begin;
    for (size_t i = begin; i < end; ++i) {
      if (less(i, low)) low = i;
      if (less(high, i)) high = i;
    }
    if (peaks && !std::isnan(y[low])) low = high;
    if (low > high) std::swap(low, high);
    if (!peaks && b == 0 && low > 0) add(0);
    add(low);
    if (low != high) add(high);
    if (!peaks && b + 1 == buckets && high + 1 < count) add(count - 1);
  }
  return out;
}

Curve drawable(std::string name, const std::vector<double>& x, const std::vector<double>& y) {
  if (y.size() < 2 * kBand || turns_of(y) <= kMostTurns)
    return thinned(std::move(name), x, y, false);
  Curve out{.name = std::move(name)};
  out.envelope = true;
  for (size_t b = 0; b < kBand; ++b) {
    const size_t begin = b * y.size() / kBand, end = (b + 1) * y.size() / kBand;
    double low = std::nan(""), high = std::nan("");  // (NaN counts for nothing)
    for (size_t i = begin; i < end; ++i) {
      low = std::fmin(low, y[i]);
      high = std::fmax(high, y[i]);
    }
    // From end to end.
    out.x.push_back(b == 0 ? x.front() : b + 1 == kBand ? x.back() : x[(begin + end) / 2]);
    out.y.push_back(high);
    out.low.push_back(low);
  }
  return out;
}

double range_of(std::span<const Curve> curves) {
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const Curve& c : curves) {
    for (const std::vector<double>* values : {&c.y, &c.low}) {
      for (const double v : *values) {
        least = std::fmin(least, v);
        most = std::fmax(most, v);
      }
    }
  }
  return most - least;
}

Curve in_unit(Curve curve, std::string unit) {
  curve.unit = std::move(unit);
  return curve;
}

std::string with_unit(const std::string& name, const std::string& unit) {
  if (unit.empty()) return name;
  return name.empty() ? fmt::format("[{}]", unit) : fmt::format("{} [{}]", name, unit);
}

}  // namespace hamel::figures
