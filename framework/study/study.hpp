// A comparative study: one run ("cell") for each combination of systems and of the values of those
// options that the study varies, all measured in the same way.
//
//   auto config = hamel::read_study("readings.toml", hamel::registry());
//   auto result = hamel::Study(hamel::registry(), config).threads(2).folder("out").run();
//   result.write("out");   // cells.csv, cells.h5, record.json
//
// Each cell is run once with recording (its errors, counts and drifts: the same whatever the number
// of threads), then timed in rounds over all cells, so that a slow moment of the machine slows all
// alike. The measured quantities and their sources: framework/study/README.md.
#pragma once

#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <hamel/framework/batch/batch.hpp>
#include <hamel/framework/io/export.hpp>
#include <hamel/framework/io/table.hpp>
#include <hamel/framework/run/names/config.hpp>

namespace hamel {

class Registry;
struct SystemModel;

/// A registered system with its parameters and start, or a file "my_system.toml" (data_system.hpp);
/// the label is what tables call it.
struct StudySystem {
  std::string label, name;
  Parameters parameters = {};
  Start start = {};
  InputSignals inputs = {};  // their files are read once, at the study's beginning
  std::string data = {};     // the file's text: a study reads it once, at its beginning
  /// A system of the program in place of a registered one or a file: maker(mechanism). No journal
  /// can have it: no folder.
  std::function<SystemModel(const Parameters&)> model = {};
};

/// Combinations that are left out: one entry per axis named, any of its values; axes not named
/// match all.
struct StudyExclusion {
  std::map<std::string, std::vector<std::string>> values;
  std::string why;
};

/// The values of an axis, as text: {"lift", "boxed"} or {0, 0.5}.
struct StudyValues : std::vector<std::string> {
  struct Value {
    Value(const char* name) : text(name) {}
    Value(int number) : text(text_of(static_cast<double>(number))) {}
    Value(double number) : text(text_of(number)) {}
    std::string text;
  };
  StudyValues() = default;
  StudyValues(std::initializer_list<Value> values) {
    for (const Value& value : values) push_back(value.text);
  }
};

/// A study as plain data: systems, and for each option that it varies (Config::fields) its values.
struct HAMEL_API StudyConfig {
  std::string title = "Study";
  bool zipped = false;            // the lists run together instead of in all combinations
  double until = Config().until;  // seconds
  int repeats = 3;                // timing rounds
  bool reference = true;  // false: no errors and orders, and no motion to measure them against
  std::vector<StudySystem> systems;
  std::map<std::string, StudyValues> axes;  // those not named have the default of a run
  std::vector<StudyExclusion> exclude;
  std::string text;  // the file that it came from, for the record

  /// "file:line:column" by key, "scheme[1]"; empty for a study made in a program.
  std::map<std::string, std::string> where;

  /// The values of an axis, in the order given; of "system" the labels.
  StudyValues values(const std::string& axis) const;
  /// Everything that is wrong, each mistake with its place.
  std::vector<std::string> mistakes(const Registry& registry) const;
  /// Settings that fix the results, one line per item: a journal belongs to these lines.
  std::string fingerprint() const;
};

/// system, then the options that Config::fields lets a study vary: the last, step, runs fastest.
HAMEL_API const std::vector<std::string>& study_axes();

/// Throws ConfigError with all mistakes of the file, each with line and column.
HAMEL_API StudyConfig parse_study(const std::string& text, const std::string& origin,
                                  const Registry& registry);
HAMEL_API StudyConfig read_study(const std::string& path, const Registry& registry);

/// A value on an axis: as text, and as the option of a run.
struct StudyAxisValue {
  std::string text;
  Config config = {};  // with this option set
};

/// The values of a cell on the axes. Cells of one study share them: a cell has addresses.
class HAMEL_API StudyAxes {
 public:
  /// The text. Throws std::out_of_range on a name that is not in study_axes().
  const std::string& at(const std::string& axis) const;
  bool contains(const std::string& axis) const;
  void set(const std::string& axis, std::shared_ptr<const StudyAxisValue> value);
  /// The options of `run` that are axes become the values here.
  void apply(Config& run) const;
  /// Axes without the value on this one.
  StudyAxes without(const std::string& axis) const;
  bool operator<(const StudyAxes& other) const;

 private:
  std::vector<std::shared_ptr<const StudyAxisValue>> values_;  // in the order of study_axes()
};

/// Combination that is run, or skipped and why.
struct HAMEL_API StudyCell {
  size_t system = 0;                   // index into the systems
  std::shared_ptr<const Config> base;  // of the cells of one system: all but the axes
  /// The value on each axis as text; of a cell that is run, empty where its scheme makes no use
  /// of it.
  StudyAxes axes;
  std::string skipped;  // "" (it is run), "excluded", "impossible" or "duplicate"
  std::string why;
  int claimed_order = 0;  // with this s, retraction and composition; 0: it claims none

  /// Ready to run. A cell keeps what it shares with others: 1e5 configurations would take 60 MB.
  Config config() const;
  bool runs() const { return skipped.empty(); }
};

/// The cells of a study, which its results share.
class StudyCells {
 public:
  StudyCells();
  explicit StudyCells(std::vector<StudyCell> cells);
  size_t size() const { return cells_->size(); }
  bool empty() const { return cells_->empty(); }
  const StudyCell& operator[](size_t i) const { return (*cells_)[i]; }
  const StudyCell& front() const { return cells_->front(); }
  auto begin() const { return cells_->begin(); }
  auto end() const { return cells_->end(); }

 private:
  std::shared_ptr<const std::vector<StudyCell>> cells_;
};

/// All combinations in order, those that are not run too.
HAMEL_API StudyCells study_cells(const StudyConfig& config, const Registry& registry);

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// An error above this part of the motion's extent does not measure the order.
constexpr double kAsymptotic = 0.1;

/// For the progress of a study; of steps that are chosen the number is not known before.
inline long expected_steps(const Config& config) {
  return config.chooses_steps() ? 1000 : config.steps();
}

/// Results of one cell. NaN: not measured, or nothing finite.
struct HAMEL_API StudyMetrics {
  bool done = false;  // false: the study was stopped before
  bool ok = false;
  std::string reason;  // of a failure
  long steps = 0;      // good ones
  double time = 0;     // reached, seconds
  double failure_residual = kNotMeasured;
  // Over the common times, distance from the exact motion or the reference.
  double error = kNotMeasured, error_final = kNotMeasured, velocity_error = kNotMeasured;
  double energy_error = kNotMeasured, energy_slope = kNotMeasured;  // relative; relative per second
  double constraint = kNotMeasured, group_defect = kNotMeasured;
  long iterations = 0, evaluations = 0, iterations_max = 0;
  long fallbacks = 0;               // steps that failed and were rescued by on_failure
  double residual = kNotMeasured;   // relative, the largest of the run
  double floor = kNotMeasured;      // errors below are round-off, residuals and the reference
  std::vector<double> final;        // the element's columns where the run ended
  std::vector<double> nanoseconds;  // per step, one for each timing round
  // From all cells together.
  double order = kNotMeasured;              // least-squares slope of log error over log step
  double order_finest = kNotMeasured;       // the same from the two finest of the points used
  int order_points = 0, order_of = 0;       // the points used, of how many
  double solver_difference = kNotMeasured;  // of `final`, from the first solver of the same cell

  double nanoseconds_median() const;
};

/// The reference for the cells of one system.
struct StudyReference {
  std::string
      kind;  // "exact", "converged: ..." by what, "not converged: ...", or "none: ..." and why
  double bound = 0;   // of the reference's own error; 0 for an exact motion
  double extent = 0;  // how far the motion gets from its start
  std::vector<double> times;
  std::vector<std::vector<double>> coordinates, velocities;
};

struct HAMEL_API StudyResult : BatchResult {
  StudyConfig config;
  StudyCells cells;
  std::vector<StudyMetrics> metrics;       // one for each cell; not done where the cell is skipped
  std::vector<StudyReference> references;  // one for each system

  /// Is this cell run, and one of the shard?
  bool runs(size_t cell) const { return runs_in(shard, cell); }
  bool runs_in(const Shard& part, size_t cell) const;
  /// Table with a row for each cell, axes and metrics as columns.
  Table table() const;
  /// Versions, compiler, flags, host, git, counts and the study file, as JSON.
  std::string record() const;
  /// cells.csv, record.json and, where the build has HDF5, cells.h5.
  void write(const std::string& folder) const;
};

class HAMEL_API Study : public Batch<Study> {
 public:
  /// Throws ConfigError with everything that is wrong.
  Study(const Registry& registry, StudyConfig config);

  const StudyConfig& config() const { return config_; }
  const StudyCells& cells() const { return cells_; }
  /// Throws ConfigError before anything runs: a folder that cannot be written, another study's
  /// journal.
  StudyResult run() const;
  /// Joins the shards whose journals are in the folder. ConfigError where some are missing or
  /// incomplete, or are of another study or program.
  StudyResult merge() const;

 private:
  StudyResult begun(Shard part) const;

  const Registry* registry_;
  StudyConfig config_;
  StudyCells cells_;
};

}  // namespace hamel
