// hamel report: the page of runs that are recorded in files; several are compared.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include <hamel/framework/figures/figures.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/pages/run_page.hpp>
#include <hamel/framework/pages/run_verdict.hpp>
#include <hamel/framework/run/run/recorded_result.hpp>
#include <hamel/systems/by_name.hpp>

#include "commands.hpp"
#include "pages/figure_file.hpp"
#include "pages/motion_file.hpp"
#include "words/run_names.hpp"

namespace hamel::tools {

using pages::Cell;
using pages::Figure;
using pages::kRowsOfPage;
using pages::Page;
using pages::page_mistakes;
using pages::run_page;
using pages::run_verdict;
using pages::RunVerdict;
namespace {

struct ReadRun {
  std::string file, name, record, lack;
  Result result;
};

// The file of a run that is done.
ReadRun read_run(const std::string& path) {
  const RunFile file(path);
  if (!file.finished()) {
    throw ConfigError(
        {fmt::format("'{0}.part' is unfinished: hamel run --continue {0}, and then "
                     "its page",
                     file.path())});
  }
  RecordedResult recorded = recorded_result(file, registry(), kRowsOfPage);
  return {file.path(), "", file.record(), std::move(recorded.lack), std::move(recorded.result)};
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
  const auto add_verdicts = [&](bool failed) {
    for (const ReadRun& run : runs) {
      const RunVerdict verdict = run_verdict(run.result);
      if ((verdict.status == "failed") == failed)
        page.verdict(verdict.status, fmt::format("`{}`: {}", run.name, verdict.text));
    }
  };
  add_verdicts(true);
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
    if (!run.lack.empty()) page.text({fmt::format("{}: {}.", run.name, run.lack)});
    if (const size_t stride = run.result.trajectory.stride(); stride > 1)
      page.text({fmt::format("{}: one recorded state in {} is shown.", run.name, stride)});
  }

  std::vector<figures::NamedRun> named;
  for (const ReadRun& run : runs) named.push_back({run.name, &run.result});
  const std::vector<Figure> figures = figures::of_runs(named);
  page.add_section(figures, "Accuracy");
  page.add_section(figures, "Motion");
  // Behind the figures, which a phone would else show below them.
  if (std::ranges::any_of(
          runs, [](const ReadRun& run) { return run_verdict(run.result).status != "failed"; })) {
    page.section("Notes");
    add_verdicts(false);
  }
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
                    usual = options.motion ? "motion.html"
                            : alone        ? options.figure + ".pdf"
                                           : "report.html",
                    output = options.output.empty() ? usual : options.output;
  std::vector<std::string> mistakes = options.motion ? motion_mistakes(options, output)
                                      : alone        ? figure_mistakes(output, width)
                                                     : page_mistakes(output);
  std::vector<ReadRun> runs;
  for (const std::string& path : options.files) {
    try {
      runs.push_back(read_run(path));
    } catch (const ConfigError& error) {
      mistakes.insert(mistakes.end(), error.mistakes().begin(), error.mistakes().end());
    }
  }
  if (!mistakes.empty()) throw ConfigError(mistakes);
  if (options.motion) {
    write_motion(runs.front().result, options, output);
    return 0;
  }
  if (runs.size() > 1) name_apart(runs);
  else if (!runs.front().lack.empty()) runs.front().result.notes.push_back(runs.front().lack);
  const Page page = runs.size() > 1
                        ? compared(runs)
                        : run_page(registry(), runs.front().result, runs.front().record);
  if (alone) write_figure(page, options.figure, output, width);
  else page.write(output);
  return 0;
}

}  // namespace hamel::tools
