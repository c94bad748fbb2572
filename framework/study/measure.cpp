// Cell of a study: a run with recording, and the time of one without.
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include <hamel/framework/mechanics/components.hpp>
#include <hamel/framework/run/run/driver.hpp>
#include <hamel/framework/run/run/step_follower.hpp>
#include <hamel/framework/study/parts.hpp>

namespace hamel::study {
namespace {

constexpr long kLeastRows = 50;

double norm(const std::vector<double>& v) {
  return euclidean_distance(v, std::vector<double>(v.size(), 0));
}

// Rows for each common interval: the fewest that divide its steps and make kLeastRows rows in all.
long rows_each(long steps_each, long intervals) {
  for (long rows = 1; rows < steps_each; ++rows)
    if (steps_each % rows == 0 && rows * intervals >= kLeastRows) return rows;
  return steps_each;
}

// Nanoseconds that this thread has been running: other threads and programs do not count. Where the
// system has no such clock, as WebAssembly, those that have passed.
double processor_time() {
  timespec now{};
  if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now) != 0) {
    const auto passed = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::nano>(passed).count();
  }
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

// Follows a run along the reference.
class CellMeter final : public StepFollower {
 public:
  CellMeter(const GroupInfo& group, const StudyReference& reference, EnergyBalance balance,
            StudyMetrics& out)
      : angles_(angle_columns(group)),
        reference_(reference),
        balance_(std::move(balance)),
        out_(out) {
    if (reference.coordinates.empty()) return;
    all_.exact_error_final = all_.exact_error_max = all_.exact_velocity_error_max = 0;
  }

  // Where work is done every node is seen: also those where an input jumps within a step.
  void start(Run& run) {
    if (!balance_.active()) return;
    balance_.node(run.state());
    run.driver().follow(this);
  }
  void step(double begin, const Snapshot& end, const Within& motion_within) override {
    balance_.step(begin, end, motion_within);
  }
  void impact(const Snapshot& before, const Snapshot& after) override {
    balance_.impact(before, after);
  }
  // Not ok where the state is no good one.
  Status row(const Snapshot& state) {
    if (const Reason flaw = flaw_of(state); flaw != Reason::converged)
      return {false, state.step, state.time, state.residual, to_string(flaw)};
    if (balance_.active()) balance_.row(state);
    if (times_.empty()) energy_start_ = state.energy;
    times_.push_back(state.time);
    energy_.push_back(all_.take(state, energy_start_));
    update_max_abs(size_, norm(state.coordinates));
    return {};
  }
  void compare(const Snapshot& state, size_t k) {
    if (reference_.coordinates.empty()) return;
    all_.compare(state, turned_towards(angles_, state.coordinates, reference_.coordinates[k]),
                 reference_.velocities[k]);
  }
  void finish(Run& run) {
    const SolverStats& stats = run.stats();
    const Snapshot& state = run.state();
    out_.done = true;
    if (balance_.active()) {
      balance_.finish();
      all_.balance(balance_.error_max(), balance_.work());
      std::vector<BalancedState> states;
      balance_.settled(states);
      for (size_t i = 0; i < states.size(); ++i) energy_[i] = states[i].defect / balance_.scale();
    }
    out_.steps = state.step;
    out_.time = state.time;
    out_.final = state.coordinates;
    out_.iterations = stats.iterations;
    out_.evaluations = stats.evaluations;
    out_.iterations_max = stats.iterations_max;
    out_.fallbacks = stats.fallbacks;
    out_.residual = stats.residual_max;
    out_.energy_slope = slope(times_, energy_);
    out_.floor =
        10 * (reference_.bound + (stats.residual_max + 2.2e-16) * (1 + size_) *
                                     std::sqrt(static_cast<double>(std::max(state.step, 1L))));
    out_.energy_error = all_.energy_error_max;
    out_.constraint = all_.constraint_max;
    out_.group_defect = all_.group_defect_max;
    if (!out_.ok) return;
    out_.error = all_.exact_error_max;
    out_.error_final = all_.exact_error_final;
    out_.velocity_error = all_.exact_velocity_error_max;
  }

 private:
  std::vector<bool> angles_;
  const StudyReference& reference_;
  EnergyBalance balance_;
  StudyMetrics& out_;
  Measurements all_;
  double energy_start_ = 0, size_ = 0;
  std::vector<double> times_, energy_;
};

}  // namespace

std::vector<bool> angle_columns(const GroupInfo& group) {
  std::vector<bool> out;
  for (const std::string& unit : units_of_element(group)) out.push_back(unit == "rad");
  return out;
}

std::vector<double> turned_towards(const std::vector<bool>& angles, std::span<const double> other,
                                   std::vector<double> element) {
  constexpr double turn = 2 * std::numbers::pi;
  for (size_t j = 0; j < element.size(); ++j)
    if (angles[j]) element[j] += turn * std::round((other[j] - element[j]) / turn);
  return element;
}

double distance(const std::vector<bool>& angles, const std::vector<double>& a,
                const std::vector<double>& b) {
  return euclidean_distance(a, turned_towards(angles, a, b));
}

double slope(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / n;
    mean_y += y[i] / n;
  }
  for (size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return xx > 0 && std::isfinite(xy) ? xy / xx : kNotMeasured;
}

static Status follow(Run& run, CellMeter& meter, const StudyReference& reference,
                     const std::atomic<bool>* stop) {
  const long steps = run.config().steps();
  const long intervals = static_cast<long>(reference.times.size()) - 1;
  const long rows = rows_each(steps / intervals, intervals), every = steps / (intervals * rows);
  for (long row = 1; row <= intervals * rows && !stopped(stop); ++row) {
    const Status status = advance(run, every, stop);
    const Snapshot& state = run.state();
    const Status measured = meter.row(state);
    if (!status.ok) return status;
    if (!measured.ok) return measured;
    if (row % rows == 0) meter.compare(state, static_cast<size_t>(row / rows));
  }
  return {};
}
// Steps that are chosen are not cut at the common times: there the dense output is compared.
static Status follow_chosen(Run& run, CellMeter& meter, const StudyReference& reference,
                            const std::atomic<bool>* stop) {
  const double until = run.config().until;
  for (size_t next = 1; next < reference.times.size() && !stopped(stop);) {
    const Status status = run.step_towards(until);
    const Snapshot& state = run.state();
    const double reached = state.time;
    const Status measured = meter.row(state);
    if (!status.ok) return status;
    if (!measured.ok) return measured;
    for (; next < reference.times.size() && reference.times[next] <= reached * (1 + 1e-12); ++next)
      meter.compare(run.at(std::min(reference.times[next], reached)), next);
  }
  return {};
}

StudyMetrics measure(const Registry& registry, const StudySystem& system, const StudyCell& cell,
                     const StudyReference& reference, const std::atomic<bool>* stop) {
  StudyMetrics out;
  const Config config = cell.config();
  Run run = simulation(registry, system, config).build();
  CellMeter meter(run.system().group, reference, run.driver().balance(), out);
  out.ok = true;
  meter.start(run);
  static_cast<void>(meter.row(run.state()));
  meter.compare(run.state(), 0);
  const Status status = config.chooses_steps() ? follow_chosen(run, meter, reference, stop)
                                               : follow(run, meter, reference, stop);
  if (stopped(stop)) return out;
  if (!status.ok) {
    out.ok = false;
    out.reason = status.reason;
    out.failure_residual = status.residual;
  }
  meter.finish(run);
  return out;
}

double time_per_step(const Registry& registry, const StudySystem& system, const StudyCell& cell,
                     const std::atomic<bool>* stop) {
  constexpr double kShortest = 2e5;  // ns: a shorter run is repeated until this is reached
  const Config config = cell.config();
  Run run = simulation(registry, system, config).build();
  const Start start = run.config().start;
  double nanoseconds = 0;
  long steps = 0;
  for (int i = 0; i < 100 && nanoseconds < kShortest; ++i) {
    if (i > 0) run.restart(start);
    const double begin = processor_time();
    if (config.chooses_steps()) run.advance_to(config.until);
    else advance(run, config.steps(), stop);
    if (stopped(stop)) return kNotMeasured;
    nanoseconds += processor_time() - begin;
    steps += run.state().step;
  }
  return steps > 0 ? nanoseconds / static_cast<double>(steps) : kNotMeasured;
}

}  // namespace hamel::study
