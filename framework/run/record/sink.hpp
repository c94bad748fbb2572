// Destinations of a run's rows as they come: CSV, compressed or to standard output, HDF5, JSON (the
// record alone), memory. Not installed: the builder's own (Simulation::record_to).
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hamel/framework/io/row_file.hpp>
#include <hamel/framework/run/record/result.hpp>

namespace hamel {

/// Data known before the first row.
struct RunHead {
  std::vector<ColumnGroup> columns;
  std::string config;  // as given, TOML: reads back to the same run
  std::string files;   // texts_of_files (run_file.hpp)
  std::string record;  // as it is at the start: everything resolved, nothing computed
  std::vector<std::string> events = {};  // those that are watched
};

/// The file of the events beside a CSV, "x.events.csv" of "x.csv"; "" for other formats.
std::string path_of_events(const std::string& path);

/// The events of a run, in sets and files called `events`: name, t, the columns of the
/// element and of xi. No set where none are watched.
NamedRows event_rows(const RunHead& head);
/// Rows of the events that occurred.
NamedRows event_rows(NamedRows head, const std::vector<EventMet>& met);

class Sink {
 public:
  virtual ~Sink() = default;
  virtual void begin(const RunHead& head) = 0;
  /// Whole rows, one after the other. Unfinished on failure, as in all that follows.
  virtual void rows(std::span<const double> values) = 0;
  /// Can a run resume from it? Then it receives the state at the rows so far; news: what came since
  /// the last one.
  virtual bool resumable() const { return false; }
  virtual void checkpoint(const std::string& /*state*/, const std::string& /*news*/) {}
  /// Writes all pending rows to the file now.
  virtual void flush() {}
  /// After the last row.
  virtual void finish(const Result& result) = 0;
};

/// The sink of a path by its extension, output_formats(); "-" is CSV to standard output.
std::unique_ptr<Sink> make_sink(const std::string& path);

/// "" where make_sink and its file can be had, else what is in the way.
std::string record_mistake(const std::string& path);

/// Appends to the trajectory; beyond `most` rows (0: no bound) every second one is dropped, again
/// and again.
std::unique_ptr<Sink> make_memory_sink(Trajectory& rows, std::size_t most);

}  // namespace hamel
