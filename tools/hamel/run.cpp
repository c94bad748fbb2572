// hamel run: one trajectory, its files, its page.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include <hamel/systems/by_name.hpp>

#include "commands.hpp"
#include "interrupt.hpp"
#include "run_page.hpp"
#include "screen.hpp"

namespace hamel::tools {
namespace {

// Where the rows of an unfinished run are.
std::string kept(const RunOptions& options) {
  std::string out;
  for (const std::string& path : options.outputs) {
    std::error_code error;
    if (path == "-" || !std::filesystem::exists(part_of(path), error)) continue;
    out += fmt::format("; the rows so far are in '{}'", part_of(path));
    if (path.ends_with(".h5")) out += fmt::format(", and --continue {} goes on", path);
  }
  return out;
}

}  // namespace

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)), active_(!quiet && isatty(STDERR_FILENO) == 1) {}
Progress::~Progress() {
  if (active_) write_message(fmt::format("\r{:70}\r", ""));
}
void Progress::operator()(double fraction) {
  if (!active_) return;
  const auto now = std::chrono::steady_clock::now();
  if (first_ < 0) {
    first_ = fraction;
    begin_ = now;
  } else if (now - shown_ < std::chrono::milliseconds(100)) {
    return;
  }
  shown_ = now;
  const double seconds = std::chrono::duration<double>(now - begin_).count();
  std::string left;
  if (fraction > first_ && seconds > 0.3) {
    const long rest = std::lround(seconds * (1 - fraction) / (fraction - first_));
    left = rest < 60 ? fmt::format(", {} s left", rest)
                     : fmt::format(", {} min {:02} s left", rest / 60, rest % 60);
  }
  const int filled = static_cast<int>(30 * fraction);
  const std::string bar = fmt::format("{} [{:=<{}}{:{}}] {:3.0f}%{}", visible(what_), "", filled,
                                      "", 30 - filled, 100 * fraction, left);
  write_message(fmt::format("\r{:<70}", bar));
}

int run(const RunOptions& options) {
  Simulation simulation(registry(), options.config.system);
  simulation.config(options.config).resume(options.resumed);
  for (const std::string& path : options.outputs) simulation.record_to(path);
  simulation.keep_rows(options.report.empty() ? 1 : kRowsOfPage);
  std::vector<std::string> mistakes = simulation.mistakes();
  if (!options.report.empty()) {
    const auto more = page_mistakes(options.report);
    mistakes.insert(mistakes.end(), more.begin(), more.end());
  }
  const bool rows_to_screen =
      std::find(options.outputs.begin(), options.outputs.end(), "-") != options.outputs.end();
  if (rows_to_screen && options.json)
    mistakes.emplace_back("output: rows and --json would both go to standard output");
  if (!mistakes.empty()) throw ConfigError(mistakes);

  const std::atomic<bool>& stop = stop_when_asked();
  Result result;
  {
    Progress progress(options.config.system, options.quiet);
    simulation.progress([&](double fraction) {
      progress(fraction);
      if (stop) throw Unfinished("interrupted");
    });
    try {
      result = simulation.run();
    } catch (const Unfinished& reason) {
      throw Unfinished(reason.what() + kept(options));
    }
  }
  if (!options.report.empty()) run_page(result, result.record()).write(options.report);
  if (options.json) say("{}\n", result.record());
  else if (!options.quiet && !rows_to_screen) say("{}", result.report());
  if (!result.status.ok) {
    complain("hamel: failed in step {} at t = {:.6g}: {} (residual {:.2e})\n", result.status.step,
             result.status.time, result.status.reason, result.status.residual);
  }
  return result.status.ok ? 0 : 1;
}

}  // namespace hamel::tools
