// hamel run: one trajectory, its files, its page.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include <hamel/systems/simulate.hpp>

#include "commands.hpp"
#include "run_page.hpp"

namespace hamel::tools {
namespace {

// What is wrong with the output files, found before anything runs.
std::vector<std::string> output_mistakes(const RunOptions& options) {
  std::vector<std::string> mistakes;
  const auto check = [&](const std::string& path, const std::vector<std::string>& formats) {
    const std::string extension = std::filesystem::path(path).extension();
    if (std::find(formats.begin(), formats.end(), extension) == formats.end()) {
      mistakes.push_back(unknown_name("output format", extension, formats) + " in '" + path + "'");
    } else if (const std::string reason = unwritable(path); !reason.empty()) {
      mistakes.push_back(reason);
    }
  };
  for (const std::string& path : options.outputs) check(path, output_formats());
  if (!options.report.empty()) {
    check(options.report, {".html"});
    if (report_page().empty()) {
      mistakes.push_back(
          "--report: this program was built without the page (node and npm were "
          "missing at build time); run tools/setup and build again");
    }
  }
  return mistakes;
}

}  // namespace

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)), active_(!quiet && isatty(STDERR_FILENO) == 1) {}
Progress::~Progress() {
  if (active_) fmt::print(stderr, "\r{:70}\r", "");
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
  fmt::print(stderr, "\r{:<70}",
             fmt::format("{} [{:=<{}}{:{}}] {:3.0f}%{}", what_, "", filled, "", 30 - filled,
                         100 * fraction, left));
  std::fflush(stderr);
}

int run(const RunOptions& options) {
  Simulation simulation(registry(), options.config.system);
  simulation.config(options.config);
  std::vector<std::string> mistakes = simulation.mistakes();
  const auto more = output_mistakes(options);
  mistakes.insert(mistakes.end(), more.begin(), more.end());
  if (!mistakes.empty()) throw ConfigError(mistakes);

  Result result;
  {
    Progress progress(options.config.system, options.quiet);
    result = simulation.progress([&](double fraction) { progress(fraction); }).run();
  }
  for (const std::string& path : options.outputs) result.write(path);
  if (!options.report.empty()) run_page(result).write(options.report);
  if (options.json) fmt::print("{}\n", result.record());
  else if (!options.quiet) fmt::print("{}", result.report());
  if (!result.status.ok) {
    fmt::print(stderr, "hamel: failed in step {} at t = {:.6g}: {} (residual {:.2e})\n",
               result.status.step, result.status.time, result.status.reason,
               result.status.residual);
  }
  return result.status.ok ? 0 : 1;
}

}  // namespace hamel::tools
