// hamel run: one trajectory, its files, its page.
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include <hamel/framework/io/note_lines.hpp>
#include <hamel/framework/pages/run_page.hpp>
#include <hamel/systems/by_name.hpp>

#include "commands.hpp"
#include "words/interrupt.hpp"
#include "words/screen.hpp"

namespace hamel::tools {

using pages::page_mistakes;
namespace {

// The files with the rows of an unfinished run.
std::string kept(const RunOptions& options) {
  std::string out;
  for (const std::string& path : options.outputs) {
    std::error_code error;
    if (path == "-" || !std::filesystem::exists(part_of(path), error)) continue;
    out += fmt::format("; the rows so far are in '{}'", part_of(path));
    if (path.ends_with(".h5")) out += fmt::format(", and --continue {} resumes it", path);
  }
  return out;
}

}  // namespace

int run(const RunOptions& options) {
  Simulation simulation(registry(), options.config.system);
  simulation.config(options.config).resume(options.resumed);
  for (const std::string& path : options.outputs) simulation.record_to(path);
  simulation.keep_rows(options.report.empty() ? 1 : pages::kRowsOfPage);
  std::vector<std::string> mistakes;
  if (!options.report.empty()) mistakes = page_mistakes(options.report);
  const bool rows_to_screen =
      std::find(options.outputs.begin(), options.outputs.end(), "-") != options.outputs.end();
  if (rows_to_screen && options.json)
    mistakes.emplace_back("output: rows and --json would both go to standard output");
  if (!mistakes.empty()) {
    std::vector<std::string> all = simulation.mistakes();
    all.insert(all.end(), mistakes.begin(), mistakes.end());
    throw ConfigError(all);
  }

  const std::atomic<bool>& stop = stop_when_asked();
  Result result;
  {
    Progress progress(options.config.system, options.quiet);
    simulation.progress([&](double fraction) {
      progress(fraction);
      const Config& config = options.config;
      if (stop)
        throw Unfinished(fmt::format("interrupted at t = {:.6g}",
                                     config.from + fraction * (config.until - config.from)));
    });
    try {
      result = simulation.run_unread();
    } catch (const Unfinished& reason) {
      throw Unfinished(reason.what() + kept(options));
    }
  }
  if (!options.report.empty() || options.json || !options.quiet) result.read();
  if (!options.report.empty())
    pages::run_page(registry(), result, result.record()).write(options.report);
  if (options.json) say("{}\n", result.record());
  else if (!options.quiet && !rows_to_screen) say("{}", result.report(Notes{options.verbose}));
  if (!result.status.ok) {
    complain("hamel: failed in step {} at t = {:.6g}: {} (residual {:.2e})\n", result.status.step,
             result.status.time, result.status.reason, result.status.residual);
  }
  return result.status.ok ? 0 : 1;
}

}  // namespace hamel::tools
