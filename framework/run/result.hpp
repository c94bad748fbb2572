// What a run leaves behind: status, trajectory, record, and the ways to read or write them.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include <hamel/framework/loop/kernel.hpp>
#include <hamel/framework/run/config.hpp>
#include <hamel/framework/run/measures.hpp>

namespace hamel {

/// The recorded rows: named columns, row-major numbers.
class Trajectory {
 public:
  explicit Trajectory(std::vector<std::string> columns = {}) : columns_(std::move(columns)) {}
  const std::vector<std::string>& columns() const { return columns_; }
  size_t rows() const { return columns_.empty() ? 0 : values_.size() / columns_.size(); }
  std::span<const double> row(size_t i) const {
    return std::span(values_).subspan(i * columns_.size(), columns_.size());
  }
  double at(size_t i, size_t j) const { return values_[i * columns_.size() + j]; }
  double& at(size_t i, size_t j) { return values_[i * columns_.size() + j]; }
  /// The index of a column; ConfigError naming the nearest when there is none.
  size_t index(const std::string& column) const;
  std::vector<double> column(const std::string& name) const;
  bool has(const std::string& column) const;
  void append(std::span<const double> row) {
    values_.insert(values_.end(), row.begin(), row.end());
  }
  void reserve(size_t rows) { values_.reserve(rows * columns_.size()); }

 private:
  std::vector<std::string> columns_;
  std::vector<double> values_;
};

/// An event that was met, and the state there.
struct EventMet {
  std::string name;
  double time = 0;
  std::vector<double> coordinates, velocity;
};

struct Result : Measurements {
  Config config;  // as it was run: start and parameters filled in
  SystemModel system;
  std::vector<std::string> unused;  // options that the scheme makes no use of
  std::vector<std::string> notes;   // what the user should know (a start that was projected, ...)
  Status status;
  Snapshot last;  // the last good state
  long steps = 0;
  Trajectory trajectory;
  std::vector<EventMet> events;
  bool stopped_by_event = false;
  SolverStats stats;
  double seconds = 0;  // of the time loop, recording included

  explicit operator bool() const { return status.ok; }
  /// "lift (s = 0.5), cayley, newton": the method, without what the scheme makes no use of.
  std::string method() const;
  /// "h = 0.01", or the tolerances that chose the steps.
  std::string steps_in_words() const;
  /// The record of tools/README.md as JSON; indent < 0 for one line.
  std::string record(int indent = 2) const;
  /// One screen of text: status, iterations, drifts, error against the exact solution.
  std::string report() const;
  /// Writes by extension: .csv (rows, then the record in # lines) or .json (the record). The file
  /// appears whole or not at all. ConfigError when it cannot be written.
  void write(const std::string& path) const;
  void write_csv(std::ostream& out) const;
};

/// The machine this runs on: node name, system, architecture.
std::string host_name();

/// The extensions that Result::write knows.
const std::vector<std::string>& output_formats();

/// Writes text to a temporary beside path and renames it into place; ConfigError on failure.
void write_file(const std::string& path, const std::string& text);

/// "" when a file can be created at path, else what is in the way. Leaves nothing behind.
std::string unwritable(const std::string& path);

}  // namespace hamel
