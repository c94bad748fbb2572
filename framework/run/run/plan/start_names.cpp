#include <hamel/framework/run/run/plan/start_names.hpp>

#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>

namespace hamel {
namespace {

// The usual start, or that at the speed, with some of its numbers replaced.
SystemStart replaced(const SystemModel& system, const Config& config,
                     const std::map<std::string, double>& values) {
  SystemStart out = config.speed        ? system.start_at_speed(*config.speed, config.from)
                    : system.start_from ? system.start_from({}, config.from)
                                        : system.start;
  if (out.configuration.empty()) out.configuration = system.group.identity;
  const QuantityNames names(system);
  for (const auto& [name, value] : values) {
    const size_t place = *names.find(name), coordinates = out.configuration.size();
    if (place < coordinates) {
      out.configuration[place] = value;
      continue;
    }
    if (!out.momentum.empty())
      throw ConfigError({fmt::format(
          "start: {} starts with a momentum; give velocity instead of {}", system.name, name)});
    if (out.velocity.empty()) out.velocity.assign(static_cast<size_t>(system.group.dim), 0);
    out.velocity[place - coordinates] = value;
  }
  return out;
}

}  // namespace

std::map<std::string, double> values_by_name(const SystemModel& system,
                                             const std::vector<std::string>& texts) {
  const QuantityNames names(system);
  std::map<std::string, double> out;
  std::vector<std::string> mistakes;
  for (const std::string& text : texts) {
    const size_t equal = text.find('=');
    if (equal == std::string::npos || equal == 0) {
      mistakes.push_back(fmt::format("start: '{}' is not NAME=VALUE", text));
      continue;
    }
    const std::string name = text.substr(0, equal);
    const auto place = names.find(name);
    if (!place) {
      mistakes.push_back(
          "start: " + unknown_name("coordinate or velocity of " + system.name, name, names.all()));
      continue;
    }
    try {
      double value = 0;
      read_text("start: " + name, text.substr(equal + 1), value);
      if (!std::isfinite(value))
        mistakes.push_back(fmt::format("start: {}: {} is not finite", name, value));
      else if (!out.emplace(names.all()[*place], value).second)
        mistakes.push_back(fmt::format("start: {} is given twice", name));
    } catch (const ConfigError& error) {
      mistakes.insert(mistakes.end(), error.mistakes().begin(), error.mistakes().end());
    }
  }
  if (!mistakes.empty()) throw ConfigError(mistakes);
  return out;
}

SystemStart start_by_name(const SystemModel& system, const Config& config) {
  const Start& start = config.start;
  std::map<std::string, double> values = values_by_name(system, config.start_values);
  if (!start.configuration.empty() || !start.velocity.empty() || !start.momentum.empty())
    throw ConfigError({"start: give names, or configuration, velocity and momentum, not both"});
  if (config.speed && !system.start_at_speed)
    throw ConfigError(
        {fmt::format("speed: {} defines no straight motion; give velocity", system.name)});
  if (!system.start_with) return replaced(system, config, values);
  if (config.speed) values["speed"] = *config.speed;
  return system.start_with(values, config.from, true);
}

}  // namespace hamel
