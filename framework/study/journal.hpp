// The journal of a study (batch/journal_file.hpp): a line for each reference, cell and timing.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/batch/journal_file.hpp>
#include <hamel/framework/study/study.hpp>

namespace hamel::study {

/// The numbers of what is kept for one system: common times, columns of its element, dimension.
struct Shape {
  size_t times = 0, columns = 0, dim = 0;
};
std::vector<Shape> shapes(const Registry& registry, const StudyConfig& config);

using hamel::sealed;

/// Fills in what the lines hold, and returns a note for each that does not: no JSON object, a wrong
/// checksum, an index or a length that does not fit (shapes: one for each system).
std::vector<std::string> read_lines(const std::string& lines, const std::vector<Shape>& shapes,
                                    StudyResult& result);

/// Is all of this cell there: its reference, its metrics and its times?
bool finished_cell(const StudyResult& result, size_t cell);
/// Fills in what the parts in a folder hold, and returns notes as read_lines; ConfigError where
/// some are missing or incomplete.
std::vector<std::string> join(const std::string& folder, long count,
                              const std::vector<Shape>& shapes, StudyResult& result);

class Journal {
 public:
  /// Opens or begins the journal of a part in a folder and locks it. ConfigError when it belongs to
  /// another study or program, when its first line is damaged, when it is in use, or cannot be
  /// written.
  Journal(const std::string& folder, const StudyConfig& config, const Shard& part, bool fresh);
  /// The lines that were there, as read_lines takes them.
  std::vector<std::string> read(const std::vector<Shape>& shapes, StudyResult& result) const;
  void referred(size_t system, const StudyReference& reference);
  void measured(size_t cell, const StudyMetrics& metrics);
  void timed(size_t cell, size_t round, double nanoseconds);

 private:
  JournalFile file_;
};

}  // namespace hamel::study
