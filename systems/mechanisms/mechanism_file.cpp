#include <hamel/framework/mechanics/quantity_names.hpp>
#include <hamel/framework/mechanics/system.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/systems/mechanisms/mechanism_file.hpp>

#include <memory>
#include <utility>

#include <hamel/framework/run/data/toml_events.hpp>
#include <hamel/framework/run/data/toml_outputs.hpp>
#include <hamel/framework/run/data/toml_parameters.hpp>
#include <hamel/systems/mechanisms/assembled_models.hpp>
#include <hamel/systems/mechanisms/contact.hpp>
#include <hamel/systems/mechanisms/files/file_parts.hpp>

namespace hamel {
namespace {

using mechanisms::FileParts;
using mechanisms::FileValues;
using Node = toml::node;

class File {
 public:
  File(std::shared_ptr<const toml::table> table, const std::string& origin,
       const NameOptions& options = {})
      : origin_(origin), read_(origin), kept_(std::move(table)), table_(*kept_) {
    if (const auto it = options.find("hold"); it != options.end()) held_ = it->second;
  }

  SystemModel model(const Parameters& given) {
    parameters(given);
    Mechanism m = parts();
    SystemModel out = m.model();
    out.fields = fields_;
    out.notes.insert(out.notes.end(), read_.notes.begin(), read_.notes.end());
    out.outputs = read_outputs(read_.toml, read_.formulas, table_);
    read_.toml.mistakes = output_mistakes(out);
    stop_at_mistakes();
    out.events = read_events(read_.toml, read_.formulas, table_, out, out.group.columns, out.rates);
    stop_at_mistakes();
    return out;
  }
  SystemModel outline() {
    parameters({});
    SystemModel out = parts().outline();
    out.fields = fields_;
    return out;
  }
  /// A text in the file; "" where there is none.
  std::string word(const std::string& key) const { return table_[key].value_or(std::string()); }

 private:
  void stop_at_mistakes() const {
    if (!read_.toml.mistakes.empty()) throw ConfigError(read_.toml.mistakes);
  }

  void parameters(const Parameters& given) {
    std::string name = word("name");
    if (name.empty()) name = origin_;
    fields_ = read_parameters(read_.toml, read_.formulas, table_, name, given);
    read_.formulas.read_lets(table_);
    stop_at_mistakes();
  }

  Mechanism parts() {
    std::string name = origin_;
    if (const Node* node = table_.get("name")) read_.toml.value(*node, "name", name);
    Mechanism m(name);
    check_keys();
    FileParts parts(read_, table_, m, held_);
    parts.bodies();
    parts.joints();
    parts.inputs();
    parts.states();
    stop_at_mistakes();
    const SystemModel outline = m.outline();
    read_.set_names(outline.group.columns, outline.rates, outline.inputs);
    check_formula_names();
    QuantityNames names(outline);
    for (const auto& [constant, value] : read_.formulas.constants()) names.forget(constant);
    read_.formulas.read_by([names](const std::string& text) { return names.in_formula(text); });
    parts.contacts();
    parts.chains();
    parts.hold();
    parts.forces();
    parts.sensors();
    parts.surroundings();
    stated_events(read_.toml, table_);
    read_outputs(read_.toml, read_.formulas, table_);
    stop_at_mistakes();
    return m;
  }

  void check_keys() {
    std::vector<std::string> known = mechanisms::names_of(mechanisms::contact_kinds());
    for (const char* key :
         {"asks",       "body",       "brake",   "coupling",        "distribution", "events",
          "force",      "formula",    "gravity", "ground",          "inputs",       "joint",
          "known",      "let",        "loop",    "motor",           "name",         "outputs",
          "parameters", "prescribed", "push",    "redundant",       "sensor",       "slope",
          "source",     "spring",     "start",   "start_arguments", "state",        "summary",
          "torque",     "wall"})
      known.emplace_back(key);
    std::ranges::sort(known);
    for (const auto& [name, node] : table_) {
      const std::string key(name.str());
      if (std::find(known.begin(), known.end(), key) == known.end())
        read_.toml.unknown_key(node, key, known);
    }
  }

  // Refuses a name that formulas use for two things.
  void check_formula_names() {
    const auto each = [&](const std::string& kind, auto&& taken) {
      const toml::table* table = table_[kind].as_table();
      if (table == nullptr) return;
      for (const auto& [name, node] : *table) {
        const std::string key(name.str());
        if (taken(key)) read_.toml.wrong(node, kind + "." + key, "a name that nothing else has");
      }
    };
    each("parameters", [&](const std::string& key) { return read_.names(key); });
    each("let", [&](const std::string& key) { return read_.names(key); });
    each("inputs", [&](const std::string& key) { return !read_.names_input(key); });
    stop_at_mistakes();
  }

  std::string origin_;
  FileValues read_;
  std::shared_ptr<const toml::table> kept_;
  const toml::table& table_;
  std::vector<Field> fields_;
  std::vector<std::string> held_;
};

std::shared_ptr<const toml::table> parse(const std::string& text, const std::string& origin) {
  return std::make_shared<const toml::table>(TomlReader(origin).parse(text));
}

}  // namespace

SystemModel mechanism_from(const std::string& text, const std::string& origin,
                           const Parameters& given, const NameOptions& options) {
  return File(parse(text, origin), origin, options).model(given);
}

SystemInfo mechanism_info(const std::string& text, const std::string& origin) {
  const auto table = parse(text, origin);
  File file(table, origin);
  const SystemModel model = file.outline();
  SystemInfo out;
  out.name = model.name;
  out.group = model.group;
  out.fields = model.fields;
  out.inputs = model.inputs;
  out.summary = file.word("summary");
  out.formula = file.word("formula");
  out.known = file.word("known");
  out.source = file.word("source");
  out.make = [table, origin,
              before = std::make_shared<mechanisms::AssembledModels>()](const Parameters& given) {
    return before->take(given, [&] { return File(table, origin).model(given); });
  };
  out.make_with = [table, origin](const Parameters& given, const NameOptions& options) {
    return File(table, origin, options).model(given);
  };
  return out;
}

}  // namespace hamel
