// An ensemble as data: its files read, its mistakes, and the lines that fix its results.
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/batch/places.hpp>
#include <hamel/framework/ensemble/ensemble_plan.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/run/names/system_file.hpp>

namespace hamel {
namespace {

using Law = Variation::Law;

const char* name_of(Law law) {
  switch (law) {
    case Law::values: return "values";
    case Law::uniform: return "uniform";
    case Law::normal: return "normal";
    case Law::log_uniform: return "log_uniform";
    case Law::haar: return "uniform so3";
    case Law::tau_normal: return "tau_normal";
    case Law::energy: return "energy";
    case Law::function: return "function";
  }
  return "";
}

void add_lines(const std::string& text, std::vector<std::string>& out) {
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
}

}  // namespace

namespace ensemble {

void read_data(EnsembleConfig& config) {
  const auto placing = [&](const char* key, const auto& read) {
    try {
      read();
    } catch (const ConfigError& error) {
      throw ConfigError({placed(config.where, key, error.what())});
    }
  };
  placing("inputs", [&] {
    for (auto& [name, signal] : config.run.inputs)
      if (const InputFile* file = std::get_if<InputFile>(&signal))
        signal = read_input_table("input " + name, name, *file);
  });
  placing("system", [&] {
    if (!config.model && names_file(config.run.system) && config.data.empty())
      config.data = read_system_file(config.run.system);
  });
}

}  // namespace ensemble

EnsembleConfig& EnsembleConfig::vary_by(std::string name, std::function<double(long)> function) {
  vary.push_back({std::move(name), Law::function, {}, std::move(function)});
  return *this;
}

EnsembleConfig& EnsembleConfig::keep_by(std::string name, std::function<double(Run&)> function) {
  keep.push_back({std::move(name), "", std::move(function)});
  return *this;
}

std::vector<std::string> EnsembleConfig::mistakes(const Registry& registry) const {
  try {
    EnsembleConfig copy = *this;
    ensemble::Plan(registry, copy);
  } catch (const ConfigError& error) {
    return error.mistakes();
  }
  return {};
}

std::vector<std::string> EnsembleConfig::fingerprint() const {
  std::vector<std::string> out;
  add_lines(run.to_toml(), out);
  out.push_back(fmt::format("members = {}", members));
  out.push_back(fmt::format("seed = {}", seed));
  out.push_back(fmt::format("grid = {}", grid));
  for (const Variation& v : vary)
    out.push_back(fmt::format("vary {} = {} [{}]", v.name, name_of(v.law), join(v.numbers)));
  for (const auto& [name, event] : events) out.push_back(fmt::format("event {} = {}", name, event));
  for (const auto& [input, formula] : feedback.inputs)
    out.push_back(fmt::format("feedback {} = {}, each {} s", input, formula, feedback.period));
  for (const Kept& kept : keep)
    out.push_back(fmt::format("keep {} = {}", kept.name,
                              kept.function ? "a function of the run" : kept.formula));
  if (!classes.names.empty())
    out.push_back(fmt::format("class {} = {}", join(classes.names), classes.formula));
  if (!statistics_at.empty())
    out.push_back(
        fmt::format("statistics at [{}] of [{}]", join(statistics_at), join(statistics_of)));
  add_lines(data, out);
  return out;
}

}  // namespace hamel
