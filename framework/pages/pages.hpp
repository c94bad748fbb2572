// The page of a result: one HTML file with its figures, its motion, its tables and its record,
// which any browser opens from disk. The program writes the same (hamel run --report, study,
// ensemble).
//
//   const auto result = hamel::Study(hamel::registry(), config).run();
//   hamel::write_page(result, "study.html");
//
// ConfigError where the file cannot be written or is not called *.html, or where hamel was built
// without the page (-DHAMEL_REPORT_PAGE=OFF, or without node and npm).
#pragma once

#include <string>

#include <hamel/framework/io/export.hpp>

namespace hamel {

struct EnsembleResult;
class Registry;
struct Result;
struct StudyResult;

/// Verdict, motion, physics, accuracy, events and inputs of a run. Up to 100,000 of its rows are
/// shown. registry: that of its names.
HAMEL_API void write_page(const Registry& registry, const Result& result, const std::string& path);

/// What is kept over what is varied, distributions, statistics in time, all members; not of a
/// shard. A member or two are run again, for their motion: those that config.trajectories names,
/// else the first of each class.
HAMEL_API void write_page(const Registry& registry, const EnsembleResult& result,
                          const std::string& path);

/// Verdicts, work and precision, orders, growth, all cells; not of a shard.
HAMEL_API void write_page(const StudyResult& result, const std::string& path);

}  // namespace hamel
