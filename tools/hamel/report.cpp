// hamel report: the page of runs that are recorded in files; several are compared.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include <fmt/format.h>

#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/run/recorded_simulation.hpp>
#include <hamel/systems/by_name.hpp>

#include "commands.hpp"
#include "figure_file.hpp"
#include "run_figures.hpp"
#include "run_names.hpp"
#include "run_verdict.hpp"

namespace hamel::tools {
namespace {

struct ReadRun {
  std::string file, name, record;
  Result result;
};

// The file of a run that is done, with the system that it was of.
ReadRun read_run(const std::string& path) {
  const RunFile file(path);
  if (!file.finished()) {
    throw ConfigError(
        {fmt::format("'{0}.part' is unfinished: hamel run --continue {0}, and then "
                     "its page",
                     file.path())});
  }
  ReadRun out;
  out.file = file.path();
  out.record = file.record();
  const Config config = file.config();
  const Run run = recorded_simulation(file, registry()).build();
  Result& r = out.result;
  r.system = std::make_shared<const SystemModel>(run.system());
  r.config = run.config();
  r.config.inputs = config.inputs;  // by their names
  r.inputs = run.inputs();
  read_record(out.record, path, r);
  r.trajectory = read_rows(file, kRowsOfPage, r.system.get());
  return out;
}

void name_apart(std::vector<ReadRun>& runs) {
  std::vector<const Result*> results;
  std::vector<std::filesystem::path> files;
  for (const ReadRun& run : runs) {
    results.push_back(&run.result);
    files.emplace_back(run.file);
  }
  const std::vector<std::string> names = names_of(results, files);
  for (size_t i = 0; i < runs.size(); ++i) runs[i].name = names[i];
}

// The windows whose largest values are the points of each curve.
std::string windows_of(const std::vector<const ReadRun*>& runs, const std::string& column) {
  std::set<std::string> different;
  std::string each;
  for (const ReadRun* run : runs) {
    const std::string note = windows_note(run->result, {column});
    different.insert(note);
    if (!note.empty()) each += fmt::format("{}`{}`: {}", each.empty() ? "" : " ", run->name, note);
  }
  return different.size() == 1 ? *different.begin() : each;
}

// An error of all runs that have it.
void add_error(Page& page, const std::vector<ReadRun>& runs, const std::string& name,
               const std::string& title, const std::string& y, const std::string& column) {
  Axes axes{.x = "time t [s]", .y = y, .log_x = false, .log_y = true, .name = name};
  std::vector<Series> series;
  std::vector<const ReadRun*> shown;
  for (const ReadRun& run : runs) {
    if (!run.result.trajectory.has(column)) continue;
    series.push_back(curve(run.result, run.name, column));
    shown.push_back(&run);
    axes.floor = std::max(axes.floor, floor_of(run.result, column));
  }
  if (!series.empty()) page.plot(title, axes, series, windows_of(shown, column));
}

// Figures by name and unit, so that what is called otherwise in another system is never beside it.
class ByName {
 public:
  void add(const std::string& name, const std::string& unit, Series series) {
    const auto at = std::find_if(figures_.begin(), figures_.end(), [&](const Figure& figure) {
      return figure.name == name && figure.unit == unit;
    });
    Figure& figure = at == figures_.end() ? figures_.emplace_back(Figure{name, unit, {}}) : *at;
    figure.series.push_back(std::move(series));
  }
  void plot(Page& page) const {
    for (const auto& [name, unit, series] : figures_)
      page.plot(name, {.x = "time t [s]", .y = with_unit(name, unit)}, series);
  }

 private:
  struct Figure {
    std::string name, unit;
    std::vector<Series> series;
  };
  std::vector<Figure> figures_;
};

void add_motions(Page& page, const std::vector<ReadRun>& runs) {
  ByName velocities, coordinates;
  for (const ReadRun& run : runs) {
    const Result& r = run.result;
    const std::vector<Component> names = components_of(*r.system);
    for (const Component& c : names)
      velocities.add(c.name, c.unit, curve(r, run.name, c.name, false));
    const std::vector<std::string>&columns = r.system->group.columns,
          units = units_of_element(r.system->group);
    for (size_t i = 0; i < columns.size(); ++i)
      coordinates.add(columns[i], i < units.size() ? units[i] : "",
                      curve(r, run.name, columns[i], false));
  }
  velocities.plot(page);
  coordinates.plot(page);
}

std::string systems_of(const std::vector<ReadRun>& runs) {
  std::vector<std::string> names;
  for (const ReadRun& run : runs)
    if (std::find(names.begin(), names.end(), run.result.system->name) == names.end())
      names.push_back(run.result.system->name);
  return "of " + join(names);
}

Page compared(const std::vector<ReadRun>& runs) {
  Page page(fmt::format("{} runs compared", runs.size()), systems_of(runs));
  page.section("Runs");
  for (const ReadRun& run : runs) {
    const RunVerdict verdict = run_verdict(run.result);
    page.verdict(verdict.status, fmt::format("`{}`: {}", run.name, verdict.text));
  }
  std::vector<std::string> columns = {"run", "file", "system", "method", "steps", "ended"};
  std::vector<std::string> measured;
  Measurements::fields([&](const Quantity& quantity, const char* suffix, auto member) {
    const bool any = std::any_of(runs.begin(), runs.end(), [&](const ReadRun& run) {
      return std::isfinite(run.result.*member);
    });
    if (any) measured.push_back(std::string(quantity.name) + suffix);
  });
  columns.insert(columns.end(), measured.begin(), measured.end());
  columns.emplace_back("ns a step");
  std::vector<std::vector<Cell>> rows;
  for (const ReadRun& run : runs) {
    const Result& r = run.result;
    std::vector<Cell>& row = rows.emplace_back(std::vector<Cell>{
        run.name, run.file, r.system->name, r.method(),
        fmt::format("{} of {}", r.steps, r.steps_in_words()),
        r.status.ok ? fmt::format("at t = {:.6g}", r.last.time) : "failed: " + r.status.reason});
    Measurements::fields([&](const Quantity& quantity, const char* suffix, auto member) {
      const std::string name = std::string(quantity.name) + suffix;
      if (std::find(measured.begin(), measured.end(), name) != measured.end())
        row.emplace_back(r.*member);
    });
    row.emplace_back(r.seconds * 1e9 / static_cast<double>(std::max(r.steps, 1L)));
  }
  page.table("What was measured", columns, rows);
  for (const ReadRun& run : runs) {
    if (const size_t stride = run.result.trajectory.stride(); stride > 1)
      page.text({fmt::format("{}: one recorded state in {} is shown.", run.name, stride)});
  }

  page.section("Accuracy");
  add_error(page, runs, "error", "Error of the configuration against the exact motion",
            "|difference|", kExactError.name);
  add_error(page, runs, "velocity-error", "Error of the velocity against the exact motion",
            "|difference|", kExactVelocityError.name);
  add_error(page, runs, "energy-error", "Energy error, or defect of the energy balance", "relative",
            kEnergyError.name);
  add_error(page, runs, "constraint", "Constraint residual", "|A xi/h|", kConstraint.name);
  add_error(page, runs, "group-defect", "Group defect", "defect", kGroupDefect.name);

  page.section("Motion");
  add_motions(page, runs);
  for (const ReadRun& run : runs) {
    page.section("Record of " + run.name);
    page.record(run.record);
  }
  return page;
}

}  // namespace

int report(const ReportOptions& options) {
  const bool alone = !options.figure.empty();
  const std::string width = options.width.empty() ? "12cm" : options.width,
                    usual = alone ? options.figure + ".pdf" : "report.html",
                    output = options.output.empty() ? usual : options.output;
  std::vector<std::string> mistakes =
      alone ? figure_mistakes(output, width) : page_mistakes(output);
  std::vector<ReadRun> runs;
  for (const std::string& path : options.files) {
    try {
      runs.push_back(read_run(path));
    } catch (const ConfigError& error) {
      mistakes.insert(mistakes.end(), error.mistakes().begin(), error.mistakes().end());
    }
  }
  if (!mistakes.empty()) throw ConfigError(mistakes);
  if (runs.size() > 1) name_apart(runs);
  const Page page =
      runs.size() > 1 ? compared(runs) : run_page(runs.front().result, runs.front().record);
  if (alone) write_figure(page, options.figure, output, width);
  else page.write(output);
  return 0;
}

}  // namespace hamel::tools
