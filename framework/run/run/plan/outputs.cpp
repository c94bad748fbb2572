// The files of a run, checked before the first step.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/version.hpp>
#include <hamel/framework/run/record/run_file.hpp>
#include <hamel/framework/run/run/plan/plan.hpp>

namespace hamel {
namespace {

// The lines of one text that the other has not.
std::string difference(const std::string& there, const std::string& here) {
  std::string out;
  const auto list = [&](const char* where, const std::string& some, const std::string& other) {
    std::istringstream lines(some);
    for (std::string line; std::getline(lines, line);) {
      if (("\n" + other).find("\n" + line + "\n") == std::string::npos)
        out += fmt::format("{}{}: {}", out.empty() ? "" : "; ", where, line);
    }
  };
  list("there", there, here);
  list("here", here, there);
  return out;
}

constexpr double kMaxNumbers = 5e8;  // 4 GB of doubles

// Free space on the disks of these files, in numbers; infinite for a pipe, and for files that are
// compressed or hold no rows.
double numbers_that_fit(const std::vector<std::string>& files) {
  double out = std::numeric_limits<double>::infinity();
  for (const std::string& file : files) {
    if (!file.ends_with(".h5") && !file.ends_with(".csv")) continue;
    std::error_code error;
    const auto folder = std::filesystem::absolute(file, error).parent_path();
    const std::filesystem::space_info space = std::filesystem::space(folder, error);
    if (error) continue;
    auto available = static_cast<double>(space.available);
    for (const char* left : {"", ".new"}) {  // by an earlier run: this one replaces it
      const auto size = std::filesystem::file_size(part_of(file) + left, error);
      if (!error) available += static_cast<double>(size);
    }
    out = std::min(out, available / sizeof(double));
  }
  return out;
}

// Two files of one place, files of another process, an unfinished run that would be lost.
void check_files(const RunRequest& request, Mistakes& mistakes) {
  std::set<std::string> places;
  const bool events = !request.config.events.empty() || !request.config.stop_at.empty();
  for (const std::string& path : request.records) {
    std::error_code error;
    if (const std::string beside = path_of_events(path); events && !beside.empty()) {
      if (const std::string mistake = record_mistake(beside); !mistake.empty())
        mistakes.add(mistake);
      else if (!places.insert(place_of(beside)).second)
        mistakes.add(
            fmt::format("output: '{}' is given, and the events of '{}' go there", beside, path));
    }
    if (const std::string mistake = record_mistake(path); !mistake.empty()) mistakes.add(mistake);
    else if (!places.insert(place_of(path)).second)
      mistakes.add(fmt::format("output: '{}' is given twice", path));
    else if (locked(part_of(path)))
      mistakes.add(fmt::format("output: another process is writing '{}.part'", path));
    else if (path.ends_with(".h5") && place_of(path) != place_of(request.resumed) &&
             std::filesystem::exists(part_of(path), error))
      mistakes.add(
          fmt::format("output: '{0}.part' is an unfinished run; resume it (hamel run "
                      "--continue {0}), or remove it",
                      path));
  }
}

// A run is resumed as it was begun, or not at all.
void check_resumed(const RunRequest& request, const Outputs& out, Mistakes& mistakes) {
  const RunFile file(request.resumed);
  const auto refuse = [&](const std::string& why) {
    mistakes.add(fmt::format("continue: '{}': {}", request.resumed, why));
  };
  if (file.finished()) refuse("this run is finished");
  else if (file.text("build") != build_name())
    refuse(fmt::format("it was written by hamel {}, and this is {}: the bits would not be the same",
                       file.text("build"), build_name()));
  else if (file.text("config") != out.request)
    refuse("it is of a run with other options: " + difference(file.text("config"), out.request));
  else if (file.text("files") != out.files)
    refuse("the file of its system, or of an input, is not what it was");
}

}  // namespace

// Plans what is recorded, beside what an earlier part of the run has recorded.
Outputs plan_outputs(const RunRequest& request, Mistakes& mistakes) {
  Outputs out;
  try {
    check_files(request, mistakes);
    if (request.records.empty() && request.resumed.empty()) return out;
    out.request = request.config.to_toml();
    for (const auto& [event, impact] : request.impacts)
      out.request += fmt::format("# on_event: {}\n", event);
    out.files = texts_of_files(request.config);
    if (!request.resumed.empty()) check_resumed(request, out, mistakes);
  } catch (const ConfigError& error) {
    mistakes.add(error.mistakes());
  }
  return out;
}

bool keeps_rows(const RunRequest& request, Rows rows) {
  return rows == Rows::always || !request.records.empty() || request.rows_kept ||
         request.observer || request.config.output_step || !request.config.output_times.empty();
}

void check_rows(const RunRequest& request, const GroupInfo& group, Mistakes& mistakes) {
  const Config config = request.config.completed();
  const double span = std::abs(config.until - config.from);
  const double rows = config.output_step       ? span / *config.output_step
                      : config.chooses_steps() ? 0
                                               : span / std::abs(config.step_or_usual()) /
                                                     static_cast<double>(config.every);
  const auto width = static_cast<double>(group.columns.size()) + 2 * group.dim + 7;
  const bool in_memory = request.records.empty() && !request.rows_kept;
  const double disk = numbers_that_fit(request.records);
  const double times =
      config.output_step ? kMaxNumbers * width : disk;  // of the rows: they are kept
  const double most = in_memory ? kMaxNumbers : std::min(disk, times);
  const char* where = in_memory || most < disk ? "memory holds" : "there is room for on the disk";
  if (!config.output_step && !(rows < 9e15)) return;
  if (!(rows * width > most)) return;
  const bool resumed = !request.resumed.empty();  // as it was run, and no other way
  const char* what = resumed                      ? "continue"
                     : request.config.output_step ? "output_step"
                     : config.output_step         ? "until"
                                                  : "every";
  std::string mistake =
      fmt::format("{}: {:.3g} rows would be recorded, more than {}", what, rows, where);
  if (!resumed && !config.output_step && 2 * width <= most) {  // the first and the last
    mistake += fmt::format("; record every {:.0f} steps or more",
                           std::ceil(rows * static_cast<double>(config.every) * width / most));
  }
  mistakes.add(mistake);
}

}  // namespace hamel
