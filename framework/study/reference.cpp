// References for the cells: the exact motion where the system has one, else lift at s = 1/2
// composed to order 6 (Kahan and Li), with steps halved until two of them agree. Their difference
// is the bound. As the order is 6, the first step need not be finer than those of the cells, and
// may be coarser.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <hamel/framework/study/parts.hpp>

namespace hamel::study {
namespace {

constexpr long kMaxIntervals = 400;
constexpr long kMaxReferenceSteps = 400'000;
constexpr double kRoundOff = 1e-8;   // two runs that differ more are not at round-off yet
constexpr double kConverged = 1e-3;  // of the motion's extent
constexpr const char* kTable = "kahan_li6";
constexpr long kStages = 9;

struct Motion {
  bool ok = true;
  std::string reason;
  std::vector<std::vector<double>> coordinates, velocities;
};

double apart(const std::vector<bool>& angles, const Motion& a, const Motion& b) {
  double out = 0;
  for (size_t k = 0; k < a.coordinates.size(); ++k) {
    update_max_abs(out, distance(angles, a.coordinates[k], b.coordinates[k]));
    update_max_abs(out, euclidean_distance(a.velocities[k], b.velocities[k]));
  }
  return out;
}

// Steps in each interval of the first run: the finest step of the cells, or a coarser one from
// which the step can be halved three times.
long first_steps_each(const StudyConfig& config) {
  const long intervals = common_intervals(config);
  const std::vector<double> steps = step_sizes(config);
  const double finest = *std::min_element(steps.begin(), steps.end());
  return std::clamp(std::lround(config.until / finest / static_cast<double>(intervals)), 1L,
                    kMaxReferenceSteps / (8 * intervals));
}

class Convergence {
 public:
  Convergence(const Registry& registry, const StudyConfig& study, const StudySystem& system,
              const Config& run, const std::function<void(long)>& stepped,
              const std::atomic<bool>* stop)
      : registry_(registry),
        system_(system),
        config_(run),
        intervals_(common_intervals(study)),
        each_(first_steps_each(study)),
        stepped_(stepped),
        stop_(stop) {
    const SystemModel made = model(registry, system);
    angles_ = angle_columns(made.group);
    const std::string& group = made.group.name;
    config_.retraction = registry.retractions_or_common(group).front();
    for (const char* good : {"cayley", "exp"})
      if (registry.geometry(group, good) != nullptr) config_.retraction = good;
    config_.scheme = "lift";
    config_.s = 0.5;
    config_.solver = "newton";
    config_.on_failure = "stop";
    config_.compose = kTable;
    config_.tolerance = 1e-14;
    config_.rtol = config_.atol = std::nullopt;
  }

  // Halves the step until two motions agree to round-off, or there agree no better than the pair
  // before.
  StudyReference find() {
    const std::string method =
        fmt::format("lift, s = {}, {}, {}", config_.s, config_.retraction, kTable);
    StudyReference out;
    out.bound = std::numeric_limits<double>::infinity();
    Motion last = follow();
    std::string why = last.reason;
    const long coarsest = each_;
    while (2 * each_ * intervals_ <= kMaxReferenceSteps && !stopped(stop_)) {
      each_ *= 2;
      Motion next = follow();
      if (!next.ok) why = next.reason;
      const double difference = last.ok && next.ok ? apart(angles_, last, next) : kNotMeasured;
      if (difference < out.bound) {
        out.kind = fmt::format("converged: {}, {} steps", method, each_ * intervals_);
        out.bound = difference;
        out.coordinates = next.coordinates;
        out.velocities = next.velocities;
        if (difference < 1e-13) break;
      } else if (out.bound < kRoundOff) {
        break;  // the pair before was better
      }
      last = std::move(next);
    }
    if (out.kind.empty()) {
      out.kind =
          fmt::format("none: {} fails with {} to {} steps: {}", method, coarsest * intervals_,
                      each_ * intervals_, why.empty() ? "its states are not finite" : why);
      out.bound = kNotMeasured;
    }
    return out;
  }

 private:
  // The states at the ends of the intervals, with that many steps in each.
  Motion follow() const {
    Config config = config_;
    config.step = config.until / static_cast<double>(intervals_ * each_);
    Run run = simulation(registry_, system_, config).build();
    Motion out;
    for (long k = 0; k <= intervals_; ++k) {
      if (k > 0) {
        const Status status = advance(run, each_, stop_);
        if (stopped(stop_)) return {false, "interrupted", {}, {}};
        if (!status.ok) return {false, status.reason, {}, {}};
        stepped_(each_ * kStages);
      }
      out.coordinates.push_back(run.state().coordinates);
      out.velocities.push_back(run.state().velocity);
    }
    return out;
  }

  const Registry& registry_;
  const StudySystem& system_;
  Config config_;
  std::vector<bool> angles_;
  long intervals_, each_;
  const std::function<void(long)>& stepped_;
  const std::atomic<bool>* stop_;
};

}  // namespace

std::vector<double> step_sizes(const StudyConfig& config) {
  std::vector<double> out;
  for (const std::string& h : config.values("step")) read_text("step", h, out.emplace_back());
  return out;
}

long common_intervals(const StudyConfig& config) {
  long common = 0;
  for (const double h : step_sizes(config))
    common = std::gcd(common, std::lround(config.until / h));
  for (long parts = std::min(common, kMaxIntervals); parts > 1; --parts)
    if (common % parts == 0) return parts;
  return 1;
}

long reference_steps(const Registry& registry, const StudyConfig& config,
                     const StudySystem& system) {
  const long intervals = common_intervals(config);
  if (!config.reference || model(registry, system).exact) return intervals;
  return 7 * kStages * intervals * first_steps_each(config);  // a run, and twice with half the step
}

StudyReference reference(const Registry& registry, const StudyConfig& config,
                         const StudySystem& system, const Config& run,
                         const std::function<void(long)>& stepped, const std::atomic<bool>* stop) {
  const long intervals = common_intervals(config);
  const Run start = simulation(registry, system, run).build();
  StudyReference out;
  std::vector<double> times;
  for (long k = 0; k <= intervals; ++k)
    times.push_back(config.until * static_cast<double>(k) / static_cast<double>(intervals));
  if (!config.reference) {
    out.kind = "none: the study does not ask for errors";
    out.bound = kNotMeasured;
  } else if (start.system().exact) {
    out.kind = "exact";
    const ExactFlow flow = start.system().exact(start.config().start);
    for (const double t : times) {
      if (stopped(stop)) break;
      auto [coordinates, velocity] = flow(t);
      out.coordinates.push_back(std::move(coordinates));
      out.velocities.push_back(std::move(velocity));
    }
  } else {
    out = Convergence(registry, config, system, run, stepped, stop).find();
  }
  if (stopped(stop)) return {};
  out.times = std::move(times);
  const std::vector<bool> angles = angle_columns(start.system().group);
  for (const auto& there : out.coordinates)
    update_max_abs(out.extent, distance(angles, there, out.coordinates.front()));
  // A pair of runs that differ by more than that does not converge, and nothing is derived from it.
  if (out.bound > kConverged * out.extent) {
    out.kind =
        fmt::format("not {}, which differs by {:.1e} from half as many", out.kind, out.bound);
    out.bound = kNotMeasured;
    out.coordinates.clear();
    out.velocities.clear();
  }
  return out;
}

}  // namespace hamel::study
