// What the sources of a study share; not installed.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include <hamel/framework/run/measures.hpp>
#include <hamel/framework/run/simulation.hpp>
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

/// That many steps, or fewer when one fails or the flag, which is polled on the way, becomes true.
Status advance(Integration& run, long steps, const std::atomic<bool>* stop);

/// How many equal intervals of [0, until] have ends that every step reaches; at most 400.
long common_intervals(const StudyConfig& config);

/// The exact motion of a system at the ends of those intervals, else a converged one. `run` is any of its
/// cells, `stepped` is told the steps taken. Without times when stop became true on the way.
StudyReference reference(const Registry& registry, const StudyConfig& config,
                         const StudySystem& system, const Config& run,
                         const std::function<void(long)>& stepped, const std::atomic<bool>* stop);

/// About how many of those steps there will be, for the progress.
long reference_steps(const Registry& registry, const StudyConfig& config,
                     const StudySystem& system);

/// One run with recording. Not done when stop became true on the way.
StudyMetrics measure(const Registry& registry, const StudySystem& system, const StudyCell& cell,
                     const StudyReference& reference, const std::atomic<bool>* stop);

/// Nanoseconds per step without recording, NaN without a good step or when stopped.
double time_per_step(const Registry& registry, const StudySystem& system, const StudyCell& cell,
                     const std::atomic<bool>* stop);

/// Measured orders and the distances between solvers, from all cells together.
void compare(const StudyConfig& config, const std::vector<StudyCell>& cells,
             const std::vector<StudyReference>& references, std::vector<StudyMetrics>& metrics);

/// Least-squares slope of y over x; NaN for fewer than two different x.
double slope(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace hamel::study
