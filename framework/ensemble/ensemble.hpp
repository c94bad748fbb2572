// Many runs of one system: its parameters, starts and inputs varied by lists, ranges, grids and
// random draws; of each member what is asked for is kept, and nothing else.
//
//   auto config = hamel::read_ensemble("reversals.toml", hamel::registry());
//   auto result = hamel::Ensemble(hamel::registry(), config).threads(2).folder("out").run();
//   result.write("out");   // ensemble.h5, ensemble.csv, ensemble.json
//
// A member is its index: what it is varied by, and what is kept of it, depends on the file, the
// seed and that index alone, and neither on threads nor on shards. The file, the names, the
// statistics: framework/ensemble/README.md.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/batch/batch.hpp>
#include <hamel/framework/io/export.hpp>
#include <hamel/framework/io/table.hpp>
#include <hamel/framework/run/names/config.hpp>

namespace hamel {

class Registry;
class Run;
class Simulation;
struct SystemModel;

/// Values of one name over the members: a parameter ("skew", "inertia3"), an input, "speed",
/// "start.omega" (a velocity or a coordinate), "start.configuration", "start.velocity".
struct Variation {
  enum class Law {
    values,       // a list
    uniform,      // least, most
    normal,       // mean, deviation
    log_uniform,  // least, most, both above 0
    haar,         // start.configuration: its rotation uniform on SO(3)
    tau_normal,   // start.configuration: g tau(xi), xi normal, one deviation or n of them
    energy,       // start.velocity: uniform on the surface of that energy, in the metric of inertia
    function      // of the member's index, in the program
  };
  std::string name;
  Law law = Law::values;
  std::vector<double> numbers = {};
  std::function<double(long member)> function = {};
};

/// Kept number of each member: a formula of end.X, start.X, max.X, min.X, at(T).X,
/// event.NAME.count, event.NAME.time, the parameters and what is varied. Without a name the formula
/// is its name. A function in place of the formula receives the member's run at its end.
struct Kept {
  std::string name, formula;
  std::function<double(Run&)> function = {};
};

/// Members by a formula whose value is the index of a name.
struct Classes {
  std::string formula;
  std::vector<std::string> names;
};

/// The counts of a kept quantity in equal bins of [from, until]; both 0: from its least to its
/// most.
struct HistogramRequest {
  int bins = 0;
  double from = 0, until = 0;
};

/// Inputs by formulas of the state (X), held from one multiple of the period to the next.
struct Feedback {
  double period = 0;                               // s
  std::map<std::string, std::string> inputs = {};  // name -> formula
};

/// An ensemble as plain data.
struct HAMEL_API EnsembleConfig {
  Config run;        // what all members have in common
  long members = 0;  // 0: as many as the lists have values
  uint64_t seed = 0;
  bool grid = false;  // all combinations of the lists, the last one fastest
  std::vector<Variation> vary;
  std::map<std::string, std::string> events = {};  // by name, "x > 1"
  Feedback feedback = {};
  std::vector<Kept> keep;
  Classes classes = {};
  std::vector<double> statistics_at = {};       // times
  std::vector<std::string> statistics_of = {};  // quantities X; empty: coordinates and velocities
  std::map<std::string, HistogramRequest> histograms = {};
  std::vector<double> quantiles = {};
  bool covariance = false;
  std::vector<long> trajectories = {};  // members whose runs the program writes and shows, too
  std::string data = {};                // the text of the system's file, read once
  /// A system of the program in place of a registered one or a file: maker(mechanism), with
  /// run.system as its name. No journal can have it: no folder.
  std::function<SystemModel(const Parameters&)> model = {};
  std::string origin = {}, text = {};  // the ensemble's file, for the record

  /// "file:line:column" by key, "vary.skew"; empty for an ensemble made in a program.
  std::map<std::string, std::string> where = {};

  /// Adds a variation by a function of the member's index. Functions are called from several
  /// threads and more than once for a member: they depend on nothing else. A journal and a record
  /// have their names alone.
  EnsembleConfig& vary_by(std::string name, std::function<double(long member)> function);
  /// Adds a quantity that is kept: a function of the member's run at its end. A member of which it
  /// throws, or is not finite, fails. Members then run one by one, which a note of the result
  /// states where lanes would have been used.
  EnsembleConfig& keep_by(std::string name, std::function<double(Run&)> function);
  /// Everything that is wrong, each mistake with its place.
  std::vector<std::string> mistakes(const Registry& registry) const;
  /// Items that fix the results, one line each: a journal belongs to these lines.
  std::vector<std::string> fingerprint() const;
};

/// Throws ConfigError with all mistakes of the file, each with line and column.
/// data: the text of the system's file; empty: it is read. model: EnsembleConfig::model.
HAMEL_API EnsembleConfig parse_ensemble(const std::string& text, const std::string& origin,
                                        const Registry& registry, const std::string& data = "",
                                        std::function<SystemModel(const Parameters&)> model = {});
HAMEL_API EnsembleConfig read_ensemble(const std::string& path, const Registry& registry);

/// A member that has no kept values, and why.
struct MemberFailure {
  long member = 0;
  double time = 0;  // reached
  std::string reason;
};

/// Moments over the members where it has a value; the deviation is that of a sample, n - 1.
struct HAMEL_API Moments {
  long count = 0;
  double mean = 0, squares = 0;  // sum of (x - mean)^2
  double least = 0, most = 0;

  double deviation() const;
  /// Moments of the two together (Chan, Golub, LeVeque).
  static Moments of_both(const Moments& a, const Moments& b);
};

struct Histogram {
  double from = 0, until = 0;
  std::vector<long> counts = {};
  long below = 0, above = 0;
};

/// Covariance of kept quantities in pairs; a pair with fewer than two members has NaN.
struct Covariance {
  std::vector<std::vector<double>> matrix = {};
  std::vector<std::vector<long>> members = {};  // that have both values, over which it is
};

/// Over the members at a time.
struct StatisticsAt {
  double time = 0;
  std::vector<std::pair<std::string, Moments>> quantities;
};

struct HAMEL_API EnsembleResult : BatchResult {
  EnsembleConfig config;
  long first = 0, members = 0;  // those of the shard
  long done = 0;                // finished members
  /// A row for each member: what is varied, what is kept (NaN: failed, or no such event), the
  /// class, and `failure`, 0 or the number of its reason.
  Table table;
  std::vector<MemberFailure> failures;  // by member
  std::vector<std::string> kept;        // the columns that are kept
  std::map<std::string, Moments> moments;
  std::map<std::string, std::vector<double>> quantiles;
  std::map<std::string, Histogram> histograms;
  std::vector<long> class_counts;
  Covariance covariance;  // of the kept columns
  std::vector<StatisticsAt> statistics;

  /// The record as JSON: the same text for any number of threads and shards but for the last three
  /// members.
  std::string record() const;
  /// ensemble.h5 (where the build has HDF5), ensemble.csv and ensemble.json.
  void write(const std::string& folder) const;
};

/// Member by itself.
struct Member {
  long index = 0;
  Config config;  // of the same run, but for feedback
  std::vector<std::pair<std::string, double>> varied, kept;
  bool failed = false;
  MemberFailure failure;
};

class HAMEL_API Ensemble : public Batch<Ensemble> {
 public:
  /// Throws ConfigError with everything that is wrong.
  Ensemble(const Registry& registry, EnsembleConfig config);

  const EnsembleConfig& config() const { return config_; }
  /// The number of members.
  long members() const { return config_.members; }
  /// Several members at once where lanes are compiled for the system (systems/lanes.hpp): the same
  /// bytes in less time, and the default.
  Ensemble& lanes(bool use);
  /// Throws ConfigError before anything runs: a folder that cannot be written, another ensemble's
  /// journal.
  EnsembleResult run() const;
  /// Joins the shards whose journals are in the folder. ConfigError where some are missing or
  /// incomplete, or are of another ensemble or program.
  EnsembleResult merge() const;
  /// A single member: the same values as in the whole.
  Member member(long index) const;
  /// Its run, but for feedback.
  Simulation simulation(const Member& member) const;

 private:
  void check_folder() const;

  const Registry* registry_;
  EnsembleConfig config_;
  bool lanes_ = true;
};

}  // namespace hamel
