#include <hamel/framework/run/config.hpp>

#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include <hamel/framework/io/toml_reader.hpp>

namespace hamel {
namespace {

const std::vector<std::string>& keys() {
  static const std::vector<std::string> all = {
      "system",     "set",     "configuration", "velocity", "momentum",
      "scheme",     "s",       "retraction",    "solver",   "tolerance",
      "on_failure", "compose", "step",          "until",    "every"};
  return all;
}

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

}  // namespace

Config Config::from_toml(const std::string& text, const std::string& origin) {
  TomlReader read(origin);
  const toml::table table = read.parse(text);
  Config config;
  for (const auto& [name, node] : table) {
    const std::string key(name.str());
    if (key == "system") read.text(node, key, config.system);
    else if (key == "scheme") read.text(node, key, config.scheme);
    else if (key == "retraction") read.text(node, key, config.retraction);
    else if (key == "solver") read.text(node, key, config.solver);
    else if (key == "on_failure") read.text(node, key, config.on_failure);
    else if (key == "compose") read.text(node, key, config.compose);
    else if (key == "s") read.number(node, key, config.s);
    else if (key == "tolerance") read.number(node, key, config.tolerance);
    else if (key == "step") read.number(node, key, config.step);
    else if (key == "until") read.number(node, key, config.until);
    else if (key == "every") read.whole(node, key, config.every);
    else if (key == "configuration") read.list(node, key, config.start.configuration);
    else if (key == "velocity") read.list(node, key, config.start.velocity);
    else if (key == "momentum") read.list(node, key, config.start.momentum);
    else if (key == "set") {
      if (const toml::table* set = node.as_table()) {
        for (const auto& [parameter, value] : *set) {
          const std::string field(parameter.str());
          read.list(value, "set." + field, config.parameters[field]);
        }
      } else {
        read.wrong(node, key, "a table of parameters");
      }
    } else {
      read.unknown_key(node, key, keys());
    }
  }
  if (!read.mistakes.empty()) throw ConfigError(read.mistakes);
  return config;
}

std::string Config::to_toml() const {
  std::string out;
  const auto text = [&](const char* key, const std::string& v) {
    out += fmt::format("{} = {}\n", key, quoted(v));
  };
  const auto number = [](double v) {  // TOML floats need a point or an exponent
    std::string digits = fmt::format("{}", v);
    return digits.find_first_of(".en") == std::string::npos ? digits + ".0" : digits;
  };
  const auto list = [&](const std::string& key, const std::vector<double>& values) {
    std::vector<std::string> words;
    for (double v : values) words.push_back(number(v));
    out += fmt::format("{} = [{}]\n", key, join(words));
  };
  text("system", system);
  if (!start.configuration.empty()) list("configuration", start.configuration);
  if (!start.velocity.empty()) list("velocity", start.velocity);
  if (!start.momentum.empty()) list("momentum", start.momentum);
  text("scheme", scheme);
  out += fmt::format("s = {}\n", number(s));
  text("retraction", retraction);
  text("solver", solver);
  out += fmt::format("tolerance = {}\n", number(tolerance));
  text("on_failure", on_failure);
  text("compose", compose);
  out += fmt::format("step = {}\nuntil = {}\nevery = {}\n", number(step), number(until), every);
  if (!parameters.empty()) out += "[set]\n";
  for (const auto& [name, values] : parameters) list(key_of(name), values);
  return out;
}

long Config::steps() const {
  return static_cast<long>(std::floor(until / step * (1 + 1e-12) + 1e-9));
}

std::vector<std::string> Config::mistakes() const {
  std::vector<std::string> out;
  const auto refuse = [&](const char* key, double value, const char* expected) {
    out.push_back(fmt::format("{}: got {}, expected {}", key, value, expected));
  };
  if (!(s >= 0 && s <= 1)) refuse("s", s, "a number in [0, 1]");
  if (!(tolerance > 0 && tolerance < 1)) refuse("tolerance", tolerance, "a number in (0, 1)");
  if (!std::isfinite(step) || step == 0) refuse("step", step, "a finite number other than 0");
  if (!std::isfinite(until)) refuse("until", until, "a finite number");
  else if (std::isfinite(step) && step != 0) {
    if (until / step < 0) refuse("until", until, "the sign of step");
    else if (until / step > 9e15) refuse("until", until, "fewer than 9e15 steps");
  }
  if (every < 1) refuse("every", static_cast<double>(every), "at least 1");
  return out;
}

Config read_config(const std::string& path) {
  std::ifstream in(path);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf()))
    throw ConfigError({fmt::format("config: cannot read '{}'", path)});
  return Config::from_toml(text.str(), path);
}

}  // namespace hamel
