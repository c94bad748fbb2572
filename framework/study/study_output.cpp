// Output of a study: the table of its cells and the record.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include <fmt/format.h>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <hamel/framework/io/csv_file.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/version.hpp>
#include <hamel/framework/run/record/result.hpp>
#include <hamel/framework/study/parts.hpp>

namespace hamel {
namespace {

using Json = nlohmann::ordered_json;

std::string status_of(const StudyCell& cell, const StudyMetrics& m) {
  if (!cell.runs()) return cell.skipped;
  if (!m.done) return "pending";
  return m.ok ? "ok" : "failed";
}

// Column of texts or of numbers, from each cell with its metrics.
class Columns {
 public:
  explicit Columns(const StudyResult& result) : result_(result) {}

  using Word = std::function<std::string(const StudyCell&, const StudyMetrics&)>;
  void words(const std::string& name, const std::string& meaning, const Word& word) {
    std::vector<std::string> out;
    out.reserve(result_.cells.size());
    for (size_t i = 0; i < result_.cells.size(); ++i)
      out.push_back(word(result_.cells[i], result_.metrics[i]));
    table.columns.push_back({name, "", meaning, std::move(out)});
  }
  // A number of each cell; NaN where it has none.
  using Number = std::function<double(size_t cell)>;
  void numbers(const std::string& name, const std::string& unit, const std::string& meaning,
               const Number& number) {
    std::vector<double> out;
    out.reserve(result_.cells.size());
    for (size_t i = 0; i < result_.cells.size(); ++i) out.push_back(number(i));
    table.columns.push_back({name, unit, meaning, std::move(out)});
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
  c.words("system", "axis", [](Cell cell, Metrics) { return cell.axes.at("system"); });
  Config::fields([&]<class Value>(const Option& option, Value Config::*) {
    if (!option.axis) return;
    const std::string name = option.name,
                      meaning = fmt::format("axis, {}; empty where it is not used", option.meaning);
    if (std::is_arithmetic_v<Value> || name == "step") {  // a tolerance may be "fixed"
      c.numbers(name, option.unit, meaning, [this, name](size_t i) {
        double value = kNotMeasured;
        if (!cells[i].axes.at(name).empty()) read_text(name, cells[i].axes.at(name), value);
        return value;
      });
    } else {
      c.words(name, meaning, [name](Cell cell, Metrics) { return cell.axes.at(name); });
    }
  });
  c.words("status", "ok, failed, excluded, impossible or duplicate", status_of);
  c.words("reason", "of a failure, or why it was not run",
          [](Cell cell, Metrics m) { return cell.runs() ? m.reason : cell.why; });
  study::measured_columns([&](const Quantity& quantity, auto of) {
    c.numbers(quantity.name, quantity.unit, quantity.meaning, [this, of](size_t i) {
      const StudyMetrics& m = metrics[i];
      if (!cells[i].runs() || !m.done) return kNotMeasured;
      if constexpr (std::is_member_object_pointer_v<decltype(of)>)
        return static_cast<double>(m.*of);
      else return static_cast<double>(of(cells[i], m, references[cells[i].system]));
    });
  });
  return std::move(c.table);
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
      {"notes", notes},
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
  write_csv(cells_table, path("cells.csv"));
  if (!hdf5_version().empty())
    cells_table.write_hdf5(path("cells.h5"), {{"title", config.title}, {"record", record()}});
  write_file(path("record.json"), record() + "\n");
}

}  // namespace hamel
