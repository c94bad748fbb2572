#include <hamel/systems/mechanisms/mechanism_file.hpp>

#include <utility>

#include <hamel/framework/run/toml_parameters.hpp>
#include <hamel/systems/mechanisms/file_values.hpp>

namespace hamel {
namespace {

using mechanisms::FileValues;
using Node = toml::node;

class File {
 public:
  File(const std::string& text, const std::string& origin)
      : origin_(origin), read_(origin), table_(read_.toml.parse(text)) {}

  SystemModel model(const Parameters& given) {
    parameters(given);
    Mechanism m = parts();
    SystemModel out = m.model();
    out.fields = fields_;
    return out;
  }
  SystemModel outline() {
    parameters({});
    SystemModel out = parts().outline().first;
    out.fields = fields_;
    return out;
  }
  /// Of a text in the library.
  std::string word(const std::string& key) const { return table_[key].value_or(std::string()); }

 private:
  void stop_at_mistakes() const {
    if (!read_.toml.mistakes.empty()) throw ConfigError(read_.toml.mistakes);
  }

  void parameters(const Parameters& given) {
    std::string name = word("name");
    if (name.empty()) name = origin_;
    fields_ = read_parameters(read_.toml, read_.formulas, table_, name, given);
  }

  // each(table) for the tables [[kind]]; their mistakes carry their place.
  template <class Each>
  void tables(Mechanism& m, const std::string& kind, Each&& each) {
    const Node* node = table_.get(kind);
    if (node == nullptr) return;
    const toml::array* array = node->as_array();
    if (array == nullptr || !array->is_array_of_tables()) {
      read_.toml.wrong(*node, kind, fmt::format("tables, [[{}]]", kind));
      return;
    }
    for (const Node& entry : *array) {
      m.place(read_.toml.place(entry) + ": ");
      each(*entry.as_table());
    }
  }

  Mechanism parts() {
    std::string name = origin_;
    if (const Node* node = table_.get("name")) read_.toml.value(*node, "name", name);
    Mechanism m(name);
    check_keys();
    bodies(m);
    joints(m);
    stop_at_mistakes();
    const auto [outline, words] = m.outline();
    std::vector<std::string> state = outline.group.columns;
    state.insert(state.end(), words.rates.begin(), words.rates.end());
    read_.set_state(std::move(state));
    contacts(m);
    chains(m);
    forces(m);
    surroundings(m);
    start(m);
    stop_at_mistakes();
    return m;
  }

  void check_keys() {
    static const std::vector<std::string> known = {
        "asks",   "ball",  "blade",  "body",   "force", "formula",    "gravity",    "ground",
        "joint",  "known", "loop",   "motor",  "name",  "parameters", "prescribed", "redundant",
        "roller", "slope", "source", "spring", "start", "summary",    "wheel"};
    for (const auto& [name, node] : table_) {
      const std::string key(name.str());
      if (std::find(known.begin(), known.end(), key) == known.end())
        read_.toml.unknown_key(node, key, known);
    }
  }

  void bodies(Mechanism& m) {
    tables(m, "body", [&](const toml::table& table) {
      std::string name;
      BodyOptions o;
      read_.entries(table, {{"name", read_.read(name)},
                            {"mass", read_.read(o.mass)},
                            {"at", read_.read(o.at)},
                            {"inertia", read_.read(o.inertia)},
                            {"box", read_.read(o.box)},
                            {"cylinder", read_.read(o.cylinder)},
                            {"sphere", read_.read(o.sphere)},
                            {"axis", read_.read(o.axis)}});
      m.body(name, o);
    });
  }
  void joints(Mechanism& m) {
    tables(m, "joint", [&](const toml::table& table) {
      std::string name, kind, child, parent = kWorld;
      JointOptions o;
      read_.entries(table, {{"name", read_.read(name)},
                            {"kind", read_.read(kind)},
                            {"parent", read_.read(parent)},
                            {"child", read_.read(child)},
                            {"at", read_.read(o.at)},
                            {"axis", read_.read(o.axis)},
                            {"axis2", read_.read(o.axis2)},
                            {"stiffness", read_.read(o.stiffness)},
                            {"rest", read_.read(o.rest)},
                            {"damping", read_.read(o.damping)}});
      m.joint(kind, name.empty() ? child : name, parent, child, o);
    });
  }
  // A contact is named as its body where it has no name of its own.
  void contacts(Mechanism& m) {
    const auto round = [&](const std::string& kind, auto add) {
      tables(m, kind, [&](const toml::table& table) {
        std::string name, body;
        WheelOptions o;
        FileValues::Keys keys = {{"name", read_.read(name)},
                                 {"body", read_.read(body)},
                                 {"at", read_.read(o.at)},
                                 {"radius", read_.read(o.radius)}};
        if (kind != "ball") keys.emplace_back("axle", read_.read(o.axle));
        if (kind == "roller") keys.emplace_back("angle", read_.read(o.angle));
        read_.entries(table, keys);
        (m.*add)(name.empty() ? body : name, body, o);
      });
    };
    round("wheel", &Mechanism::wheel);
    round("roller", &Mechanism::roller);
    round("ball", &Mechanism::ball);
    tables(m, "blade", [&](const toml::table& table) {
      std::string name, body;
      BladeOptions o;
      read_.entries(table, {{"name", read_.read(name)},
                            {"body", read_.read(body)},
                            {"at", read_.read(o.at)},
                            {"along", read_.read(o.along)}});
      m.blade(name.empty() ? body : name, body, o);
    });
  }
  void chains(Mechanism& m) {
    tables(m, "loop", [&](const toml::table& table) {
      std::string name, a, b = kWorld;
      LoopOptions o;
      read_.entries(table, {{"name", read_.read(name)},
                            {"a", read_.read(a)},
                            {"b", read_.read(b)},
                            {"at", read_.read(o.at)},
                            {"axis", read_.read(o.axis)}});
      m.loop(name, a, b, o);
    });
    tables(m, "prescribed", [&](const toml::table& table) {
      std::string joint;
      std::function<double(double)> rate, angle;
      Range range;
      const auto of_time = [&](auto& to) {
        return [this, &to](const Node& node, const std::string& key) {
          to = read_.of_time(node, key, key == "angle");
        };
      };
      read_.entries(table, {{"joint", read_.read(joint)},
                            {"rate", of_time(rate)},
                            {"angle", of_time(angle)},
                            {"least", read_.read(range.least)},
                            {"most", read_.read(range.most)}});
      if (rate && angle) read_.toml.wrong(table, "prescribed", "one of rate and angle");
      if (rate || angle) m.prescribe(joint, rate ? rate : angle);
      else m.prescribe(joint, range);
    });
  }
  void forces(Mechanism& m) {
    tables(m, "spring", [&](const toml::table& table) {
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
      m.spring(name, a, b, o);
    });
    tables(m, "motor", [&](const toml::table& table) {
      std::string joint;
      Signal effort;
      Range range;
      read_.entries(table, {{"joint", read_.read(joint)},
                            {"effort", read_.read(effort)},
                            {"least", read_.read(range.least)},
                            {"most", read_.read(range.most)}});
      if (table.contains("effort")) m.motor(joint, effort);
      else m.motor(joint, range);
    });
    tables(m, "force", [&](const toml::table& table) {
      std::string name, body;
      ForceOptions o;
      const auto along = [&](const Node& node, const std::string& key) {
        const toml::array* array = node.as_array();
        if (array == nullptr || array->size() != 3)
          return read_.toml.wrong(node, key, "3 numbers or formulas");
        for (size_t i = 0; i < 3; ++i) o.along[i] = read_.signal((*array)[i], key);
      };
      read_.entries(table, {{"name", read_.read(name)},
                            {"body", read_.read(body)},
                            {"at", read_.read(o.at)},
                            {"along", along},
                            {"of_body", read_.read(o.of_body)}});
      m.force(name, body, o);
    });
  }
  void surroundings(Mechanism& m) {
    Point gravity = {0, 0, -9.81};
    if (const Node* node = table_.get("gravity")) {
      if (node->is_array()) gravity = read_.point(*node, "gravity");
      else gravity[2] = -read_.number(*node, "gravity");
    }
    if (const Node* node = table_.get("slope")) {
      const double slope = read_.number(*node, "slope"), g = gravity[2];
      gravity = {-g * std::sin(slope), 0, g * std::cos(slope)};
    }
    m.gravity(gravity);
    if (const Node* node = table_.get("ground")) {
      double rate = 0;
      Point velocity = {0, 0, 0};
      if (const toml::table* table = node->as_table()) {
        read_.entries(*table, {{"rate", read_.read(rate)}, {"velocity", read_.read(velocity)}});
      } else {
        read_.toml.wrong(*node, "ground", "a table");
      }
      m.ground(rate, velocity);
    }
    std::string redundant = "refuse";
    if (const Node* node = table_.get("redundant")) read_.toml.value(*node, "redundant", redundant);
    m.redundant(redundant);
  }
  // steer.angle = 0.1 is a table in a table to TOML.
  void collect(const toml::table& table, const std::string& front,
               std::map<std::string, double>& to) {
    for (const auto& [name, node] : table) {
      const std::string key = front + std::string(name.str());
      if (const toml::table* inner = node.as_table()) collect(*inner, key + ".", to);
      else to[key] = read_.number(node, key);
    }
  }
  void start(Mechanism& m) {
    std::map<std::string, double> values;
    if (const Node* node = table_.get("start")) {
      if (const toml::table* table = node->as_table()) collect(*table, "", values);
      else read_.toml.wrong(*node, "start", "a table");
    }
    m.start(values);
    std::vector<std::string> asks;
    if (const Node* node = table_.get("asks")) read_.toml.value(*node, "asks", asks);
    m.asks(asks);
  }

  std::string origin_;
  FileValues read_;
  toml::table table_;
  std::vector<Field> fields_;
};

}  // namespace

SystemModel mechanism_from(const std::string& text, const std::string& origin,
                           const Parameters& given) {
  return File(text, origin).model(given);
}

SystemInfo mechanism_info(const std::string& text, const std::string& origin) {
  File file(text, origin);
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
  out.make = [text, origin](const Parameters& given) {
    return mechanism_from(text, origin, given);
  };
  return out;
}

}  // namespace hamel
