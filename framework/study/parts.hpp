// What the sources of a study share; not installed.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include <hamel/framework/measures.hpp>
#include <hamel/framework/study.hpp>

namespace hamel::study {

/// How many equal intervals of [0, until] have ends that every step reaches; at most 400.
long common_intervals(const StudyConfig& config);

/// The exact motion of a system at the ends of those intervals, else a converged one.
StudyReference reference(const Registry& registry, const StudyConfig& config, const Config& run,
                         long intervals);

/// One run with recording. Not done when stop became true on the way.
StudyMetrics measure(const Registry& registry, const StudyCell& cell,
                     const StudyReference& reference, const std::atomic<bool>* stop);

/// Nanoseconds per step without recording, NaN without a good step or when stopped.
double time_per_step(const Registry& registry, const StudyCell& cell,
                     const std::atomic<bool>* stop);

/// Measured orders and the distances between solvers, from all cells together.
void compare(const StudyConfig& config, const std::vector<StudyCell>& cells,
             const std::vector<StudyReference>& references, std::vector<StudyMetrics>& metrics);

/// Least-squares slope of y over x; NaN for fewer than two different x.
double slope(const std::vector<double>& x, const std::vector<double>& y);

inline bool stopped(const std::atomic<bool>* flag) { return flag != nullptr && flag->load(); }

}  // namespace hamel::study
