#include <hamel/systems/mechanisms/files/file_parts.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

#include <hamel/framework/run/data/toml_parameters.hpp>
#include <hamel/systems/mechanisms/contact.hpp>

namespace hamel::mechanisms {

void FileParts::bodies() {
  tables("body", [&](const toml::table& table) {
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
    m_.body(name, o);
  });
}
// Values of the fields of a kind, numbers or three of them.
void FileParts::add_fields(const std::vector<Field>& fields, Parameters& to,
                           FileValues::Keys& keys) {
  for (const Field& field : fields) {
    keys.emplace_back(field.name, [&](const Node& node, const std::string& key) {
      if (field.value.size() == 3) to[key] = read_.formulas.numbers(node, key, 3);
      else to[key] = {read_.number(node, key)};
    });
  }
}
void FileParts::joints() {
  tables("joint", [&](const toml::table& table) {
    std::string name, kind, child, parent = kWorld;
    JointOptions o;
    bool held = false;
    FileValues::Keys keys = {{"name", read_.read(name)},
                             {"kind", read_.read(kind)},
                             {"parent", read_.read(parent)},
                             {"child", read_.read(child)},
                             {"at", read_.read(o.at)},
                             {"axis", read_.read(o.axis)},
                             {"axis2", read_.read(o.axis2)},
                             {"stiffness", read_.read(o.stiffness)},
                             {"rest", read_.read(o.rest)},
                             {"damping", read_.read(o.damping)},
                             {"held", read_.read(held)},
                             {"friction", read_.read(o.friction)},
                             {"restitution", read_.read(o.restitution)},
                             {"stop", [&](const Node& node, const std::string& key) {
                                o.stop = read_.formulas.numbers(node, key, 2);
                              }}};
    for (const JointKind& any : joint_kinds()) add_fields(any.fields, o.values, keys);
    read_.entries(table, keys);
    if (name.empty()) name = child;
    m_.joint(kind, name, parent, child, o);
    if (held) m_.hold(name);
  });
}
// A contact without a name is named as its body.
void FileParts::contacts() {
  for (const ContactKind& kind : contact_kinds()) {
    tables(kind.name, [&](const toml::table& table) {
      std::string name, body;
      ContactOptions o;
      FileValues::Keys keys = {{"name", read_.read(name)},
                               {"body", read_.read(body)},
                               {"at", read_.read(o.at)},
                               {"friction", read_.read(o.friction)},
                               {"restitution", read_.read(o.restitution)},
                               {"load", read_.read(o.load)},
                               {"unilateral", read_.read(o.unilateral)},
                               {"static_friction", read_.read(o.static_friction)},
                               {"tangential_restitution", read_.read(o.tangential_restitution)},
                               {"share", read_.read(o.share)}};
      if (kind.name == "ball") {
        keys.emplace_back("on", read_.read(o.on));
        keys.emplace_back("inside", read_.read(o.inside));
      }
      add_fields(kind.fields, o.values, keys);
      read_.entries(table, keys);
      m_.contact(kind.name, name.empty() ? body : name, body, o);
    });
  }
}
void FileParts::chains() {
  tables("loop", [&](const toml::table& table) {
    std::string name, a, b = kWorld;
    LoopOptions o;
    read_.entries(table, {{"name", read_.read(name)},
                          {"a", read_.read(a)},
                          {"b", read_.read(b)},
                          {"at", read_.read(o.at)},
                          {"axis", read_.read(o.axis)}});
    m_.loop(name, a, b, o);
  });
  tables("coupling", [&](const toml::table& table) { coupling(table); });
  tables("wall", [&](const toml::table& table) { wall(table); });
  tables("prescribed", [&](const toml::table& table) {
    if (!is_input(table, {"rate", "angle"})) prescribed(table);
  });
}
void FileParts::hold() {
  m_.place("hold: ");
  for (const std::string& held : held_) {
    const size_t equal = held.rfind('=');
    if (equal == std::string::npos) {
      m_.hold(held);
      continue;
    }
    const std::string text = held.substr(equal + 1);
    double at = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), at);
    if (error == std::errc() && end == text.data() + text.size() && std::isfinite(at))
      m_.hold(held.substr(0, equal), at);
    else
      read_.toml.mistakes.push_back(
          fmt::format("hold: '{}': expected JOINT or JOINT=value, rad or m", held));
  }
}
// Is a number of the start the rate of a joint that is held, or its place, where one is given?
bool FileParts::is_held(const std::string& number) const {
  const size_t point = number.rfind('.');
  return std::ranges::any_of(held_, [&](const std::string& held) {
    const size_t equal = held.rfind('=');
    return number.substr(0, point) == held.substr(0, equal) &&
           (equal != std::string::npos || number.substr(point + 1) == "rate");
  });
}
void FileParts::wall(const toml::table& table) {
  std::string name;
  WallOptions o;
  const auto formula = [&](std::string& to) {
    return [this, &to](const Node& node, const std::string& key) { to = read_.formula(node, key); };
  };
  read_.entries(table, {{"name", read_.read(name)},
                        {"distance", formula(o.distance)},
                        {"restitution", read_.read(o.restitution)},
                        {"friction", read_.read(o.friction)},
                        {"slip", formula(o.slip)}});
  for (const auto& [constant, value] : read_.formulas.constants()) o.constants[constant] = {value};
  m_.wall(name, o);
}
void FileParts::coupling(const toml::table& table) {
  std::string name;
  CouplingOptions o;
  const auto formula = [&](std::string& to) {
    return [this, &to](const Node& node, const std::string& key) { to = read_.formula(node, key); };
  };
  read_.entries(table, {{"name", read_.read(name)},
                        {"joint", read_.read(o.joint)},
                        {"to", read_.read(o.to)},
                        {"ratio", read_.read(o.ratio)},
                        {"offset", read_.read(o.offset)},
                        {"formula", formula(o.formula)},
                        {"rates", formula(o.rates)}});
  for (const auto& [constant, value] : read_.formulas.constants()) o.constants[constant] = {value};
  m_.coupling(name.empty() ? o.joint : name, o);
}
void FileParts::prescribed(const toml::table& table) {
  std::string joint;
  FileValues::OfTime rate, angle;
  Range range;
  const auto time_dependent = [&](auto& to) {
    return [this, &to](const Node& node, const std::string& key) {
      to = read_.time_dependent(node, key);
    };
  };
  read_.entries(table, {{"joint", read_.read(joint)},
                        {"rate", time_dependent(rate)},
                        {"angle", time_dependent(angle)},
                        {"least", read_.read(range.least)},
                        {"most", read_.read(range.most)}});
  if (!is_input(table, {"rate", "angle"})) no_range(table);
  if (rate.value && angle.value) read_.toml.wrong(table, "prescribed", "one of rate and angle");
  if (rate.value && rate.constant) m_.prescribe(joint, rate.value(0));
  else if (rate.value) m_.prescribe(joint, rate.value, {}, rate.slope);
  else if (angle.value && angle.constant) m_.prescribe(joint, angle.slope(0), angle.value);
  else if (angle.value) m_.prescribe(joint, angle.slope, angle.value);
  else m_.prescribe(joint, range);
}
// A formula is not kept between limits.
void FileParts::no_range(const toml::table& table) {
  for (const char* key : {"least", "most"})
    if (const Node* node = table.get(key))
      read_.toml.wrong(*node, key, "none beside a formula, which may say min(max(...)) itself");
}
// A motor or a prescribed joint with none of these is an input.
bool FileParts::is_input(const toml::table& table, std::initializer_list<const char*> keys) {
  return std::none_of(keys.begin(), keys.end(),
                      [&](const char* key) { return table.contains(key); });
}
void FileParts::states() {
  tables("state", [&](const toml::table& table) {
    std::string name;
    StateOptions o;
    const auto rate = [&](const Node& node, const std::string& key) {
      if (!node.is_string() && !node.is_number())
        return read_.toml.wrong(node, key, "a number or a formula");
      o.rate = read_.formulas.text(node);
    };
    read_.entries(table,
                  {{"name", read_.read(name)}, {"rate", rate}, {"unit", read_.read(o.unit)}});
    for (const auto& [constant, value] : read_.formulas.constants())
      o.constants[constant] = {value};
    m_.state(name, o);
  });
  const auto time = [&](const std::string& kind, const std::string& key) {
    tables(kind, [&](const toml::table& table) {
      if (const Node* node = table.get(key); node != nullptr && node->is_string())
        m_.time(read_.formulas.text(*node));
    });
  };
  time("wall", "distance");
  time("coupling", "formula");
  time("coupling", "rates");
}

}  // namespace hamel::mechanisms
