// Result of a run: status, trajectory, record, and the ways to read or write them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/export.hpp>
#include <hamel/framework/io/note_lines.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/row_file.hpp>
#include <hamel/framework/loop/snapshot.hpp>
#include <hamel/framework/run/names/config.hpp>
#include <hamel/framework/run/record/measures.hpp>

namespace hamel {

class Inputs;
struct SystemModel;

/// The recorded rows: named columns, row-major numbers.
class HAMEL_API Trajectory {
 public:
  explicit Trajectory(std::vector<ColumnGroup> groups = {});
  /// The columns with their units, those of a vector together.
  const std::vector<ColumnGroup>& groups() const { return groups_; }
  const std::vector<std::string>& columns() const { return columns_; }
  size_t rows() const { return columns_.empty() ? 0 : values_.size() / columns_.size(); }
  std::span<const double> values() const { return values_; }
  std::span<const double> row(size_t i) const {
    return std::span(values_).subspan(i * columns_.size(), columns_.size());
  }
  double at(size_t i, size_t j) const { return values_[i * columns_.size() + j]; }
  double& at(size_t i, size_t j) { return values_[i * columns_.size() + j]; }
  /// The index of a column, also by another name that is read (4_theta, xi4); ConfigError naming
  /// the nearest when there is none.
  size_t index(const std::string& column) const;
  std::vector<double> column(const std::string& name) const;
  bool has(const std::string& column) const;
  /// Rows, one after the other.
  void append(std::span<const double> rows);
  /// Drops every second row.
  void thin();
  /// 1: every recorded row is here; else every so manyth, and the last.
  size_t stride() const { return stride_; }
  void stride(size_t stride) { stride_ = stride; }

 private:
  std::optional<size_t> find(const std::string& column) const;

  std::vector<ColumnGroup> groups_;
  std::vector<std::string> columns_;
  std::vector<double> values_;
  size_t stride_ = 1;
};

/// An event that was met, and the state there.
struct EventMet {
  std::string name;
  double time = 0;
  std::vector<double> coordinates, velocity;
  std::vector<double> velocity_after = {};  // where the event itself changes it, as an impact does
};

struct Result;
/// Rows that are states alone until they are read.
class HAMEL_API UnreadRows {
 public:
  virtual ~UnreadRows() = default;
  /// Adds trajectory, measurements and their notes to the result of the run.
  virtual void read(Result& out) = 0;
};

/// Without a run, made by default or moved from, record(), report() and write() throw
/// std::logic_error.
struct HAMEL_API Result : Measurements {
  Result();
  Result(const Result&);
  Result(Result&&) noexcept;
  Result& operator=(const Result&);
  Result& operator=(Result&&) noexcept;
  ~Result();

  Config config;                              // as it was run: start and parameters filled in
  std::shared_ptr<const SystemModel> system;  // <hamel/hamel.hpp> has its members
  std::shared_ptr<const Inputs> inputs;       // null without
  std::vector<std::string> unused;            // options that the scheme makes no use of
  std::vector<std::string> notes;  // notes for the user (a start that was projected, ...)
  Status status;
  Snapshot last;  // the last good state
  long steps = 0;
  Trajectory trajectory;
  std::vector<EventMet> events;
  bool stopped_by_event = false;
  SolverStats stats;
  double seconds = 0;  // of the time loop, recording included; NaN of steps by hand without rows
  double recording_seconds = 0;  // of these, to measure and write states
  double comparing_seconds = 0;  // beside them: equations of motion, invariants, exact motion

  explicit operator bool() const { return status.ok; }
  /// Result of Simulation::run_unread: computes trajectory, the measurements and their notes, once;
  /// before it they are empty.
  Result& read();
  /// Rows that are computed by read().
  void unread(std::shared_ptr<UnreadRows> rows) { unread_ = std::move(rows); }
  /// "lift (s = 0.5), cayley, newton": the method, without what the scheme makes no use of.
  std::string method() const;
  /// "h = 0.01", or the tolerances that chose the steps.
  std::string steps_in_words() const;
  /// The record of tools/README.md as JSON; indent < 0 for one line.
  std::string record(int indent = 2) const;
  /// Report on one screen: status, notes, iterations, drifts, error against the exact solution.
  /// The whole text of the notes is in `notes`.
  std::string report(Notes length = Notes::brief) const;
  /// Writes by extension, output_formats(): the rows that are in memory and the record, or (.json)
  /// the record. The file appears whole or not at all. ConfigError when it cannot be written.
  void write(const std::string& path) const;

 private:
  void require_run(const char* member) const;
  std::shared_ptr<UnreadRows> unread_;
};

/// The two runs by which an error is estimated (check), described.
const char* finer_runs(const Config& config);

/// A run in a file, .h5: how to resume it. ConfigError where the file holds none.
struct Recorded {
  std::string path;  // without .part
  bool finished;
  Config config;  // unfinished: as it was given; finished: where it ended, for as long again
};
HAMEL_API Recorded read_recorded(const std::string& path);

/// The machine this runs on: node name, system, architecture.
std::string host_name();

/// The extensions that Result::write and Simulation::record_to accept.
HAMEL_API const std::vector<std::string>& output_formats();

}  // namespace hamel
