#include <hamel/framework/run/names/toml_config.hpp>

#include <fmt/format.h>

#include <hamel/framework/io/text_file.hpp>
#include <hamel/framework/run/names/config_file.hpp>
#include <hamel/framework/run/names/toml_inputs.hpp>

namespace hamel {
namespace {

// A TOML key: bare where it may be.
std::string key_of(const std::string& name) {
  const bool bare =
      !name.empty() &&
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
          std::string::npos;
  return bare ? name : toml_string(name);
}

// A value as TOML has it; floats need a point or an exponent.
template <class Value>
std::string toml_of(const Value& value) {
  std::string out = text_of(value);
  if constexpr (std::is_same_v<Value, std::string>) return toml_string(out);
  if constexpr (std::is_same_v<Value, double> || std::is_same_v<Value, std::optional<double>>)
    return out.find_first_of(".en") == std::string::npos ? out + ".0" : out;
  else if constexpr (std::is_class_v<Value> && !std::is_same_v<Value, std::string>) {
    std::vector<std::string> entries;
    for (const auto& entry : value) entries.push_back(toml_of(entry));
    return "[" + join(entries) + "]";
  }
  return out;
}

template <class Value>
constexpr bool is_text(const Value&) {
  return std::is_same_v<Value, std::string>;
}

// An input: a number, the name of a file, or {t = [...], value = [...], hold = true}.
std::string toml_of_signal(const InputSignal& signal) {
  if (const double* value = std::get_if<double>(&signal)) return toml_of(*value);
  const InputTable* table = std::get_if<InputTable>(&signal);
  if (table == nullptr) return toml_string(text_of(signal));
  return fmt::format("{{t = {}, value = {}, hold = {}}}", toml_of(table->times),
                     toml_of(table->values), table->hold);
}

}  // namespace

std::vector<std::string> config_keys() {
  std::vector<std::string> out = {"system", "set", "inputs"};
  const auto add = [&](const Option& option, auto) { out.emplace_back(option.name); };
  Config::start_fields(add);
  Config::fields(add);
  return out;
}

bool read_config_key(TomlReader& read, const std::string& key, const toml::node& node,
                     Config& config) {
  bool found = key == "system" || key == "set" || key == "inputs";
  if (key == "system") read.value(node, key, config.system);
  if (key == "set") read.lists(node, key, config.parameters);
  if (key == "inputs") read_inputs(read, node, config.inputs);
  const auto take = [&](const Option& option, auto& value) {
    if (option.name != key) return;
    found = true;
    read.value(node, key, value);
  };
  Config::start_fields(
      [&](const Option& option, auto member) { take(option, config.start.*member); });
  Config::fields([&](const Option& option, auto member) { take(option, config.*member); });
  return found;
}

namespace {

// options: may be null.
Config config_of(const std::string& text, const std::string& origin, CommandOptions* options) {
  TomlReader read(origin);
  const toml::table table = read.parse(text);
  if (const toml::node* node = table.get("system"); node != nullptr && node->is_array())
    throw ConfigError({fmt::format("{0}: this file is a study (hamel study {0})", origin)});
  if (is_ensemble(table))
    throw ConfigError({fmt::format("{0}: this file is an ensemble (hamel ensemble {0})", origin)});
  if (table.contains("group") && table.contains("inertia"))
    throw ConfigError({fmt::format("{0}: this file is a system by data (hamel run {0})", origin)});
  std::vector<std::string> known = config_keys();
  if (options != nullptr)
    for (const auto& [name, option] : *options) known.push_back(name);
  Config config;
  for (const auto& [name, node] : table) {
    const std::string key(name.str());
    if (options != nullptr && options->contains(key)) {
      CommandOption& option = (*options)[key];
      option.place = read.place(node);
      if (node.is_boolean()) option.values = {text_of(*node.value<bool>())};
      else if (node.is_number()) option.values = {text_of(*node.value<double>())};
      else read.value(node, key, option.values);
    } else if (!read_config_key(read, key, node, config)) {
      read.unknown_key(node, key, known);
    }
  }
  if (!read.mistakes.empty()) throw ConfigError(read.mistakes);
  return config;
}

}  // namespace

Config Config::from_toml(const std::string& text, const std::string& origin) {
  return config_of(text, origin, nullptr);
}

std::string Config::to_toml() const {
  std::string out = fmt::format("system = {}\n", toml_string(system));
  start_fields([&](const Option& option, auto member) {
    if (!(start.*member).empty())
      out += fmt::format("{} = {}\n", option.name, toml_of(start.*member));
  });
  fields([&](const Option& option, auto member) {
    const auto& value = this->*member;
    if (text_of(value).empty() && (!is_text(value) || text_of(Config().*member).empty())) return;
    out += fmt::format("{} = {}\n", option.name, toml_of(this->*member));
  });
  if (!parameters.empty()) out += "[set]\n";
  for (const auto& [name, values] : parameters)
    out += fmt::format("{} = {}\n", key_of(name), toml_of(values));
  if (!inputs.empty()) out += "[inputs]\n";
  for (const auto& [name, signal] : inputs)
    out += fmt::format("{} = {}\n", key_of(name), toml_of_signal(signal));
  return out;
}

Config read_config(const std::string& path) {
  return Config::from_toml(read_text_file("config", path), path);
}
Config read_config_file(const std::string& path, CommandOptions& options) {
  return config_of(read_text_file("config", path), path, &options);
}

}  // namespace hamel
