// Definitions that the sources of a study share; not installed.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/run/record/measures.hpp>
#include <hamel/framework/run/run/simulation.hpp>
#include <hamel/framework/study/study.hpp>

namespace hamel::study {

/// A timing that is still to be taken.
constexpr double kPending = -1;

/// Reads the files of systems that are given by one, where their text is not there yet.
void read_data(StudyConfig& config);

/// A run of a study's system, with the text that the study read.
Simulation simulation(const Registry& registry, const StudySystem& system, const Config& config);

/// The system with its parameters, of a study without mistakes.
SystemModel model(const Registry& registry, const StudySystem& system);

inline bool stopped(const std::atomic<bool>* flag) { return flag != nullptr && flag->load(); }

/// Takes that many steps, or fewer when one fails or the flag, which is polled on the way, becomes
/// true.
Status advance(Run& run, long steps, const std::atomic<bool>* stop);

/// The values of the axis "step".
std::vector<double> step_sizes(const StudyConfig& config);

/// How many equal intervals of [0, until] have ends that every step reaches; at most 400.
long common_intervals(const StudyConfig& config);

/// The exact motion of a system at the ends of those intervals, else a converged one. `run` is any
/// of its cells, `stepped` receives the steps taken. Without times when stop became true on the
/// way.
StudyReference reference(const Registry& registry, const StudyConfig& config,
                         const StudySystem& system, const Config& run,
                         const std::function<void(long)>& stepped, const std::atomic<bool>* stop);

/// About how many of those steps there will be, for the progress.
long reference_steps(const Registry& registry, const StudyConfig& config,
                     const StudySystem& system);

/// Measures a run with recording. Not done when stop became true on the way.
StudyMetrics measure(const Registry& registry, const StudySystem& system, const StudyCell& cell,
                     const StudyReference& reference, const std::atomic<bool>* stop);

/// Nanoseconds per step without recording, NaN without a good step or when stopped.
double time_per_step(const Registry& registry, const StudySystem& system, const StudyCell& cell,
                     const std::atomic<bool>* stop);

/// Measured orders and the distances between solvers, from all cells together; angles of each
/// system.
void compare(const StudyConfig& config, const StudyCells& cells,
             const std::vector<std::vector<bool>>& angles,
             const std::vector<StudyReference>& references, std::vector<StudyMetrics>& metrics);

/// The columns of the table that a cell which was run has: f(Quantity, member pointer) for what one
/// run of it leaves, which the journal keeps too, f(Quantity, function of cell, metrics, reference)
/// for what follows.
template <class F>
void measured_columns(F&& f) {
  using C = const StudyCell&;
  using M = const StudyMetrics&;
  using R = const StudyReference&;
  using Metrics = StudyMetrics;
  const auto per_step = [](long total, long steps) {
    return steps > 0 ? static_cast<double>(total) / static_cast<double>(steps) : kNotMeasured;
  };
  f(Quantity{"steps", "1", "good steps"}, &Metrics::steps);
  f(Quantity{"time", "s", "reached"}, &Metrics::time);
  f(Quantity{"error", "columns of g", "largest distance from the reference at the common times"},
    &Metrics::error);
  f(Quantity{"error_final", "columns of g", "the same at the end"}, &Metrics::error_final);
  f(Quantity{"velocity_error", "columns of xi", "largest distance of the body velocity"},
    &Metrics::velocity_error);
  f(Quantity{"reference_bound", "columns of g and xi", "of the reference's own error; 0: exact"},
    [](C, M, R reference) { return reference.bound; });
  f(Quantity{"floor", "columns of g", "errors below are round-off, residuals and the reference"},
    &Metrics::floor);
  f(Quantity{"order", "1", "slope of log error over log step, least squares"},
    [](C, M m, R) { return m.order; });
  f(Quantity{"order_finest", "1", "the same from the two finest steps used"},
    [](C, M m, R) { return m.order_finest; });
  f(Quantity{"order_points", "1", "steps used for it: above the floor, below 0.1 of the motion"},
    [](C, M m, R) { return m.order_points; });
  f(Quantity{"order_of", "1", "steps there are"}, [](C, M m, R) { return m.order_of; });
  f(Quantity{"claimed_order", "1", "with this s, retraction and composition; 0: none"},
    [](C cell, M, R) { return cell.claimed_order; });
  f(kEnergyError, &Metrics::energy_error);
  f(Quantity{"energy_slope", "1/s", "of (E - E0) / |E0| over time, least squares"},
    &Metrics::energy_slope);
  f(kConstraint, &Metrics::constraint);
  f(kGroupDefect, &Metrics::group_defect);
  f(Quantity{"iterations_mean", "1", "per step"},
    [&](C, M m, R) { return per_step(m.iterations, m.steps); });
  f(Quantity{"iterations_max", "1", "in one step"}, &Metrics::iterations_max);
  f(Quantity{"evaluations_mean", "1", "of the equation, per step"},
    [&](C, M m, R) { return per_step(m.evaluations, m.steps); });
  f(Quantity{"evaluations", "1", "of the equation, whole run"}, &Metrics::evaluations);
  f(Quantity{"fallbacks", "1", "steps that failed and were rescued by on_failure"},
    &Metrics::fallbacks);
  f(kResidual, &Metrics::residual);
  f(Quantity{"failure_residual", "1", "|F| / scale of the step that failed"},
    &Metrics::failure_residual);
  f(Quantity{"solver_difference", "columns of g",
             "at the end, from the first solver in the same cell that did not fail"},
    [](C, M m, R) { return m.solver_difference; });
  f(Quantity{"ns_per_step", "ns", "processor time, median of the timing rounds, nothing recorded"},
    [](C, M m, R) { return m.nanoseconds_median(); });
  f(Quantity{"seconds", "s", "steps times ns_per_step"},
    [](C, M m, R) { return 1e-9 * m.nanoseconds_median() * static_cast<double>(m.steps); });
}

/// Which of a group's columns are angles: those called theta, in products too.
std::vector<bool> angle_columns(const GroupInfo& group);
/// An element's columns, its angles turned by full turns to be next to those of another.
std::vector<double> turned_towards(const std::vector<bool>& angles, std::span<const double> other,
                                   std::vector<double> element);
/// Euclidean distance of two elements' columns, angles by what is left of full turns.
double distance(const std::vector<bool>& angles, const std::vector<double>& a,
                const std::vector<double>& b);

/// Least-squares slope of y over x; NaN for fewer than two different x.
double slope(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace hamel::study
