#include <hamel/framework/ensemble/statistics.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hamel {

double Moments::deviation() const {
  return count > 1 ? std::sqrt(squares / static_cast<double>(count - 1))
                   : std::numeric_limits<double>::quiet_NaN();
}

Moments Moments::of_both(const Moments& a, const Moments& b) {
  if (a.count == 0) return b;
  if (b.count == 0) return a;
  const auto na = static_cast<double>(a.count), nb = static_cast<double>(b.count);
  const double apart = b.mean - a.mean;
  return {a.count + b.count, a.mean + apart * (nb / (na + nb)),
          a.squares + b.squares + apart * apart * (na * nb / (na + nb)), std::min(a.least, b.least),
          std::max(a.most, b.most)};
}

namespace ensemble {
namespace {

// f(piece) for the parts of the values that lie in one chunk of members.
template <class F>
void each_chunk(size_t size, long first, F&& f) {
  for (size_t at = 0; at < size;) {
    const long member = first + static_cast<long>(at);
    const auto count = std::min(size - at, static_cast<size_t>(kChunk - member % kChunk));
    f(at, count);
    at += count;
  }
}

double joined_sum(std::vector<double> sums) {
  for (; sums.size() > 1; sums.resize((sums.size() + 1) / 2))
    for (size_t i = 0; 2 * i < sums.size(); ++i)
      sums[i] = 2 * i + 1 < sums.size() ? sums[2 * i] + sums[2 * i + 1] : sums[2 * i];
  return sums.empty() ? 0 : sums[0];
}

}  // namespace

Moments moments_of(std::span<const double> values) {
  Moments out;
  double sum = 0;
  for (const double x : values) {
    if (std::isnan(x)) continue;
    out.least = out.count == 0 ? x : std::min(out.least, x);
    out.most = out.count == 0 ? x : std::max(out.most, x);
    ++out.count;
    sum += x;
  }
  if (out.count == 0) return out;
  out.mean = sum / static_cast<double>(out.count);
  for (const double x : values)
    if (!std::isnan(x)) out.squares += (x - out.mean) * (x - out.mean);
  return out;
}

Moments joined(std::vector<Moments> chunks) {
  for (; chunks.size() > 1; chunks.resize((chunks.size() + 1) / 2))
    for (size_t i = 0; 2 * i < chunks.size(); ++i)
      chunks[i] = 2 * i + 1 < chunks.size() ? Moments::of_both(chunks[2 * i], chunks[2 * i + 1])
                                            : chunks[2 * i];
  return chunks.empty() ? Moments() : chunks[0];
}

Moments moments_of_column(std::span<const double> values, long first) {
  std::vector<Moments> chunks;
  each_chunk(values.size(), first, [&](size_t at, size_t count) {
    chunks.push_back(moments_of(values.subspan(at, count)));
  });
  return joined(std::move(chunks));
}

double quantile(std::span<const double> sorted, double part) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double place = part * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<size_t>(place);
  const size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

Histogram histogram_of(std::span<const double> values, const HistogramRequest& request,
                       const Moments& moments) {
  const bool given = request.from < request.until;
  Histogram out{given ? request.from : moments.least, given ? request.until : moments.most,
                std::vector<long>(static_cast<size_t>(request.bins)), 0, 0};
  const double width = out.until - out.from;
  for (const double x : values) {
    if (std::isnan(x)) continue;
    if (x < out.from) ++out.below;
    else if (x > out.until) ++out.above;
    else {
      const double place = width > 0 ? (x - out.from) / width * request.bins : 0;
      ++out.counts[std::min(static_cast<size_t>(place), out.counts.size() - 1)];
    }
  }
  return out;
}

Covariance covariance_of(const std::vector<std::span<const double>>& columns, long first) {
  const size_t n = columns.size();
  Covariance out{std::vector(n, std::vector(n, std::numeric_limits<double>::quiet_NaN())),
                 std::vector(n, std::vector<long>(n, 0))};
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j <= i; ++j) {
      const auto &x = columns[i], &y = columns[j];
      // The sum of f(member) over the members that have both values.
      const auto sum = [&](auto&& f) {
        std::vector<double> sums;
        each_chunk(x.size(), first, [&](size_t at, size_t count) {
          sums.push_back(0);
          for (size_t k = at; k < at + count; ++k)
            if (!std::isnan(x[k]) && !std::isnan(y[k])) sums.back() += f(k);
        });
        return joined_sum(std::move(sums));
      };
      const double members = sum([](size_t) { return 1.0; });
      out.members[i][j] = out.members[j][i] = static_cast<long>(members);
      if (members < 2) continue;
      const double mean_x = sum([&](size_t k) { return x[k]; }) / members;
      const double mean_y = sum([&](size_t k) { return y[k]; }) / members;
      out.matrix[i][j] = out.matrix[j][i] =
          sum([&](size_t k) { return (x[k] - mean_x) * (y[k] - mean_y); }) / (members - 1);
    }
  }
  return out;
}

}  // namespace ensemble
}  // namespace hamel
