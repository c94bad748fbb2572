// The commands of the program; command_lines.cpp reads the command line into these.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <hamel/framework/run/names/config.hpp>

namespace hamel::tools {

struct ListOptions {
  std::string kind;  // groups, retractions, schemes, solvers, systems; empty for all
  bool json = false;
  bool markdown = false;
};
int list(const ListOptions& options);

struct DescribeOptions {
  std::string name;
  Parameters parameters;
  std::string equations;  // latex, c, numpy, sympy
  bool analyse = false;
  bool toml = false;
  bool json = false;
  bool verbose = false;
};
int describe(const DescribeOptions& options);
int analyse(const DescribeOptions& options);

struct NewOptions {
  std::string kind;  // system, group, scheme, project
  std::string name;
};
int new_project(const NewOptions& options);

struct RunOptions {
  Config config;
  std::vector<std::string> outputs;  // -o, format by extension
  std::string resumed;               // --continue of an unfinished run
  std::string report;                // --report
  bool json = false;
  bool quiet = false;
  bool verbose = false;
};
int run(const RunOptions& options);

struct ReportOptions {
  std::vector<std::string> files;
  std::string output;         // empty: report.html, or the figure's name with .pdf
  std::string figure, width;  // --figure, --width
  bool motion = false;        // --motion and what it needs
  std::optional<double> at, speed;
  std::optional<long> strobe;
  std::string size;
  bool transparent = false;
};
int report(const ReportOptions& options);

struct LiveOptions {
  std::string system;  // a name or a file
  std::string output;  // -o; empty: NAME-live.html in the folder of temporary files
  Config config;       // of its run, with the system
  std::map<std::string, std::string> given;  // options of it that are given, by their names
  std::optional<long> port;
  bool open = true;  // --no-open
};
int live(const LiveOptions& options);

struct ReproduceOptions {
  std::string directory = "reproduce-output";
  bool quiet = false;
};
int reproduce(const ReproduceOptions& options);

/// Work in parts that share a folder (batch_command.hpp).
struct PartOptions {
  std::string file, directory;  // empty: the file's name with -study or -ensemble
  int threads = 0;              // 0: all cores
  std::string shard;            // "3/16"; empty: all
  bool merge = false;
  bool fresh = false;
  bool json = false;
  bool quiet = false;
  bool verbose = false;
};

int study(const PartOptions& options);

struct EnsembleOptions : PartOptions {
  std::optional<long> member;
};
int ensemble(const EnsembleOptions& options);

/// The seconds that something takes whose end is not known, on standard error; silent when that is
/// no terminal.
class Elapsed {
 public:
  explicit Elapsed(std::string what);
  ~Elapsed();

 private:
  std::jthread ticker_;
};

/// A progress bar with the time left on standard error; silent when that is no terminal.
class Progress {
 public:
  Progress(std::string what, bool quiet);
  ~Progress();
  void operator()(double fraction);

 private:
  std::string what_;
  bool active_;
  double first_ = -1;  // the fraction that was done when the clock started
  std::chrono::steady_clock::time_point begin_, shown_;
};

}  // namespace hamel::tools
