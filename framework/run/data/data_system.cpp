#include <hamel/framework/run/data/data_system.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/mechanics/quantity_names.hpp>
#include <hamel/framework/run/data/data_drawing.hpp>
#include <hamel/framework/run/data/data_formulas.hpp>
#include <hamel/framework/run/data/data_mechanics.hpp>
#include <hamel/framework/run/data/formula_programs.hpp>
#include <hamel/framework/run/data/toml_contacts.hpp>
#include <hamel/framework/run/data/toml_events.hpp>
#include <hamel/framework/run/data/toml_outputs.hpp>
#include <hamel/framework/run/data/toml_parameters.hpp>
#include <hamel/framework/run/names/toml_config.hpp>

namespace hamel {
namespace {

using Node = toml::node;
using Names = std::vector<std::string>;

class File {
 public:
  File(const Registry& registry, const std::string& origin)
      : registry_(registry), origin_(origin), read_(origin), formulas_(read_) {}

  SystemModel read(const std::string& text, const Parameters& given) {
    table_ = read_.parse(text);
    refuse_other_kinds();
    model_.name = origin_;
    if (const Node* node = table_.get("name")) read_.value(*node, "name", model_.name);
    model_.group = group_of();
    states();
    model_.inputs = read_input_fields(read_, table_);
    model_.fields = read_parameters(read_, formulas_, table_, model_.name, given);
    formulas_.read_lets(table_);
    name_all();
    check_keys();
    DataFormulasReader matrices(read_, formulas_, table_, names_);
    DataFormulas driven = matrices.read(names_.inputs);
    model_.formulas = matrices.texts();
    stop_at_mistakes();
    rest();
    stop_at_mistakes();
    const std::shared_ptr<const Geometry> geometry = registry_.geometry(model_.group.name, "exp");
    for (const std::string& input : names_.inputs)
      formulas_.set(input, 0);  // where nothing drives it
    const DataFormulas idle = names_.inputs.empty() ? driven : matrices.read({});
    const auto programs_of = [&](const DataFormulas& formulas) {
      return std::make_shared<const FormulaPrograms>(
          formulas, static_cast<size_t>(geometry->columns()), names_.rates.size());
    };
    const auto make = [idle = programs_of(idle), driven = programs_of(driven), geometry,
                       group = model_.group](const std::shared_ptr<const Inputs>& inputs) {
      return std::make_shared<DataMechanics>(inputs == nullptr ? idle : driven, group, geometry,
                                             inputs);
    };
    if (idle.left_invariant())
      model_.mechanics =
          std::make_shared<LeftInvariantMechanics>(idle.inertia.constant, idle.rows.constant);
    else model_.mechanics = make(nullptr);
    if (!names_.inputs.empty()) model_.drive = make;
    model_.start_mistakes = [make](double t, const double* g, std::span<const double> xi,
                                   const std::shared_ptr<const Inputs>& inputs) {
      return make(inputs)->start_mistakes(
          t, g, Eigen::Map<const Eigen::VectorXd>(xi.data(), std::ssize(xi)));
    };
    return std::move(model_);
  }

 private:
  void stop_at_mistakes() const {
    if (!read_.mistakes.empty()) throw ConfigError(read_.mistakes);
  }

  void refuse_other_kinds() const {
    const Node* other = table_.get("system");
    if (other == nullptr) return;
    const char* kind = other->is_array()     ? "a study (hamel study"
                       : is_ensemble(table_) ? "an ensemble (hamel ensemble"
                                             : "the configuration of a run (hamel run --config";
    throw ConfigError(
        {fmt::format("{0}: this file is {1} {0}), no system by data", origin_, kind)});
  }

  // All else depends on the group.
  GroupInfo group_of() {
    std::string name;
    const Node* node = table_.get("group");
    if (node == nullptr) {
      std::string others;
      for (const FileKind& kind : registry_.file_kinds())
        others += fmt::format(", or tables [[{}]]", kind.keys.front());
      read_.mistakes.push_back(
          fmt::format("{}: group: missing, expected the name of a group{}", origin_, others));
    } else {
      read_.value(*node, "group", name);
    }
    stop_at_mistakes();
    const auto info = registry_.group_or_product(name);
    if (!info)
      read_.mistakes.push_back(
          fmt::format("{}: {}", read_.place(*node), registry_.missing_group(name)));
    else if (registry_.geometry(name, "exp") == nullptr)
      read_.wrong(*node, "group", "a group with the retraction exp");
    stop_at_mistakes();
    return *info;
  }

  // Scalars behind the coordinates of the group: those of one more factor.
  void states() {
    const Node* node = table_.get("state");
    names("coordinates", model_.group.columns.size(), model_.coordinates);
    names("rates", static_cast<size_t>(model_.group.dim), model_.rates);
    if (node == nullptr) return;
    const toml::array* tables = node->as_array();
    if (tables == nullptr || !tables->is_array_of_tables())
      read_.wrong(*node, "state", "tables, [[state]]");
    stop_at_mistakes();
    Names of_states;
    for (const Node& entry : *tables) {
      std::string name;
      const toml::table& state = *entry.as_table();
      for (const auto& [key, value] : state) {
        if (key == "name") read_.value(value, "state.name", name);
        else if (key != "rate") read_.unknown_key(value, std::string(key.str()), {"name", "rate"});
      }
      if (!Expression::allows(name))
        read_.wrong(entry, "state.name",
                    fmt::format("a name allowed in a formula, got '{}'", name));
      of_states.push_back(name);
    }
    stop_at_mistakes();
    SystemModel own = model_;
    name_quantities(own);
    model_.coordinates = own.group.columns + of_states;
    for (std::string& name : of_states) name += ".rate";
    model_.rates = own.rates + of_states;
    names_.states = of_states.size();
    const std::string product = fmt::format("{}*r{}", model_.group.name, names_.states);
    const auto info = registry_.group_or_product(product);
    if (!info) throw ConfigError({registry_.missing_group(product)});
    model_.group = *info;
  }

  // The names of coordinates, rates and inputs, each its own.
  void name_all() {
    const Names coordinates = model_.coordinates, rates = model_.rates;
    name_quantities(model_);
    QuantityNames names(model_);
    const auto middle =
        names.variables().begin() + 1 + static_cast<std::ptrdiff_t>(model_.group.columns.size());
    names_.coordinates.assign(names.variables().begin() + 1, middle);
    names_.rates.assign(middle, names.variables().end());
    for (const InputField& input : model_.inputs) names_.inputs.push_back(input.name);
    Names all{"t"};
    all = all + (coordinates.empty() ? names_.coordinates : coordinates) +
          (rates.empty() ? names_.rates : rates) + names_.inputs;
    for (const GroupFactor& factor : model_.group.factors) {
      for (const Component& component : factor.components)  // a coordinate called omega
        if (rates.empty() && !factor.is_shape &&
            std::find(coordinates.begin(), coordinates.end(), component.name) != coordinates.end())
          all.push_back(component.name);
    }
    for (const auto& [name, text] : formulas_.lets().texts()) all.push_back(name);
    for (const auto& [name, value] : formulas_.constants()) {
      all.push_back(name);
      if (names.find(name) && !name.starts_with("xi")) all.push_back(name);
      names.forget(name);
    }
    formulas_.read_by([names](const std::string& text) { return names.in_formula(text); });
    std::sort(all.begin(), all.end());
    const auto twice = std::adjacent_find(all.begin(), all.end());
    if (twice != all.end())
      read_.mistakes.push_back(fmt::format("{}: two things are called '{}'", origin_, *twice));
    stop_at_mistakes();
  }
  // The names that the file gives, so many.
  void names(const std::string& key, size_t count, Names& out) {
    const Node* node = table_.get(key);
    if (node == nullptr) return;
    Names given;
    const size_t before = read_.mistakes.size();
    read_.value(*node, key, given);
    if (read_.mistakes.size() > before) return;
    if (given.size() != count)
      return read_.wrong(*node, key, fmt::format("{} names, got {}", count, given.size()));
    for (const std::string& name : given) {
      if (!Expression::allows(name))
        read_.wrong(*node, key, fmt::format("names allowed in a formula, got '{}'", name));
    }
    out = given;
  }

  void check_keys() {
    static const Names known = {
        "configuration", "constraints", "contact",   "contacts", "coordinates",
        "draw",          "drift",       "events",    "floor",    "force",
        "from_above",    "group",       "holonomic", "inertia",  "inputs",
        "invariants",    "let",         "momentum",  "name",     "outputs",
        "parameters",    "potential",   "rates",     "state",    "velocity"};
    for (const auto& [name, node] : table_) {
      const std::string key(name.str());
      if (std::find(known.begin(), known.end(), key) == known.end())
        read_.unknown_key(node, key, known);
    }
    if (!table_.contains("inertia"))
      read_.mistakes.push_back(fmt::format("{}: inertia: missing, expected {} entries", origin_,
                                           model_.group.dim - static_cast<int>(names_.states)));
  }

  // Start, events, invariants, contacts and drawing.
  void rest() {
    // Numbers of states may be left out: they are 0, and their rates follow from the rows.
    const auto start = [&](const std::string& key, size_t count, std::vector<double>& out) {
      const Node* node = table_.get(key);
      if (node == nullptr) return;
      const toml::array* list = node->as_array();
      const bool without = list != nullptr && list->size() + names_.states == count;
      out = formulas_.numbers(*node, key, static_cast<long>(without ? list->size() : count));
      out.resize(count, 0.0);
    };
    start("configuration", names_.coordinates.size(), model_.start.configuration);
    start("velocity", names_.rates.size(), model_.start.velocity);
    start("momentum", names_.rates.size(), model_.start.momentum);
    if (const Node* both = table_.get("momentum"); both != nullptr && table_.contains("velocity"))
      read_.wrong(*both, "momentum", "velocity or momentum, not both");
    model_.outputs = read_outputs(read_, formulas_, table_);
    stop_at_mistakes();
    const std::vector<std::string> flaws = output_mistakes(model_);
    read_.mistakes.insert(read_.mistakes.end(), flaws.begin(), flaws.end());
    model_.events = read_events(read_, formulas_, table_, model_, names_.coordinates, names_.rates);
    each("invariants", [&](const std::string& name, const Node& node) {
      if (auto f =
              formulas_.expression(node, "invariants." + name, names_.coordinates + names_.rates))
        model_.invariants.push_back({name, of_state(std::move(*f))});
    });
    contacts();
    if (const Node* node = table_.get("floor"))
      read_.value(*node, "floor", model_.drawing.has_floor);
    if (const Node* node = table_.get("from_above")) {
      read_.value(*node, "from_above", model_.drawing.from_above);
      model_.drawing.has_floor |= model_.drawing.from_above;
    }
    if (const Node* node = table_.get("draw"))
      DataDrawing(read_, formulas_, names_.coordinates).read(*node, model_.drawing);
  }
  template <class Visit>
  void each(const std::string& key, const Visit& visit) {
    const Node* node = table_.get(key);
    if (node == nullptr) return;
    const toml::table* entries = node->as_table();
    if (entries == nullptr) return read_.wrong(*node, key, "a table");
    for (const auto& [name, value] : *entries) visit(std::string(name.str()), value);
  }
  // A formula of coordinates and rates.
  static std::function<double(std::span<const double>, std::span<const double>)> of_state(
      Expression formula) {
    return [formula = std::move(formula), values = std::vector<double>()](
               std::span<const double> g, std::span<const double> xi) mutable {
      values.assign(g.begin(), g.end());
      values.insert(values.end(), xi.begin(), xi.end());
      return formula(values);
    };
  }
  void contacts() {
    const auto count = [&](const char* key) {
      const Node* list = table_.get(key);
      return list == nullptr ? 0 : static_cast<int>(list->as_array()->size());
    };
    const StatedRows all{count("constraints"), static_cast<int>(names_.states), count("holonomic")};
    if (const Node* node = table_.get("contacts")) {
      for (const double row : formulas_.numbers(*node, "contacts")) {
        if (row >= 1 && row <= all.count() && row == std::floor(row))
          model_.contacts.push_back(all.index(static_cast<int>(row)));
        else
          read_.wrong(*node, "contacts",
                      fmt::format("numbers of rows, 1 to {}, got {}", all.count(), row));
      }
    }
    model_.contact_laws = ContactReader(read_, formulas_, all).read(table_);
    for (const ContactLaw& law : model_.contact_laws)
      if (law.normal) std::erase(model_.contacts, *law.normal);
  }

  const Registry& registry_;
  std::string origin_;
  TomlReader read_;
  TomlFormulas formulas_;
  toml::table table_;
  SystemModel model_;
  DataNames names_;
};

}  // namespace

SystemModel data_system(const Registry& registry, const std::string& text,
                        const std::string& origin, const Parameters& given) {
  return File(registry, origin).read(text, given);
}

}  // namespace hamel
