// What a study leaves: the table of its cells and the record.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include <fmt/format.h>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <hamel/framework/run/result.hpp>
#include <hamel/framework/study/study.hpp>
#include <hamel/framework/io/version.hpp>

namespace hamel {
namespace {

using Json = nlohmann::ordered_json;

std::string status_of(const StudyCell& cell, const StudyMetrics& m) {
  if (!cell.runs()) return cell.skipped;
  if (!m.done) return "pending";
  return m.ok ? "ok" : "failed";
}

// One column of words or of numbers, from each cell with its metrics.
class Columns {
 public:
  explicit Columns(const StudyResult& result) : result_(result) {}

  using Word = std::function<std::string(const StudyCell&, const StudyMetrics&)>;
  void words(const char* name, const char* meaning, const Word& word) {
    std::vector<std::string> out;
    for (size_t i = 0; i < result_.cells.size(); ++i)
      out.push_back(word(result_.cells[i], result_.metrics[i]));
    table.columns.push_back({name, "", meaning, std::move(out)});
  }
  using Number = std::function<double(const StudyCell&, const StudyMetrics&)>;
  void setting(const char* name, const char* unit, const char* meaning, const Number& number) {
    std::vector<double> out;
    for (size_t i = 0; i < result_.cells.size(); ++i)
      out.push_back(number(result_.cells[i], result_.metrics[i]));
    table.columns.push_back({name, unit, meaning, std::move(out)});
  }
  // A number that only a cell that was run has.
  void measured(const char* name, const char* unit, const char* meaning, const Number& number) {
    setting(name, unit, meaning, [&](const StudyCell& cell, const StudyMetrics& m) {
      return cell.runs() && m.done ? number(cell, m) : kNotMeasured;
    });
  }
  Table table;

 private:
  const StudyResult& result_;
};

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

}  // namespace

double StudyMetrics::nanoseconds_median() const {
  std::vector<double> sorted;
  for (const double ns : nanoseconds)
    if (ns >= 0) sorted.push_back(ns);  // not NaN, and taken
  if (sorted.empty()) return kNotMeasured;
  std::sort(sorted.begin(), sorted.end());
  const size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
}

Table StudyResult::table() const {
  using Cell = const StudyCell&;
  using Metrics = const StudyMetrics&;
  Columns c(*this);
  for (const char* axis : {"system", "scheme", "retraction"})
    c.words(axis, "axis", [axis](Cell cell, Metrics) { return cell.axes.at(axis); });
  c.setting("s", "1", "axis; empty where the scheme does not use it", [](Cell cell, Metrics) {
    return cell.axes.at("s").empty() ? kNotMeasured : cell.config.s;
  });
  for (const char* axis : {"solver", "compose", "on_failure"})
    c.words(axis, "axis", [axis](Cell cell, Metrics) { return cell.axes.at(axis); });
  c.setting("tolerance", "1", "axis; empty where nothing is solved", [](Cell cell, Metrics) {
    return cell.axes.at("tolerance").empty() ? kNotMeasured : cell.config.tolerance;
  });
  c.setting("step", "s", "axis", [](Cell cell, Metrics) { return cell.config.step; });
  c.words("status", "ok, failed, excluded, impossible or duplicate", status_of);
  c.words("reason", "of a failure, or why it was not run",
          [](Cell cell, Metrics m) { return cell.runs() ? m.reason : cell.why; });
  c.measured("steps", "1", "good steps",
             [](Cell, Metrics m) { return static_cast<double>(m.steps); });
  c.measured("time", "s", "reached", [](Cell, Metrics m) { return m.time; });
  c.measured("error", "columns of g", "largest distance from the reference at the common times",
             [](Cell, Metrics m) { return m.error; });
  c.measured("error_final", "columns of g", "the same at the end",
             [](Cell, Metrics m) { return m.error_final; });
  c.measured("velocity_error", "columns of xi", "largest distance of the body velocity",
             [](Cell, Metrics m) { return m.velocity_error; });
  c.measured("reference_bound", "columns of g and xi", "of the reference's own error; 0: exact",
             [&](Cell cell, Metrics) { return references[cell.system].bound; });
  c.measured("floor", "columns of g", "errors below are round-off, residuals and the reference",
             [](Cell, Metrics m) { return m.floor; });
  c.measured("order", "1", "slope of log error over log step, least squares",
             [](Cell, Metrics m) { return m.order; });
  c.measured("order_finest", "1", "the same from the two finest steps used",
             [](Cell, Metrics m) { return m.order_finest; });
  c.measured("order_points", "1", "steps used for it: above the floor, below 0.1 of the motion",
             [](Cell, Metrics m) { return m.order_points; });
  c.measured("order_of", "1", "steps there are", [](Cell, Metrics m) { return m.order_of; });
  c.measured("claimed_order", "1", "with this s, retraction and composition; 0: none",
             [](Cell cell, Metrics) { return cell.claimed_order; });
  c.measured("energy_error", "1", "largest |E - E0| / |E0|",
             [](Cell, Metrics m) { return m.energy_error; });
  c.measured("energy_slope", "1/s", "of (E - E0) / |E0| over time, least squares",
             [](Cell, Metrics m) { return m.energy_slope; });
  c.measured("constraint", "columns of xi", "largest |A xi/h|, from the configurations",
             [](Cell, Metrics m) { return m.constraint; });
  c.measured("group_defect", "1", "largest distance from the group",
             [](Cell, Metrics m) { return m.group_defect; });
  const auto per_step = [](long total, long steps) {
    return steps > 0 ? static_cast<double>(total) / static_cast<double>(steps) : kNotMeasured;
  };
  c.measured("iterations_mean", "1", "per step",
             [&](Cell, Metrics m) { return per_step(m.iterations, m.steps); });
  c.measured("iterations_max", "1", "in one step",
             [](Cell, Metrics m) { return static_cast<double>(m.iterations_max); });
  c.measured("evaluations_mean", "1", "of the equation, per step",
             [&](Cell, Metrics m) { return per_step(m.evaluations, m.steps); });
  c.measured("evaluations", "1", "of the equation, whole run",
             [](Cell, Metrics m) { return static_cast<double>(m.evaluations); });
  c.measured("fallbacks", "1", "steps that failed and were rescued by on_failure",
             [](Cell, Metrics m) { return static_cast<double>(m.fallbacks); });
  c.measured("residual", "1", "largest |F| / scale", [](Cell, Metrics m) { return m.residual; });
  c.measured("failure_residual", "1", "|F| / scale of the step that failed",
             [](Cell, Metrics m) { return m.failure_residual; });
  c.measured("solver_difference", "columns of g",
             "at the end, from the first solver in the same cell that did not fail",
             [](Cell, Metrics m) { return m.solver_difference; });
  c.measured("ns_per_step", "ns", "processor time, median of the timing rounds, nothing recorded",
             [](Cell, Metrics m) { return m.nanoseconds_median(); });
  c.measured("seconds", "s", "steps times ns_per_step", [](Cell, Metrics m) {
    return 1e-9 * m.nanoseconds_median() * static_cast<double>(m.steps);
  });
  return c.table;
}

std::string StudyResult::record() const {
  std::map<std::string, int> counts;
  for (size_t i = 0; i < cells.size(); ++i) ++counts[status_of(cells[i], metrics[i])];
  Json reference_list = Json::array();
  for (size_t i = 0; i < references.size(); ++i) {
    reference_list.push_back({{"system", config.systems[i].label},
                              {"reference", references[i].kind},
                              {"bound", number(references[i].bound)},
                              {"times", references[i].times.size()}});
  }
  Json data = Json::object();
  for (const StudySystem& system : config.systems)
    if (!system.data.empty()) data[system.name] = system.data;
  return Json{
      {"title", config.title},
      {"status", complete ? "ok" : "failed"},
      {"cells", counts},
      {"resumed", resumed},
      {"references", reference_list},
      {"until", config.until},
      {"repeats", config.repeats},
      {"threads", threads},
      {"seconds", seconds},
      {"version", version()},
      {"git", git_hash()},
      {"host", host_name()},
      {"compiler", compiler()},
      {"flags", build_flags()},
      {"libraries",
       {{"eigen",
         fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
        {"fmt",
         fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
        {"hdf5", hdf5_version()}}},
      {"study", config.text.empty() ? config.fingerprint() : config.text},
      {"data", data},
  }
      .dump(2);
}

void StudyResult::write(const std::string& folder) const {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::create_directories(folder, error);
  const auto path = [&](const char* name) { return (fs::path(folder) / name).string(); };
  const Table cells_table = table();
  write_file(path("cells.csv"), cells_table.csv());
  if (!hdf5_version().empty())
    cells_table.write_hdf5(path("cells.h5"), {{"title", config.title}, {"record", record()}});
  write_file(path("record.json"), record() + "\n");
}

}  // namespace hamel
