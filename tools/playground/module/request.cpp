#include "request.hpp"

#include <toml++/toml.h>

#include <hamel/systems/by_text.hpp>

namespace hamel::playground {
namespace {

// True of the configuration of a run; a text that is no TOML is reported as a system.
bool is_configuration(const std::string& text) {
  try {
    return toml::parse(text).contains("system");
  } catch (const toml::parse_error&) {
    return false;
  }
}

Simulation of_text(const std::string& text, const std::string& origin) {
  if (!is_configuration(text)) return simulate_text(text, origin);
  Config config = Config::from_toml(text, origin);
  Simulation out = simulate(config.system);
  out.config(std::move(config));
  return out;
}

std::vector<double> numbers_of(const Json& value) {
  if (value.is_array()) return value.get<std::vector<double>>();
  return {value.get<double>()};
}

// An option of a run or its start, in the place of what the text has of the start.
void set(Config& config, const std::string& name, const std::string& text) {
  bool starts = false;
  Config::start_fields([&](const Option& field, auto member) {
    if (name != field.name) return;
    starts = true;
    if (name != "configuration") config.start.velocity = config.start.momentum = {};
    read_text(name, text, config.start.*member);
    config.speed.reset();
  });
  if (starts) return;
  if (name == "speed") config.start = {};
  config.set(name, text);
}

}  // namespace

Simulation simulation_of(const Json& request) {
  Simulation out = of_text(request.at("text"), request.value("origin", "system.toml"));
  Config config = out.config();
  const Json none = Json::object();
  const Json options = request.value("options", none);
  for (const auto& [name, value] : options.items()) set(config, name, value.get<std::string>());
  const Json parameters = request.value("parameters", none);
  for (const auto& [name, value] : parameters.items()) config.parameters[name] = numbers_of(value);
  const Json inputs = request.value("inputs", none);
  for (const auto& [name, value] : inputs.items()) config.inputs[name] = value.get<double>();
  out.config(std::move(config));
  return out;
}

const char* answered(const Json& answer) {
  static std::string text;
  text = answer.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.c_str();
}

}  // namespace hamel::playground
