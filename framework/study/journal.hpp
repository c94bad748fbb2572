// The journal of a study: one line of JSON for each finished piece of work, appended and flushed, so that a
// killed study goes on where it stopped. Its first line says which study and which program it belongs to.
#pragma once

#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <hamel/framework/study/study.hpp>

namespace hamel::study {

class Journal {
 public:
  /// Opens or begins folder/journal.jsonl and locks it. ConfigError when it belongs to another study or
  /// program, is in use, or cannot be written.
  Journal(const std::string& folder, const StudyConfig& config, bool fresh);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Fills in what the lines that were there hold.
  void read(StudyResult& result) const;
  void referred(size_t system, const StudyReference& reference);
  void measured(size_t cell, const StudyMetrics& metrics);
  void timed(size_t cell, size_t round, double nanoseconds);

 private:
  void append(const std::string& line);

  std::string path_, old_;
  std::FILE* file_ = nullptr;
  std::mutex mutex_;
};

}  // namespace hamel::study
