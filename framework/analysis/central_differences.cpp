#include <hamel/framework/analysis/central_differences.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hamel {
namespace {

using Index = Eigen::Index;

// Factors of an error, by order: nearly all random functions of the test need no more.
constexpr std::array kSafety = {3.0, 6.0, 12.0};
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRatio = 4;       // of neighbouring steps
constexpr double kRadius = 64;     // of convergence, of the step at which estimates fail
constexpr int kMostSteps = 5;      // of an extrapolation
constexpr double kEnough = 16;     // epsilon: an error that larger steps need not improve
constexpr double kFlat = 0x1p-10;  // of a step: the size of flat parts that are well behind
constexpr int kRun = 5;            // levels that must agree
constexpr double kFalls = 16;      // the least ratio of changes that fall
constexpr double kLeastRatio = 0.06;
constexpr double kDoubt = 2;  // times the round-off, which few values measure
// Resolutions of the argument in the least step: with few of them rounding repeats itself.
constexpr double kQuanta = 4096;
constexpr double kRisen = 1000;  // times the least error: f is no longer smooth over such steps

// Weights by which values at u_j = 16^j, j < count, give the polynomial through them at 0, or its
// slope there.
struct Weights {
  std::array<double, kMostSteps> value{}, slope{};
};
Weights weights_of(int count) {
  Weights out;
  for (int j = 0; j < count; ++j) {
    double product = 1, sum = 0;
    for (int i = 0; i < count; ++i) {
      if (i == j) continue;
      const double ui = std::pow(kRatio * kRatio, i), uj = std::pow(kRatio * kRatio, j);
      product *= ui / (ui - uj);
      sum -= 1 / ui;
    }
    out.value[static_cast<size_t>(j)] = product;
    out.slope[static_cast<size_t>(j)] = product * sum;
  }
  return out;
}
const Weights& weights(int count) {
  static const std::array<Weights, kMostSteps + 1> all = [] {
    std::array<Weights, kMostSteps + 1> out;
    for (int n = 1; n <= kMostSteps; ++n) out[static_cast<size_t>(n)] = weights_of(n);
    return out;
  }();
  return all[static_cast<size_t>(count)];
}

// A power of two, so that steps are exact.
double power_of_two(double x) { return std::ldexp(1.0, std::ilogb(x)); }

}  // namespace

StepRange steps_of_scale(double scale, double grain) {
  return {.least = 0x1p-40 * scale, .most = 2 * scale, .grain = std::max(grain, kEpsilon * scale)};
}

StepRange steps_of_any_scale(double grain) { return {.grain = grain}; }

// Fourth differences of neighbours: 70 sigma^2 is their variance.
Eigen::VectorXd noise_of(const std::function<Eigen::VectorXd(double)>& f, double step) {
  constexpr int count = 12;
  Eigen::MatrixXd values;
  for (int i = 0; i < count; ++i) {
    const Eigen::VectorXd value = f(step * (i + 0.0371 * i * i));  // rounding repeats itself else
    if (i == 0) values.resize(value.size(), count);
    values.col(i) = value;
  }
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(values.rows());
  for (int i = 2; i + 2 < count; ++i)
    sum += (values.col(i - 2) - 4 * values.col(i - 1) + 6 * values.col(i) - 4 * values.col(i + 1) +
            values.col(i + 2))
               .cwiseAbs2();
  return 4 * (sum / (70.0 * (count - 4))).cwiseSqrt();
}

// The state of one component in a sweep over the steps.
struct CentralDifferences::Track {
  double low = -kInfinity, high = kInfinity;  // what all estimates so far agree on
  Index low_level = -1, high_level = -1;      // of the estimates that set these bounds
  Estimate best{.value = 0, .error = kInfinity};
  Index flat = -1;      // the last level at which f does not change at all
  Index conflict = -1;  // the level that contradicts the others
  int run = 0;          // levels that agree
  bool stopped() const { return conflict >= 0; }
};

CentralDifferences::CentralDifferences(Curve f, const StepRange& steps)
    : f_(std::move(f)), steps_(steps), here_(value_at(0)) {
  steps_.least = power_of_two(std::max(steps.least, kQuanta * steps.grain));
}

CentralDifferences::Vector CentralDifferences::value_at(double x) {
  ++evaluations_;
  return f_(x);
}

// Samples f at the levels up to k; false: there is no such level.
bool CentralDifferences::has_level(Index k) {
  while (!ended_ && std::ssize(levels_) <= k) {
    const double h = steps_.least * std::pow(kRatio, static_cast<double>(levels_.size()));
    Level level;
    level.h = h;
    if (h <= steps_.most) {
      level.plus = value_at(h);
      level.minus = value_at(-h);
      level.odd = (level.plus - level.minus) / (2 * h);
      level.even = ((level.plus - here_) + (level.minus - here_)) / (h * h);
      level.noise =
          4 * kEpsilon *
              level.plus.cwiseAbs().cwiseMax(level.minus.cwiseAbs()).cwiseMax(here_.cwiseAbs()) +
          2 * steps_.grain * level.odd.cwiseAbs();
    }
    ended_ = h > steps_.most || !level.plus.allFinite() || !level.minus.allFinite();
    if (!ended_) levels_.push_back(std::move(level));
  }
  return k < std::ssize(levels_);
}

// Fourth differences of values about h/32 apart around h and around -h: 70 sigma^2 is their
// variance, the smooth part is (h/32)^4 f''''. No step is a multiple of the other or of a unit in
// the last place, whose rounding would cancel.
void CentralDifferences::measure_noise(Index k) {
  Level& level = levels_[static_cast<size_t>(k)];
  level.measured = Vector::Zero(here_.size());
  for (const auto& [side, apart] : {std::pair{level.h, 0.0371}, std::pair{-level.h, 0.0223}}) {
    Vector sum = 6 * (side > 0 ? level.plus : level.minus);
    for (const auto& [place, weight] :
         {std::pair{-2, 1.0}, std::pair{-1, -4.0}, std::pair{1, -4.0}, std::pair{2, 1.0}})
      sum += weight * value_at(side * (1 + apart * place));
    if (sum.allFinite()) level.measured = level.measured.cwiseMax(sum.cwiseAbs() / 3);
  }
}

// Error of one value at level k: its round-off, and what was measured: there, or at both
// neighbours, since a single measurement may be 0 by chance.
double CentralDifferences::noise(Index k, Index c) const {
  const auto measured = [&](Index i) {
    if (i < 0 || i >= std::ssize(levels_) || at(i).measured.size() == 0) return 0.0;
    return at(i).measured[c];
  };
  const double known = steps_.noise.size() > 0 ? steps_.noise[c] : 0;
  return std::max({at(k).noise[c], known, measured(k), std::min(measured(k - 1), measured(k + 1))});
}

bool CentralDifferences::changes(int order, Index k, Index c) const {
  const Level& level = at(k);
  if (level.plus[c] != here_[c] || level.minus[c] != here_[c]) return true;
  return order == 3 && k + 1 < std::ssize(levels_) && changes(1, k + 1, c);
}

// The best extrapolation whose smallest step is that of level k.
CentralDifferences::Estimate CentralDifferences::estimate(int order, Index k, Index c) {
  Estimate out{.value = 0, .error = kInfinity, .inner = k};
  double last = 0, last_change = 0;
  const int least = order == 3 ? 2 : 1;
  for (int count = least; count <= kMostSteps && has_level(k + count - 1); ++count) {
    double value = 0, round_off = 0;
    for (int j = 0; j < count; ++j) {
      const double h = at(k + j).h;
      double weight = weights(count).value[static_cast<size_t>(j)];
      if (order == 3) {
        const double inner = at(k).h;
        weight = 6 * weights(count).slope[static_cast<size_t>(j)] / (inner * inner);
      }
      value += weight * (order == 2 ? at(k + j).even : at(k + j).odd)[c];
      round_off += std::abs(weight) * noise(k + j, c) * (order == 2 ? 4 / (h * h) : 1 / h);
    }
    // |value - last| is the error of `last`; where such changes fall, the next one is less.
    const double change = std::abs(value - last);
    const bool falls = count > least + 1 && kFalls * change < last_change;
    const double ratio = falls ? std::max(kFalls * change / last_change, kLeastRatio) : 1;
    const double error = ratio * change + round_off;
    if (count > least && error < out.error) {
      out.value = value;
      out.error = error;
      out.round_off = round_off;
      out.outer = k + count - 1;
      out.rough = count > least + 1 && !falls && change > 2 * round_off;
    }
    last = value;
    last_change = change;
  }
  return out;
}

// Takes in the estimate of level k, or stops where it contradicts smaller steps.
void CentralDifferences::advance(int order, Index k, Index c, Track& track) {
  if (track.flat == k - 1 && !changes(order, k, c)) {
    track.flat = k;
    return;
  }
  const Estimate now = estimate(order, k, c);
  if (!std::isfinite(now.error)) return;
  const double low = now.value - now.error - kDoubt * now.round_off,
               high = now.value + now.error + kDoubt * now.round_off;
  // Errors that rise before anything is known are those of a function that begins with a power.
  const bool risen = track.run >= kRun && now.error > kRisen * track.best.error;
  if (low > track.high || high < track.low || now.rough || risen) {
    if (track.run >= kRun || !is_measured(k) || !is_measured(track.low_level) ||
        !is_measured(track.high_level)) {
      track.conflict = k;
      return;
    }
    track = Track{.flat = track.flat};  // so few levels agree by chance, in the noise
  }
  ++track.run;
  if (low > track.low) track.low = low, track.low_level = k;
  if (high < track.high) track.high = high, track.high_level = k;
  if (now.error < track.best.error) track.best = now;
}

// True where larger steps need not improve an error.
bool CentralDifferences::is_enough(Index k, const Track& track, double largest) const {
  if (track.flat >= 0 && kFlat * at(k).h < at(track.flat).h) return false;
  const double enough = kEnough * kEpsilon;
  return track.run >= kRun &&
         track.best.error <= enough * std::max(std::abs(track.best.value), 0.01 * largest);
}

std::vector<CentralDifferences::Track> CentralDifferences::sweep(int order, bool whole) {
  std::vector<Track> out(static_cast<size_t>(here_.size()));
  for (Index k = 0; has_level(k); ++k) {
    double largest = 0;
    for (Index c = 0; c < here_.size(); ++c) {
      Track& track = out[static_cast<size_t>(c)];
      if (!track.stopped()) advance(order, k, c, track);
      if (std::isfinite(track.best.error)) largest = std::max(largest, std::abs(track.best.value));
    }
    if (!whole && largest > 0 && std::all_of(out.begin(), out.end(), [&](const Track& track) {
          return track.stopped() || track.flat == k || is_enough(k, track, largest);
        }))
      break;
  }
  for (Index c = 0; c < here_.size(); ++c) {
    Track& track = out[static_cast<size_t>(c)];
    if (track.run < kRun) track.best.error = kInfinity;
    settle_flat(order, c, track);
  }
  return out;
}

// Where f does not change over small steps: its derivative is 0, if this is not round-off of f.
void CentralDifferences::settle_flat(int order, Index c, Track& track) {
  if (track.flat < 0) return;
  while (track.flat + 1 < std::ssize(levels_) && !changes(order, track.flat + 1, c)) ++track.flat;
  const Level& level = at(track.flat);
  const bool nothing_else = !std::isfinite(track.best.error);
  const bool begins = track.flat + 1 < std::ssize(levels_);
  double largest = begins ? noise(track.flat, c) : level.noise[c];  // where f begins to change
  for (Index k = track.flat + 1; k < std::min(track.flat + 4, std::ssize(levels_)); ++k)
    if (at(k).measured.size() > 0) largest = std::max(largest, at(k).measured[c]);
  const double error = (order == 2 ? 4 : 6) * largest / std::pow(level.h, order);
  if (!nothing_else) {
    if (std::abs(track.best.value) <= track.best.error + error) return;
    if (track.conflict < 0) track.conflict = track.flat + 1;
  }
  track.best = {.value = 0, .error = error, .inner = track.flat, .outer = track.flat};
}

// Measures the noise where it decides; false: all of it is known.
bool CentralDifferences::measure_where_decided(const std::vector<Track>& tracks) {
  bool out = false;
  if (steps_.noise.size() > 0) return out;
  const auto measure = [&](Index level) {
    if (level < 0) return;
    const Index end = std::min(level + 2, std::ssize(levels_));
    for (Index k = std::max<Index>(0, level - 1); k < end; ++k) {
      if (is_measured(k)) continue;
      measure_noise(k);
      out = true;
    }
  };
  for (const Track& track : tracks) {
    measure(track.best.inner);
    if (track.flat >= 0 && track.best.inner == track.flat) measure(track.flat + 2);
    if (!track.stopped()) continue;
    measure(track.conflict);
    measure(track.low_level);
    measure(track.high_level);
  }
  return out;
}

// Half of the jump of f' at the point: |f(h) + f(-h) - 2 f(0)|/2h at its least.
double CentralDifferences::kink(Index c, Index last) const {
  double out = kInfinity;
  for (Index k = 0; k <= last && k < std::ssize(levels_); ++k) {
    const Level& level = at(k);
    const double even = std::abs((level.plus[c] - here_[c]) + (level.minus[c] - here_[c])) / 2;
    out = std::min(out, std::max(0.0, even - 2 * noise(k, c)) / level.h);
  }
  return std::isfinite(out) ? out : 0;
}

Derivative CentralDifferences::derivative(int order) {
  const Index size = here_.size();
  Derivative out{.value = Vector::Zero(size),
                 .error = Vector::Constant(size, kInfinity),
                 .reach = Vector::Zero(size)};
  if (!here_.allFinite()) return out;
  std::vector<Track> tracks = sweep(order);
  while (measure_where_decided(tracks)) tracks = sweep(order);
  for (Index c = 0; c < size; ++c) {
    const Estimate& best = tracks[static_cast<size_t>(c)].best;
    out.value[c] = best.value;
    out.error[c] = kSafety[static_cast<size_t>(order - 1)] * best.error +
                   (order == 1 ? kink(c, best.inner) : 0);
    if (best.outer >= 0) out.reach[c] = at(best.outer).h;
  }
  return out;
}

Extent CentralDifferences::extent() {
  const Index size = here_.size();
  Extent out{.length = Vector::Constant(size, steps_.most), .change = Vector::Zero(size)};
  if (!here_.allFinite()) return out;
  std::vector<Track> tracks = sweep(1, true);
  while (measure_where_decided(tracks)) tracks = sweep(1, true);
  for (Index c = 0; c < size; ++c) {
    const Index conflict = tracks[static_cast<size_t>(c)].conflict;
    if (conflict < 0) continue;
    const Level& level = at(conflict);
    out.length[c] = kRadius * level.h;
    out.change[c] =
        std::max(std::abs(level.plus[c] - here_[c]), std::abs(level.minus[c] - here_[c]));
  }
  return out;
}

}  // namespace hamel
