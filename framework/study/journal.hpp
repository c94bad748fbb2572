// The journal of a study: one line of JSON for each finished piece of work, appended and flushed,
// so that a killed study goes on where it stopped. Its first line says which study and which
// program it belongs to. Each further line ends with a checksum: a damaged one is left out, and its
// piece of work is done again.
#pragma once

#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <hamel/framework/study/study.hpp>

namespace hamel::study {

/// The numbers of what is kept for one system: common times, columns of its element, dimension.
struct Shape {
  size_t times = 0, columns = 0, dim = 0;
};
std::vector<Shape> shapes(const Registry& registry, const StudyConfig& config);

/// A JSON object with the checksum of its text as the last member, "sum".
std::string sealed(const std::string& object);

/// Fills in what the lines hold, and returns a note for each that does not: no JSON object, a wrong
/// checksum, an index or a length that does not fit (shapes: one for each system).
std::vector<std::string> read_lines(const std::string& lines, const std::vector<Shape>& shapes,
                                    StudyResult& result);

class Journal {
 public:
  /// Opens or begins folder/journal.jsonl and locks it. ConfigError when it belongs to another
  /// study or program, when its first line is damaged, when it is in use, or cannot be written.
  Journal(const std::string& folder, const StudyConfig& config, bool fresh);
  /// The lines that were there, after the first.
  const std::string& lines() const { return old_; }
  void referred(size_t system, const StudyReference& reference);
  void measured(size_t cell, const StudyMetrics& metrics);
  void timed(size_t cell, size_t round, double nanoseconds);

 private:
  void append(const std::string& line);

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_, old_;
  std::unique_ptr<std::FILE, Close> file_;
  std::mutex mutex_;
};

}  // namespace hamel::study
