// Study files: TOML with the names of `hamel run` as lists.
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include <hamel/framework/study/parts.hpp>
#include <hamel/framework/io/toml_reader.hpp>

namespace hamel {
namespace {

class StudyReader {
 public:
  StudyReader(const std::string& origin) : read_(origin) {}

  StudyConfig file(const std::string& text) {
    const toml::table table = read_.parse(text);
    config_.text = text;
    for (const auto& [name, node] : table) {
      const std::string key(name.str());
      at(key, node);
      if (key == "title") read_.text(node, key, config_.title);
      else if (key == "mode") mode(node);
      else if (key == "until") read_.number(node, key, config_.until);
      else if (key == "repeats") read_.whole(node, key, config_.repeats);
      else if (key == "system") systems(node);
      else if (key == "exclude") exclusions(node);
      else if (!axis(key, node)) read_.unknown_key(node, key, keys());
    }
    return std::move(config_);
  }
  std::vector<std::string>& mistakes() { return read_.mistakes; }

 private:
  static const std::vector<std::string>& keys() {
    static const std::vector<std::string> all = {
        "title",      "mode", "until",  "repeats", "system",     "exclude",   "scheme",
        "retraction", "s",    "solver", "compose", "on_failure", "tolerance", "step"};
    return all;
  }

  void at(const std::string& key, const toml::node& node) {
    config_.where[key] = read_.place(node);
  }

  void mode(const toml::node& node) {
    std::string word;
    read_.text(node, "mode", word);
    config_.zipped = word == "zipped";
    if (word != "zipped" && word != "factorial" && !word.empty())
      read_.unknown(node, "mode", word, {"factorial", "zipped"});
  }

  bool axis(const std::string& key, const toml::node& node) {
    if (key == "scheme") each(node, key, config_.schemes, "a string");
    else if (key == "retraction") each(node, key, config_.retractions, "a string");
    else if (key == "s") each(node, key, config_.s, "a number");
    else if (key == "solver") each(node, key, config_.solvers, "a string");
    else if (key == "compose") each(node, key, config_.compositions, "a string");
    else if (key == "on_failure") each(node, key, config_.on_failures, "a string");
    else if (key == "tolerance") each(node, key, config_.tolerances, "a number");
    else if (key == "step") each(node, key, config_.steps, "a number");
    else return false;
    return true;
  }

  // One value or a list of them, each with its place.
  template <class Value>
  void each(const toml::node& node, const std::string& key, std::vector<Value>& out,
            const char* expected) {
    out.clear();
    const auto take = [&](const toml::node& entry) {
      if (auto value = entry.value<Value>()) {
        at(fmt::format("{}[{}]", key, out.size()), entry);
        out.push_back(*value);
      } else {
        read_.wrong(entry, key, expected);
      }
    };
    const toml::array* array = node.as_array();
    if (array == nullptr) return take(node);
    if (array->empty()) read_.wrong(node, key, "at least one value");
    for (const toml::node& entry : *array) take(entry);
  }

  void systems(const toml::node& node) {
    const toml::array* array = node.as_array();
    if (array == nullptr || !array->is_array_of_tables())
      return read_.wrong(node, "system", "tables, each headed [[system]]");
    for (const toml::node& entry : *array) {
      const std::string prefix = fmt::format("system[{}]", config_.systems.size());
      at(prefix, entry);
      config_.systems.push_back(system(*entry.as_table(), prefix));
    }
  }

  StudySystem system(const toml::table& table, const std::string& prefix) {
    StudySystem out;
    for (const auto& [name, node] : table) {
      const std::string key(name.str());
      at(prefix + "." + key, node);
      if (key == "name") read_.text(node, key, out.name);
      else if (key == "label") read_.text(node, key, out.label);
      else if (key == "configuration") read_.list(node, key, out.start.configuration);
      else if (key == "velocity") read_.list(node, key, out.start.velocity);
      else if (key == "momentum") read_.list(node, key, out.start.momentum);
      else if (key != "set") {
        read_.unknown_key(node, key,
                          {"name", "label", "set", "configuration", "velocity", "momentum"});
      } else if (const toml::table* set = node.as_table()) {
        for (const auto& [parameter, value] : *set) {
          const std::string field(parameter.str());
          at(prefix + ".set." + field, value);
          read_.list(value, "set." + field, out.parameters[field]);
        }
      } else {
        read_.wrong(node, key, "a table of parameters");
      }
    }
    if (out.label.empty()) out.label = out.name;
    return out;
  }

  void exclusions(const toml::node& node) {
    const toml::array* array = node.as_array();
    if (array == nullptr || !array->is_array_of_tables())
      return read_.wrong(node, "exclude", "tables, each headed [[exclude]]");
    for (const toml::node& entry : *array) {
      const std::string prefix = fmt::format("exclude[{}]", config_.exclude.size());
      at(prefix, entry);
      StudyExclusion out;
      for (const auto& [name, value] : *entry.as_table()) {
        const std::string key(name.str());
        at(prefix + "." + key, value);
        if (key == "why") read_.text(value, key, out.why);
        else matched(value, key, out);
      }
      config_.exclude.push_back(std::move(out));
    }
  }

  // One value or a list, as the words that the axis has for them.
  void matched(const toml::node& node, const std::string& key, StudyExclusion& out) {
    std::vector<std::string> known = study_axes();
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      known.push_back("why");
      return read_.unknown_key(node, key, known);
    }
    const auto take = [&](const toml::node& entry) {
      if (auto word = entry.value<std::string>(); word && entry.is_string())
        out.values[key].push_back(*word);
      else if (auto number = entry.value<double>(); number && entry.is_number())
        out.values[key].push_back(fmt::format("{}", *number));
      else read_.wrong(entry, "exclude." + key, "a value of that axis, or a list of them");
    };
    if (const toml::array* array = node.as_array())
      for (const toml::node& entry : *array) take(entry);
    else take(node);
  }

  TomlReader read_;
  StudyConfig config_;
};

}  // namespace

StudyConfig parse_study(const std::string& text, const std::string& origin,
                        const Registry& registry) {
  StudyReader reader(origin);
  StudyConfig config = reader.file(text);
  study::read_data(config);
  std::vector<std::string> mistakes = reader.mistakes();
  for (const std::string& more : config.mistakes(registry)) mistakes.push_back(more);
  if (!mistakes.empty()) throw ConfigError(mistakes);
  return config;
}

StudyConfig read_study(const std::string& path, const Registry& registry) {
  std::ifstream in(path);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf()))
    throw ConfigError({fmt::format("study: cannot read '{}'", path)});
  return parse_study(text.str(), path, registry);
}

}  // namespace hamel
