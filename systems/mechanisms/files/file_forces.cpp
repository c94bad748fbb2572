// Parts of a file that act on bodies or are about them: inputs, forces, sensors, the surroundings
// and the start.
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/run/data/toml_parameters.hpp>
#include <hamel/systems/mechanisms/files/file_parts.hpp>

namespace hamel::mechanisms {

// steer.angle = 0.1 is a table in a table to TOML.
template <class Take>
void FileParts::numbers(const toml::table& table, const Take& take, const std::string& front) {
  for (const auto& [name, node] : table) {
    const std::string key = front + std::string(name.str());
    if (const toml::table* inner = node.as_table()) {
      numbers(*inner, take, key + ".");
    } else {
      m_.place(read_.toml.place(node) + ": ");
      take(key, read_.number(node, key));
    }
  }
}

void FileParts::motor(const toml::table& table) {
  std::string joint;
  Signal effort;
  bool time_dependent = false;
  Range range;
  read_.entries(table, {{"joint", read_.read(joint)},
                        {"effort",
                         [&](const Node& node, const std::string& key) {
                           effort = read_.signal(node, key, time_dependent);
                         }},
                        {"least", read_.read(range.least)},
                        {"most", read_.read(range.most)}});
  if (!is_input(table, {"effort"})) no_range(table);
  if (effort) m_.motor(joint, effort, time_dependent);
  else m_.motor(joint, range);
}
void FileParts::brake(const toml::table& table) {
  std::string joint;
  Range range{.least = 0};
  read_.entries(table, {{"joint", read_.read(joint)},
                        {"least", read_.read(range.least)},
                        {"most", read_.read(range.most)}});
  m_.brake(joint, range);
}
// Inputs of motors, of prescribed joints, and by name: formulas may use them.
void FileParts::inputs() {
  tables("motor", [&](const toml::table& table) {
    if (is_input(table, {"effort"})) motor(table);
  });
  tables("prescribed", [&](const toml::table& table) {
    if (is_input(table, {"rate", "angle"})) prescribed(table);
  });
  tables("brake", [&](const toml::table& table) { brake(table); });
  for (const InputField& field : read_input_fields(read_.toml, table_)) {
    m_.place(read_.toml.place(*table_["inputs"][field.name].node()) + ": ");
    m_.input(field);
  }
}
void FileParts::forces() {
  tables("spring", [&](const toml::table& table) {
    std::string name, a = kWorld, b;
    SpringOptions o;
    read_.entries(table, {{"name", read_.read(name)},
                          {"a", read_.read(a)},
                          {"b", read_.read(b)},
                          {"from", read_.read(o.from)},
                          {"to", read_.read(o.to)},
                          {"stiffness", read_.read(o.stiffness)},
                          {"rest", read_.read(o.rest)},
                          {"damping", read_.read(o.damping)}});
    m_.spring(name, a, b, o);
  });
  tables("motor", [&](const toml::table& table) {
    if (!is_input(table, {"effort"})) motor(table);
  });
  const auto along = [this](auto& o) {
    o.time_dependent = false;
    return [this, &o](const Node& node, const std::string& key) {
      const toml::array* array = node.as_array();
      if (array == nullptr || array->size() != 3)
        return read_.toml.wrong(node, key, "3 numbers or formulas");
      for (size_t i = 0; i < 3; ++i) o.along[i] = read_.signal((*array)[i], key, o.time_dependent);
    };
  };
  tables("force", [&](const toml::table& table) {
    std::string name, body;
    ForceOptions o;
    read_.entries(table, {{"name", read_.read(name)},
                          {"body", read_.read(body)},
                          {"at", read_.read(o.at)},
                          {"along", along(o)},
                          {"of_body", read_.read(o.of_body)}});
    m_.force(name, body, o);
  });
  tables("torque", [&](const toml::table& table) {
    std::string name, body;
    TorqueOptions o;
    read_.entries(table, {{"name", read_.read(name)},
                          {"body", read_.read(body)},
                          {"along", along(o)},
                          {"of_body", read_.read(o.of_body)}});
    m_.torque(name.empty() ? body : name, body, o);
  });
}
// States are read before the formulas that may use their names; their rates are judged where all
// names are known.
void FileParts::sensors() {
  tables("sensor", [&](const toml::table& table) {
    std::string name, body;
    Point at = {0, 0, 0};
    read_.entries(table,
                  {{"name", read_.read(name)}, {"body", read_.read(body)}, {"at", read_.read(at)}});
    m_.sensor(name.empty() ? body : name, body, at);
  });
}
void FileParts::surroundings() {
  Point gravity = {0, 0, -9.81};
  stated("gravity", [&](const Node& node) {
    if (node.is_array()) gravity = read_.point(node, "gravity");
    else gravity[2] = -read_.number(node, "gravity");
  });
  stated("slope", [&](const Node& node) {
    const double slope = read_.number(node, "slope"), g = gravity[2];
    if (gravity[0] != 0 || gravity[1] != 0)
      return read_.toml.wrong(node, "slope", "gravity as a number beside it");
    gravity = {-g * std::sin(slope), 0, g * std::cos(slope)};
  });
  m_.gravity(gravity);
  stated("ground", [&](const Node& node) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return read_.toml.wrong(node, "ground", "a table");
    double rate = 0;
    Point velocity = {0, 0, 0};
    const auto height = [&](const Node& entry, const std::string& key) {
      if (!entry.is_string() && !entry.is_number())
        return read_.toml.wrong(entry, key, "a formula of x and y");
      Parameters constants;
      for (const auto& [name, value] : read_.formulas.constants()) constants[name] = {value};
      m_.place(read_.toml.place(entry) + ": ");
      m_.ground_height(entry.is_number() ? fmt::format("{}", *entry.value<double>())
                                         : entry.value_or(std::string()),
                       constants);
    };
    read_.entries(
        *table,
        {{"rate", read_.read(rate)}, {"velocity", read_.read(velocity)}, {"height", height}});
    m_.ground(rate, velocity);
  });
  stated("redundant", [&](const Node& node) {
    std::string policy;
    read_.toml.value(node, "redundant", policy);
    m_.redundant(policy);
  });
  stated("distribution", [&](const Node& node) {
    std::string policy;
    read_.toml.value(node, "distribution", policy);
    m_.distribution(policy);
  });
  for (const char* key : {"start_arguments", "asks"}) {  // asks: its name before version 0.2
    stated(key, [&](const Node& node) {
      std::vector<std::string> names;
      read_.toml.value(node, key, names);
      m_.start_arguments(names);
    });
  }
  stated("start", [&](const Node& node) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return read_.toml.wrong(node, "start", "a table");
    numbers(*table, [&](const std::string& name, double value) {
      if (!is_held(name)) m_.start(name, value);
    });
  });
  stated("push", [&](const Node& node) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return read_.toml.wrong(node, "push", "a table");
    numbers(*table, [&](const std::string& name, double value) {
      if (!is_held(name)) m_.push(name, value);
    });
  });
}

}  // namespace hamel::mechanisms
