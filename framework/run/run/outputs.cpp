// The files of a run, checked before the first step.
#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/version.hpp>
#include <hamel/framework/run/record/run_file.hpp>
#include <hamel/framework/run/run/plan.hpp>

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

}  // namespace

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

// What is recorded, and what an earlier part of the run has recorded.
void Simulation::add_outputs(Plan& plan) const {
  std::set<std::string> places;
  for (const std::string& path : records_) {
    std::error_code error;
    if (const std::string mistake = record_mistake(path); !mistake.empty()) plan.add({mistake});
    else if (!places.insert(place_of(path)).second)
      plan.add({fmt::format("output: '{}' is given twice", path)});
    else if (locked(part_of(path)))
      plan.add({fmt::format("output: another process is writing '{}.part'", path)});
    else if (path.ends_with(".h5") && place_of(path) != place_of(resumed_) &&
             std::filesystem::exists(part_of(path), error))
      plan.add(
          {fmt::format("output: '{0}.part' is an unfinished run; go on with it (hamel run "
                       "--continue {0}), or remove it",
                       path)});
  }
  if (records_.empty() && resumed_.empty()) return;
  plan.request = config_.to_toml();
  for (const auto& [event, impact] : impacts_)
    plan.request += fmt::format("# on_event: {}\n", event);
  plan.files = texts_of_files(config_);
  if (resumed_.empty()) return;
  const RunFile file(resumed_);
  const auto refuse = [&](const std::string& why) {
    plan.add({fmt::format("continue: '{}': {}", resumed_, why)});
  };
  if (file.finished()) refuse("this run is finished");
  else if (file.text("build") != build_name())
    refuse(fmt::format("it was written by hamel {}, and this is {}: the bits would not be the same",
                       file.text("build"), build_name()));
  else if (file.text("config") != plan.request)
    refuse("it is of a run with other options: " + difference(file.text("config"), plan.request));
  else if (file.text("files") != plan.files)
    refuse("the file of its system, or of an input, is not what it was");
}

}  // namespace hamel
