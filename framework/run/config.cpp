#include <hamel/framework/run/config.hpp>

#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <hamel/framework/io/text_file.hpp>
#include <hamel/framework/io/toml_reader.hpp>

namespace hamel {
namespace {

// A TOML basic string.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

// A TOML key: bare where it may be.
std::string key_of(const std::string& name) {
  const bool bare =
      !name.empty() &&
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
          std::string::npos;
  return bare ? name : quoted(name);
}

// A value as TOML has it; floats need a point or an exponent.
template <class Value>
std::string toml_of(const Value& value) {
  std::string out = text_of(value);
  if constexpr (std::is_same_v<Value, std::string>) return quoted(out);
  if constexpr (std::is_same_v<Value, double>)
    return out.find_first_of(".en") == std::string::npos ? out + ".0" : out;
  if constexpr (std::is_class_v<Value> && !std::is_same_v<Value, std::string>) {
    std::vector<std::string> entries;
    for (const auto& entry : value) entries.push_back(toml_of(entry));
    return "[" + join(entries) + "]";
  }
  return out;
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

// False where the text is not all of one number.
bool number(const std::string& text, double& out) {
  size_t used = 0;
  try {
    out = std::stod(text, &used);
  } catch (const std::exception&) {
    return false;
  }
  return used == text.size();
}

}  // namespace

std::string text_of(double value) { return fmt::format("{}", value); }
std::string text_of(long value) { return fmt::format("{}", value); }
std::string text_of(bool value) { return value ? "true" : "false"; }
std::string text_of(const std::string& value) { return value; }
std::string text_of(const std::vector<double>& value) { return join(value); }
std::string text_of(const std::vector<std::string>& value) {
  return fmt::format("{}", fmt::join(value, ","));
}

void read_text(const std::string& option, const std::string& text, double& out) {
  if (!number(text, out))
    throw ConfigError({fmt::format("{}: '{}' is not a number", option, text)});
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
void read_text(const std::string&, const std::string& text, std::vector<std::string>& out) {
  out = split(text);
}
void read_text(const std::string& option, const std::string& text, std::vector<double>& out) {
  if (text.empty() || text.back() == ',') {
    throw ConfigError(
        {fmt::format("{}: got '{}', expected numbers separated by commas", option, text)});
  }
  out.clear();
  for (const std::string& word : split(text)) {
    if (!number(word, out.emplace_back()))
      throw ConfigError({fmt::format("{}: '{}' in '{}' is not a number", option, word, text)});
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

Config Config::from_toml(const std::string& text, const std::string& origin) {
  TomlReader read(origin);
  const toml::table table = read.parse(text);
  Config config;
  for (const auto& [name, node] : table) {
    const std::string key(name.str());
    std::vector<std::string> known = {"system", "set"};
    bool found = key == "system" || key == "set";
    if (key == "system") read.value(node, key, config.system);
    if (key == "set") read.lists(node, key, config.parameters);
    const auto take = [&, &entry = node](const Option& option, auto& value) {
      known.emplace_back(option.name);
      if (option.name != key) return;
      found = true;
      read.value(entry, key, value);
    };
    start_fields([&](const Option& option, auto member) { take(option, config.start.*member); });
    fields([&](const Option& option, auto member) { take(option, config.*member); });
    if (!found) read.unknown_key(node, key, known);
  }
  if (!read.mistakes.empty()) throw ConfigError(read.mistakes);
  return config;
}

std::string Config::to_toml() const {
  std::string out = fmt::format("system = {}\n", quoted(system));
  start_fields([&](const Option& option, auto member) {
    if (!(start.*member).empty())
      out += fmt::format("{} = {}\n", option.name, toml_of(start.*member));
  });
  fields([&](const Option& option, auto member) {
    out += fmt::format("{} = {}\n", option.name, toml_of(this->*member));
  });
  if (!parameters.empty()) out += "[set]\n";
  for (const auto& [name, values] : parameters)
    out += fmt::format("{} = {}\n", key_of(name), toml_of(values));
  return out;
}

long Config::steps() const {
  return static_cast<long>(std::floor(until / step * (1 + 1e-12) + 1e-9));
}

std::vector<std::string> Config::mistakes() const {
  std::vector<std::string> out;
  const auto refuse = [&](const char* name, double value, const char* expected) {
    out.push_back(fmt::format("{}: got {}, expected {}", name, value, expected));
  };
  const auto look_at = [&](const Option& option, double value) {
    if (option.allows != nullptr && !option.allows(value))
      refuse(option.name, value, option.expected);
  };
  fields([&](const Option& option, auto member) {
    using Value = std::remove_cvref_t<decltype(this->*member)>;
    if constexpr (std::is_arithmetic_v<Value>) look_at(option, static_cast<double>(this->*member));
    if constexpr (std::is_same_v<Value, std::vector<double>>)
      for (const double x : this->*member) look_at(option, x);
  });
  if (std::isfinite(until) && std::isfinite(step) && step != 0) {
    if (until / step < 0) refuse("until", until, "the sign of step");
    else if (until / step > 9e15) refuse("until", until, "fewer than 9e15 steps");
    else if (until != 0 && steps() == 0)
      refuse("step", step, fmt::format("at most until, {}: no whole step fits", until).c_str());
  }
  return out;
}

Config read_config(const std::string& path) {
  return Config::from_toml(read_text_file("config", path), path);
}

}  // namespace hamel
