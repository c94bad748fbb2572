// What cells are compared with: the exact motion where the system has one, else lift at s = 1/2 composed to
// order 6 (Kahan and Li), with steps halved until two of them agree. Their difference is the bound.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <hamel/framework/simulate.hpp>
#include <hamel/framework/study/parts.hpp>

namespace hamel::study {
namespace {

constexpr long kMaxIntervals = 400;
constexpr long kMaxReferenceSteps = 400'000;

struct Motion {
  bool ok = true;
  std::string reason;
  std::vector<std::vector<double>> coordinates, velocities;
};

// The states at the ends of the intervals, with that many steps in each.
Motion follow(const Registry& registry, Config config, long intervals, long steps_each) {
  config.step = config.until / static_cast<double>(intervals * steps_each);
  Integration run = Simulation(registry, config.system).config(config).build();
  Motion out;
  for (long k = 0; k <= intervals; ++k) {
    if (k > 0) {
      const Status status = run.step(steps_each);
      if (!status.ok) return {false, status.reason, {}, {}};
    }
    out.coordinates.push_back(run.state().coordinates);
    out.velocities.push_back(run.state().velocity);
  }
  return out;
}

double apart(const Motion& a, const Motion& b) {
  double out = 0;
  for (size_t k = 0; k < a.coordinates.size(); ++k) {
    const double d = std::max(euclidean_distance(a.coordinates[k], b.coordinates[k]),
                              euclidean_distance(a.velocities[k], b.velocities[k]));
    out = std::isfinite(d) ? std::max(out, d) : std::numeric_limits<double>::infinity();
  }
  return out;
}

// Halves the step until two motions agree to round-off, or agree no better than the pair before.
StudyReference converged(const Registry& registry, const StudyConfig& study, Config config,
                         long intervals) {
  const std::string group = registry.system(config.system)->group.name;
  const std::vector<std::string> known = registry.retractions_or_common(group);
  config.retraction = known.front();
  for (const char* good : {"cayley", "exp"})
    if (std::find(known.begin(), known.end(), good) != known.end()) config.retraction = good;
  config.scheme = "lift";
  config.s = 0.5;
  config.solver = "newton";
  config.compose = "kahan_li6";
  config.tolerance = 1e-14;
  const double finest = *std::min_element(study.steps.begin(), study.steps.end());
  long each = std::max(1L, std::lround(study.until / finest / static_cast<double>(intervals)));

  StudyReference out;
  out.kind = "none";
  out.bound = std::numeric_limits<double>::infinity();
  Motion last = follow(registry, config, intervals, each);
  while (2 * each * intervals <= kMaxReferenceSteps) {
    each *= 2;
    Motion next = follow(registry, config, intervals, each);
    const double difference =
        last.ok && next.ok ? apart(last, next) : std::numeric_limits<double>::infinity();
    if (std::isfinite(difference) && difference < out.bound) {
      out.kind = fmt::format("converged: lift, s = 0.5, {}, kahan_li6, {} steps", config.retraction,
                             each * intervals);
      out.bound = difference;
      out.coordinates = next.coordinates;
      out.velocities = next.velocities;
      if (difference < 1e-13) break;
    } else if (std::isfinite(out.bound)) {
      break;  // round-off: the pair before was better
    }
    last = std::move(next);
  }
  if (out.kind == "none") {
    out.kind = last.ok ? "none: no two steps agree" : "none: " + last.reason;
    out.bound = kNotMeasured;
  }
  return out;
}

}  // namespace

long common_intervals(const StudyConfig& config) {
  long common = 0;
  for (const double h : config.steps) common = std::gcd(common, std::lround(config.until / h));
  for (long parts = std::min(common, kMaxIntervals); parts > 1; --parts)
    if (common % parts == 0) return parts;
  return 1;
}

StudyReference reference(const Registry& registry, const StudyConfig& config, const Config& run,
                         long intervals) {
  const Integration start = Simulation(registry, run.system).config(run).build();
  StudyReference out;
  std::vector<double> times;
  for (long k = 0; k <= intervals; ++k)
    times.push_back(config.until * static_cast<double>(k) / static_cast<double>(intervals));
  if (start.system().exact) {
    out.kind = "exact";
    const ExactFlow flow = start.system().exact(start.config().start);
    for (const double t : times) {
      auto [coordinates, velocity] = flow(t);
      out.coordinates.push_back(std::move(coordinates));
      out.velocities.push_back(std::move(velocity));
    }
  } else {
    out = converged(registry, config, run, intervals);
  }
  out.times = std::move(times);
  for (const auto& there : out.coordinates)
    out.extent = std::max(out.extent, euclidean_distance(there, out.coordinates.front()));
  return out;
}

}  // namespace hamel::study
