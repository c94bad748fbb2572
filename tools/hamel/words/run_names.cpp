#include "words/run_names.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include <hamel/framework/figures/study_view.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel::tools {
namespace {

constexpr size_t kLongest = 40;  // characters of one difference in a name

// Choices for a run, in the order in which a name has them, as text; empty where the scheme makes
// no use of it.
using Choices = std::vector<std::pair<std::string, std::string>>;

Choices choices_of(const Result& r) {
  Choices out = {{"system", r.system->name}};
  Config::fields([&](const Option& option, auto member) {
    if (!option.axis && std::string_view(option.name) != "speed") return;
    const bool used = std::find(r.unused.begin(), r.unused.end(), option.name) == r.unused.end();
    out.emplace_back(option.name,
                     figures::axis_words(option.name, used ? text_of(r.config.*member) : ""));
  });
  for (const auto& [name, value] : r.config.parameters)
    out.emplace_back("set " + name, fmt::format("{} = {}", name, join(value)));
  for (const auto& [name, signal] : r.config.inputs)
    out.emplace_back("input " + name, fmt::format("{} = {}", name, text_of(signal)));
  return out;
}

// The values of one choice, of each run.
std::vector<std::string> values_of(const std::vector<Choices>& runs, const std::string& name) {
  std::vector<std::string> out;
  for (const Choices& run : runs) {
    const auto at = std::find_if(run.begin(), run.end(),
                                 [&](const auto& choice) { return choice.first == name; });
    out.push_back(at == run.end() ? "" : at->second);
  }
  return out;
}

// Two runs that make use of it differ in it, and no name gets long by it.
bool tells_apart(const std::vector<std::string>& values) {
  std::set<std::string> different(values.begin(), values.end());
  different.erase("");
  return different.size() > 1 && std::none_of(values.begin(), values.end(), [](const auto& value) {
           return value.size() > kLongest;
         });
}

// The file's name with so many of its folders: "A/run".
std::string called(const std::filesystem::path& file, int folders) {
  std::filesystem::path out = file.stem(), rest = file.parent_path();
  for (; folders > 0 && rest.has_relative_path(); --folders, rest = rest.parent_path())
    out = rest.filename() / out;
  return out.string();
}

std::vector<std::string> names_of_files(std::vector<std::filesystem::path> files) {
  constexpr int most = 50;
  for (auto& file : files) file = std::filesystem::weakly_canonical(file);
  std::map<std::string, int> seen;
  std::vector<std::string> out;
  for (const auto& own : files) {
    int folders = 0;
    const auto alone = [&] {
      return std::count_if(files.begin(), files.end(), [&](const auto& file) {
               return called(file, folders) == called(own, folders);
             }) == 1;
    };
    while (folders < most && !alone()) ++folders;
    out.push_back(called(own, folders == most ? 0 : folders));
    if (const int times = ++seen[out.back()]; times > 1) out.back() += fmt::format(" ({})", times);
  }
  return out;
}

}  // namespace

std::vector<std::string> names_of(const std::vector<const Result*>& runs,
                                  std::vector<std::filesystem::path> files) {
  std::vector<Choices> choices;
  std::vector<std::string> order;  // of the choices of all runs
  for (const Result* run : runs) {
    choices.push_back(choices_of(*run));
    for (const auto& [name, words] : choices.back())
      if (std::find(order.begin(), order.end(), name) == order.end()) order.push_back(name);
  }
  std::vector<std::string> out(runs.size());
  for (const std::string& name : order) {
    const std::vector<std::string> values = values_of(choices, name);
    if (!tells_apart(values)) continue;
    for (size_t i = 0; i < out.size(); ++i)
      if (!values[i].empty()) out[i] += (out[i].empty() ? "" : ", ") + values[i];
  }
  const std::vector<std::string> by_file = names_of_files(std::move(files)), by_choice = out;
  for (size_t i = 0; i < out.size(); ++i) {
    if (std::count(by_choice.begin(), by_choice.end(), by_choice[i]) == 1) continue;
    out[i] = by_choice[i].empty() ? by_file[i] : fmt::format("{} ({})", by_choice[i], by_file[i]);
  }
  return out;
}

}  // namespace hamel::tools
