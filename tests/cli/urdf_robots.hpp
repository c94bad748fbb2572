// Small robots in URDF, and what becomes of them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "program.hpp"

namespace hamel::test {

using Words = std::vector<std::string>;

class UrdfRobots : public CommandLine {
 protected:
  inline static const std::string kCylinder = R"(<cylinder radius="0.1" length="0.02"/>)";
  inline static const std::string kMesh = R"(<mesh filename="package://a/wheel.stl"/>)";
  inline static const std::string kSphere = R"(<sphere radius="0.1"/>)";

  static std::string inertial(double mass, const std::string& ixx = "0.01") {
    return "<inertial><mass value=\"" + std::to_string(mass) + "\"/><inertia ixx=\"" + ixx +
           "\" ixy=\"0\" ixz=\"0\" iyy=\"0.02\" iyz=\"0\" izz=\"0.015\"/></inertial>";
  }
  static std::string link(const std::string& name, const std::string& inside = inertial(1)) {
    return "<link name=\"" + name + "\">" + inside + "</link>";
  }
  static std::string joint(const std::string& kind, const std::string& name,
                           const std::string& parent, const std::string& child,
                           const std::string& at, const std::string& axis = "0 1 0",
                           const std::string& inside = "") {
    return "<joint name=\"" + name + "\" type=\"" + kind + "\"><origin xyz=\"" + at +
           "\"/><parent link=\"" + parent + "\"/><child link=\"" + child + "\"/><axis xyz=\"" +
           axis + "\"/>" + inside + "</joint>";
  }
  /// A wheel of radius 0.1 m on a hinge of the base.
  static std::string wheel(const std::string& name, const std::string& at,
                           const std::string& inside = "", const std::string& geometry = kCylinder,
                           const std::string& parent = "base") {
    return link(name, inertial(0.5) + "<collision><origin rpy=\"1.5707963267948966 0 0\"/>" +
                          "<geometry>" + geometry + "</geometry></collision>") +
           joint("continuous", name + "_axle", parent, name, at, "0 1 0", inside);
  }
  static std::string two_wheels(const std::string& geometry = kCylinder,
                                const std::string& inside = "") {
    return link("base", inertial(5)) + wheel("left", "0 0.2 0.1", inside, geometry) +
           wheel("right", "0 -0.2 0.1", inside, geometry);
  }
  std::string robot(const std::string& inside, const std::string& name = "robot.urdf") const {
    return write(name, "<robot name=\"r\">\n" + inside + "</robot>");
  }
  std::string toml(const Words& system) const {
    Words all = {"describe", "--toml"};
    all.insert(all.end(), system.begin(), system.end());
    const Outcome o = run(all);
    EXPECT_EQ(o.status, 0) << o.err;
    return o.out;
  }
  std::string mistake(const Words& system) const {
    Words all = {"run", "--until", "0.1", "--quiet"};
    all.insert(all.end(), system.begin(), system.end());
    const Outcome o = run(all);
    EXPECT_EQ(o.status, 2) << o.out;
    EXPECT_THAT(o.err, testing::Not(testing::HasSubstr("as TOML")));
    return o.err;
  }
  /// The columns of the last row, by name.
  std::map<std::string, double> end_of(const Words& system, const Words& more = {}) const {
    Words all = {"run", "--step", "0.01", "--until", "1", "--quiet", "-o", file("end.csv")};
    all.insert(all.end(), system.begin(), system.end());
    all.insert(all.end(), more.begin(), more.end());
    const Outcome o = run(all);
    EXPECT_EQ(o.status, 0) << o.err;
    std::map<std::string, double> out;
    const auto rows = lines(contents(file("end.csv")));
    const auto names = split(rows.at(0));
    std::string last;
    for (const std::string& row : rows)
      if (row[0] != '#') last = row;
    const auto values = split(last);
    for (size_t i = 0; i < names.size(); ++i) out[names[i]] = std::stod(values.at(i));
    return out;
  }
  /// Two systems end at the same state, of the columns that both have.
  void same_end(const Words& a, const Words& b, const Words& more = {}) const {
    const auto x = end_of(a, more), y = end_of(b, more);
    int compared = 0;
    for (const auto& [name, value] : x) {
      if (!y.contains(name) || name == "iterations" || name == "residual") continue;
      EXPECT_NEAR(value, y.at(name), 1e-10) << name;
      ++compared;
    }
    EXPECT_GT(compared, 8);
  }
  std::vector<std::string> motors(const Words& system) const {
    Words all = {"describe"};
    all.insert(all.end(), system.begin(), system.end());
    std::vector<std::string> out;
    const nlohmann::json description = answer(all);
    for (const nlohmann::json& input : description["inputs"]) {
      const auto name = input["name"].get<std::string>();
      out.push_back(name.substr(0, name.rfind('.')));
    }
    return out;
  }
};

}  // namespace hamel::test
