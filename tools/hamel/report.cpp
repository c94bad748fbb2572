// hamel report: the page of runs that are recorded in files; several are compared.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include <hamel/framework/mechanics/motion_words.hpp>
#include <hamel/framework/run/run_file.hpp>
#include <hamel/systems/simulate.hpp>

#include "commands.hpp"
#include "run_page.hpp"
#include "run_verdict.hpp"

namespace hamel::tools {
namespace {

struct ReadRun {
  std::string name, record;
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
  out.name = std::filesystem::path(file.path()).stem();
  out.record = file.record();
  const Config config = file.config();
  const Integration run = Simulation(registry(), config.system).config(config).build();
  Result& r = out.result;
  r.system = run.system();
  r.config = run.config();
  r.inputs = run.inputs();
  read_record(out.record, r);
  r.trajectory = read_rows(file, kRowsOfPage);
  return out;
}

// One figure of a column over all runs that have it.
void add_figure(Page& page, const std::vector<ReadRun>& runs, const std::string& title,
                const std::string& y, const std::string& column, bool error) {
  std::vector<Series> series;
  std::string windows;
  for (const ReadRun& run : runs) {
    if (!run.result.trajectory.has(column)) continue;
    series.push_back(curve(run.result, run.name, column, error));
    if (error && windows.empty()) windows = windows_note(run.result);
  }
  Axes axes{.x = "time t [s]", .y = y, .log_x = false, .log_y = error};
  if (error) axes.floor = round_off(runs.front().result);
  if (!series.empty()) page.plot(title, axes, series, windows);
}

Page compared(const std::vector<ReadRun>& runs) {
  Page page(fmt::format("{} runs compared", runs.size()),
            fmt::format("of {}", runs.front().result.system.name));
  page.section("Runs");
  for (const ReadRun& run : runs) {
    const RunVerdict verdict = run_verdict(run.result);
    page.verdict(verdict.status, fmt::format("`{}`: {}", run.name, verdict.text));
  }
  std::vector<std::string> columns = {"run", "system", "method", "steps", "ended"};
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
        run.name, r.system.name, r.method(), fmt::format("{} of {}", r.steps, r.steps_in_words()),
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
      page.text({fmt::format("{}: every {}th recorded row is shown.", run.name, stride)});
  }

  page.section("Accuracy");
  add_figure(page, runs, "Error of the configuration against the exact motion", "|difference|",
             kExactError.name, true);
  add_figure(page, runs, "Error of the velocity against the exact motion", "|difference|",
             kExactVelocityError.name, true);
  add_figure(page, runs, "Energy error, or defect of the energy balance", "relative",
             kEnergyError.name, true);
  add_figure(page, runs, "Constraint residual", "|A xi/h|", kConstraint.name, true);
  add_figure(page, runs, "Group defect", "defect", kGroupDefect.name, true);

  page.section("Motion");
  const Result& first = runs.front().result;
  const std::vector<Component> names = components_of(first.system);
  for (size_t i = 0; i < names.size(); ++i)
    add_figure(page, runs, names[i].name, "[" + names[i].unit + "]", fmt::format("xi{}", i + 1),
               false);
  for (const std::string& column : first.system.group.columns)
    add_figure(page, runs, column, column, column, false);
  for (const ReadRun& run : runs) {
    page.section("Record of " + run.name);
    page.record(run.record);
  }
  return page;
}

}  // namespace

int report(const ReportOptions& options) {
  std::vector<std::string> mistakes = page_mistakes(options.output);
  std::vector<ReadRun> runs;
  for (const std::string& path : options.files) {
    try {
      runs.push_back(read_run(path));
    } catch (const ConfigError& error) {
      mistakes.insert(mistakes.end(), error.mistakes().begin(), error.mistakes().end());
    }
  }
  if (!mistakes.empty()) throw ConfigError(mistakes);
  if (runs.size() == 1) run_page(runs.front().result, runs.front().record).write(options.output);
  else compared(runs).write(options.output);
  return 0;
}

}  // namespace hamel::tools
