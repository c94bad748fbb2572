// Study files: TOML with the names of `hamel run` as lists.
#include <algorithm>

#include <fmt/format.h>

#include <hamel/framework/io/text_file.hpp>
#include <hamel/framework/io/toml_reader.hpp>
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/run/names/toml_config.hpp>
#include <hamel/framework/run/names/toml_inputs.hpp>
#include <hamel/framework/study/parts.hpp>

namespace hamel {
namespace {

class StudyReader {
 public:
  StudyReader(const std::string& origin, const Registry& registry)
      : origin_(origin), registry_(registry), read_(origin) {}

  StudyConfig file(const std::string& text) {
    const toml::table table = read_.parse(text);
    refuse_other_kinds(table);
    config_.text = text;
    for (const auto& [name, node] : table) {
      const std::string key(name.str());
      at(key, node);
      if (key == "title") read_.value(node, key, config_.title);
      else if (key == "mode") mode(node);
      else if (key == "until") read_.value(node, key, config_.until);
      else if (key == "repeats") read_.value(node, key, config_.repeats);
      else if (key == "reference") read_.value(node, key, config_.reference);
      else if (key == "system") systems(node);
      else if (key == "exclude") exclusions(node);
      else if (!axis(key, node)) read_.unknown_key(node, key, keys());
    }
    return std::move(config_);
  }
  std::vector<std::string>& mistakes() { return read_.mistakes; }

 private:
  static std::vector<std::string> keys() {
    std::vector<std::string> all = {"title",     "mode",   "until",  "repeats",
                                    "reference", "system", "exclude"};
    all.insert(all.end(), study_axes().begin() + 1, study_axes().end());
    return all;
  }

  void refuse_other_kinds(const toml::table& table) const {
    const toml::node* system = table.get("system");
    const auto has = [&](const std::string& key) { return table.contains(key); };
    const bool parts = std::ranges::any_of(registry_.file_kinds(), [&](const FileKind& kind) {
      return std::ranges::any_of(kind.keys, has);
    });
    if (system == nullptr && (parts || has("group"))) {
      throw ConfigError(
          {fmt::format("{0}: this file is a system (hamel run {0}), no study; a study of it has "
                       "[[system]] name = \"{0}\"",
                       origin_)});
    }
    if (system != nullptr && system->is_string()) {
      const char* kind = is_ensemble(table) ? "an ensemble (hamel ensemble"
                                            : "the configuration of a run (hamel run --config";
      throw ConfigError({fmt::format("{0}: this file is {1} {0}), no study", origin_, kind)});
    }
  }

  void at(const std::string& key, const toml::node& node) {
    config_.where[key] = read_.place(node);
  }

  void mode(const toml::node& node) {
    std::string word;
    read_.value(node, "mode", word);
    config_.zipped = word == "zipped";
    if (word != "zipped" && word != "factorial" && !word.empty())
      read_.unknown(node, "mode", word, {"factorial", "zipped"});
  }

  // Value or a list of them, each with its place.
  bool axis(const std::string& key, const toml::node& node) {
    bool found = false;
    Config::fields([&](const Option& option, auto member) {
      if (option.name != key || !option.axis) return;
      found = true;
      StudyValues& out = config_.axes[key];
      const auto take = [&](const toml::node& entry) {
        if (is_fixed(key, entry)) {
          out.emplace_back();
          return;
        }
        auto value = Config().*member;
        const size_t before = read_.mistakes.size();
        read_.value(entry, key, value);
        if (read_.mistakes.size() > before) return;
        at(fmt::format("{}[{}]", key, out.size()), entry);
        out.push_back(text_of(value));
      };
      const toml::array* array = node.as_array();
      if (array == nullptr) return take(node);
      if (array->empty()) read_.wrong(node, key, "at least one value");
      for (const toml::node& entry : *array) take(entry);
    });
    return found;
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
      std::vector<std::string> known = {"name", "label", "set", "inputs"};
      bool found = true;
      if (key == "name") read_.value(node, key, out.name);
      else if (key == "label") read_.value(node, key, out.label);
      else if (key == "set") set(node, prefix, out.parameters);
      else if (key == "inputs") read_inputs(read_, node, out.inputs);
      else found = false;
      Config::start_fields([&, &entry = node](const Option& option, auto member) {
        known.emplace_back(option.name);
        if (option.name != key) return;
        found = true;
        read_.value(entry, key, out.start.*member);
      });
      if (!found) read_.unknown_key(node, key, known);
    }
    if (out.label.empty()) out.label = out.name;
    return out;
  }

  void set(const toml::node& node, const std::string& prefix, Parameters& out) {
    read_.lists(node, "set", out);
    if (const toml::table* table = node.as_table())
      for (const auto& [name, value] : *table)
        at(prefix + ".set." + std::string(name.str()), value);
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
        if (key == "why") read_.value(value, key, out.why);
        else matched(value, key, out);
      }
      config_.exclude.push_back(std::move(out));
    }
  }

  // Value or a list, as the names that the axis has for them.
  void matched(const toml::node& node, const std::string& key, StudyExclusion& out) {
    std::vector<std::string> known = study_axes();
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      known.push_back("why");
      return read_.unknown_key(node, key, known);
    }
    const auto take = [&](const toml::node& entry) {
      if (is_fixed(key, entry)) out.values[key].emplace_back();
      else if (auto word = entry.value<std::string>(); word && entry.is_string())
        out.values[key].push_back(*word);
      else if (auto number = entry.value<double>(); number && entry.is_number())
        out.values[key].push_back(text_of(*number));
      else read_.wrong(entry, "exclude." + key, "a value of that axis, or a list of them");
    };
    if (const toml::array* array = node.as_array())
      for (const toml::node& entry : *array) take(entry);
    else take(node);
  }

  // rtol = ["fixed", 1e-6]: steps of one size.
  static bool is_fixed(const std::string& key, const toml::node& node) {
    return (key == "rtol" || key == "atol") && node.value<std::string>() == "fixed";
  }

  std::string origin_;
  const Registry& registry_;
  TomlReader read_;
  StudyConfig config_;
};

}  // namespace

StudyConfig parse_study(const std::string& text, const std::string& origin,
                        const Registry& registry) {
  StudyReader reader(origin, registry);
  StudyConfig config = reader.file(text);
  study::read_data(config);
  std::vector<std::string> mistakes = reader.mistakes();
  for (const std::string& more : config.mistakes(registry)) mistakes.push_back(more);
  if (!mistakes.empty()) throw ConfigError(mistakes);
  return config;
}

StudyConfig read_study(const std::string& path, const Registry& registry) {
  return parse_study(read_text_file("study", path), path, registry);
}

}  // namespace hamel
