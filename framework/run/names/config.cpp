#include <hamel/framework/run/names/config.hpp>

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <hamel/framework/io/text_file.hpp>
#include <hamel/framework/io/toml_reader.hpp>
#include <hamel/framework/io/visible.hpp>
#include <hamel/framework/run/names/config_file.hpp>
#include <hamel/framework/run/names/toml_config.hpp>
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

// f(member pointer) for the option of that name.
template <class F>
void with_option(const std::string& name, F&& f) {
  std::vector<std::string> known;
  bool found = false;
  Config::fields([&](const Option& option, auto member) {
    known.emplace_back(option.name);
    if (option.name != name) return;
    found = true;
    f(member);
  });
  if (!found) throw ConfigError({unknown_name("option", name, known)});
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, ',');) out.push_back(word);
  return out;
}

// "", or what a text is instead of a number.
const char* no_number(const std::string& text, double& out) {
  size_t used = 0;
  try {
    out = std::stod(text, &used);
  } catch (const std::out_of_range&) {
    return "is too large or too small for a number (2.3e-308 to 1.7e308)";
  } catch (const std::exception&) {
    return "is not a number";
  }
  return used == text.size() ? "" : "is not a number";
}

}  // namespace

std::string text_of(double value) { return fmt::format("{}", value); }
std::string text_of(std::optional<double> value) { return value ? text_of(*value) : ""; }
std::string text_of(long value) { return fmt::format("{}", value); }
std::string text_of(bool value) { return value ? "true" : "false"; }
std::string text_of(const std::string& value) { return value; }
std::string text_of(const std::vector<double>& value) { return join(value); }
std::string text_of(const std::vector<std::string>& value) {
  return fmt::format("{}", fmt::join(value, ","));
}

void read_text(const std::string& option, const std::string& text, double& out) {
  if (const std::string_view why = no_number(text, out); !why.empty())
    throw ConfigError({fmt::format("{}: '{}' {}", option, text, why)});
}
void read_text(const std::string& option, const std::string& text, std::optional<double>& out) {
  out.reset();
  if (!text.empty()) read_text(option, text, out.emplace());
}
void read_text(const std::string& option, const std::string& text, long& out) {
  size_t used = 0;
  try {
    out = std::stol(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != text.size())
    throw ConfigError({fmt::format("{}: '{}' is not a whole number", option, text)});
}
void read_text(const std::string& option, const std::string& text, bool& out) {
  if (text != "true" && text != "false")
    throw ConfigError({fmt::format("{}: got '{}', expected true or false", option, text)});
  out = text == "true";
}
void read_text(const std::string&, const std::string& text, std::string& out) { out = text; }
// Names and formulas: a comma within brackets separates arguments.
void read_text(const std::string&, const std::string& text, std::vector<std::string>& out) {
  out.clear();
  int open = 0;
  for (const std::string& word : split(text)) {
    if (open > 0) out.back() += "," + word;
    else out.push_back(word);
    open += static_cast<int>(std::count(word.begin(), word.end(), '(') -
                             std::count(word.begin(), word.end(), ')'));
  }
}
void read_text(const std::string& option, const std::string& text, std::vector<double>& out) {
  if (text.empty() || text.back() == ',') {
    throw ConfigError(
        {fmt::format("{}: got '{}', expected numbers separated by commas", option, text)});
  }
  out.clear();
  for (const std::string& word : split(text)) {
    if (const std::string_view why = no_number(word, out.emplace_back()); !why.empty())
      throw ConfigError({fmt::format("{}: '{}' in '{}' {}", option, word, text, why)});
  }
}

std::string Config::text(const std::string& option) const {
  std::string out;
  with_option(option, [&](auto member) { out = text_of(this->*member); });
  return out;
}

void Config::set(const std::string& option, const std::string& text) {
  with_option(option, [&](auto member) { read_text(option, text, this->*member); });
}

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

long Config::steps() const {
  return static_cast<long>(std::floor((until - from) / step_or_usual() * (1 + 1e-12) + 1e-9));
}

bool Config::leaves_method() const {
  return scheme.empty() && !step && !chooses_steps() && compose == "none";
}

Config Config::completed() const {
  Config out = *this;
  if (leaves_method()) {
    out.rtol = kUsualRtol;
    if (every == 1 && !output_step && output_times.empty()) out.output_step = kUsualStep;
  }
  if (scheme.empty()) out.scheme = out.chooses_steps() ? "dop853" : "lift";
  if (!out.chooses_steps()) out.step = step_or_usual();
  return out;
}

std::vector<double> Config::recorded_times() const {
  if (!output_times.empty() || !output_step) return output_times;
  const double count = std::floor(std::abs(until - from) / *output_step * (1 + 1e-12) + 1e-9);
  std::vector<double> out;
  for (double i = 0; i <= count; ++i)
    out.push_back(from + std::copysign(i * *output_step, until - from));
  return out;
}

namespace {

std::string refusal(const char* name, double value, const std::string& expected) {
  return fmt::format("{}: got {}, expected {}", name, value, expected);
}

// Values that their own option does not allow.
void look_at_each(const Config& config, std::vector<std::string>& out) {
  const auto look_at = [&](const Option& option, double value) {
    if (option.allows != nullptr && !option.allows(value))
      out.push_back(refusal(option.name, value, option.expected));
  };
  config.fields([&](const Option& option, auto member) {
    using Value = std::remove_cvref_t<decltype(config.*member)>;
    if constexpr (std::is_arithmetic_v<Value>) look_at(option, static_cast<double>(config.*member));
    if constexpr (std::is_same_v<Value, std::optional<double>>)
      if (config.*member) look_at(option, *(config.*member));
    if constexpr (std::is_same_v<Value, std::vector<double>>)
      for (const double x : config.*member) look_at(option, x);
  });
}

void look_at_output_times(const Config& config, std::vector<std::string>& out) {
  const auto& times = config.output_times;
  if (config.output_step && !times.empty())
    out.push_back("output_times: give them or output_step, not both");
  if ((config.output_step || !times.empty()) && config.every != 1)
    out.push_back("every: the rows are at the output times: leave it out");
  const double sign = config.until - config.from < 0 ? -1 : 1;
  for (size_t i = 0; i < times.size(); ++i) {
    const double t = times[i];
    if (sign * (t - config.from) < 0 || sign * (config.until - t) < 0)
      out.push_back(refusal("output_times", t,
                            fmt::format("times from {} to {}", config.from, config.until)));
    else if (i > 0 && sign * (t - times[i - 1]) <= 0)
      out.push_back(refusal("output_times", t,
                            fmt::format("a time beyond the one before, {}", times[i - 1])));
  }
}

void look_at_span(const Config& config, std::vector<std::string>& out) {
  const double from = config.from, until = config.until, span = until - from;
  const double step = config.step_or_usual();
  if (!std::isfinite(span) || !std::isfinite(step) || step == 0) return;
  if (span / step < 0 && from == 0) {
    out.push_back(refusal("until", until, "the sign of step"));
  } else if (span / step < 0) {
    out.push_back(
        refusal("until", until, fmt::format("a time beyond from, {}, as step has it", from)));
  } else if (config.chooses_steps()) {
    return;
  } else if (span / step > 9e15) {
    out.push_back(refusal("until", until, "fewer than 9e15 steps"));
  } else if (span != 0 && config.steps() == 0) {
    out.push_back(
        refusal("step", step, fmt::format("at most until, {}: no whole step fits", span)));
  }
}

// Records and configurations, which hold the names of files, are UTF-8.
void look_at_names_of_files(const Config& config, std::vector<std::string>& out) {
  const auto look_at = [&](const std::string& field, const std::string& path) {
    if (!is_utf8(path)) out.push_back(fmt::format("{}: the name '{}' is no UTF-8", field, path));
  };
  look_at("system", config.system);
  for (const auto& [name, signal] : config.inputs)
    if (const auto* file = std::get_if<InputFile>(&signal)) look_at("input " + name, file->path);
}

}  // namespace

std::vector<std::string> Config::mistakes() const {
  std::vector<std::string> out;
  look_at_names_of_files(*this, out);
  look_at_each(*this, out);
  look_at_output_times(*this, out);
  look_at_span(*this, out);
  return out;
}

Config read_config(const std::string& path) {
  return Config::from_toml(read_text_file("config", path), path);
}
Config read_config_file(const std::string& path, CommandOptions& options) {
  return config_of(read_text_file("config", path), path, &options);
}

}  // namespace hamel
