#include <hamel/systems/mechanisms/urdf/urdf_mechanism.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/toml_reader.hpp>
#include <hamel/framework/io/visible.hpp>
#include <hamel/systems/mechanisms/urdf/urdf_bodies.hpp>
#include <hamel/systems/mechanisms/urdf/urdf_joints.hpp>
#include <hamel/systems/mechanisms/urdf/urdf_shapes.hpp>
#include <hamel/systems/mechanisms/urdf/urdf_wheels.hpp>

namespace hamel::mechanisms {
namespace {

class Writer {
 public:
  Writer(Robot robot, std::string path, const NameOptions& options)
      : robot_(std::move(robot)), path_(std::move(path)), options_(options) {}

  FileFormat::Converted convert() {
    find_root();
    weld_joints(robot_, values_of("weld"), values_of("weld-all-but"), path_, mistakes_, notes_);
    keep_friction(robot_, values_of("joint-friction"), path_, mistakes_);
    hang_massless_root();
    check_masses();
    check_mimics();
    weld_all();
    wheels_ = find_wheels(robot_, values_of("wheel"), path_, mistakes_, notes_);
    level_wheels(robot_, wheels_, path_, mistakes_, notes_);
    driven_ = driven_joints(robot_, wheels_, values_of("motor"), path_, mistakes_, notes_);
    if (!mistakes_.empty()) throw ConfigError(mistakes_);
    raise();
    note_wheels();
    const RobotBodies bodies(robot_, root_ == "world");
    if (bodies.bodies.empty())
      throw ConfigError(
          {path_ + ": nothing moves: its link 'world' is the ground, and it has no other"});
    note_rest(bodies);
    FileFormat::Converted out;
    out.toml = fmt::format("# Of {}, written by hamel.\nname = {}\nredundant = \"drop\"\n",
                           toml_string(path_), toml_string(robot_.name));
    table("body", bodies.bodies, out.toml);
    table("joint", joints(bodies), out.toml);
    write_wheels(bodies, out.toml);
    table("motor", motors(), out.toml);
    table("coupling", couplings(), out.toml);
    for (std::string& note : notes_) {
      std::ranges::replace(note, '\n', ' ');
      note = visible(note);
      out.toml += "# " + note + "\n";
      out.notes.push_back(path_ + ": " + note);
    }
    return out;
  }

 private:
  void wrong(const std::string& what) { mistakes_.push_back(path_ + ": " + what); }
  std::vector<std::string> values_of(const std::string& option) const {
    const auto it = options_.find(option);
    return it == options_.end() ? std::vector<std::string>() : it->second;
  }

  void find_root() {
    const std::vector<std::string> given = values_of("root");
    const bool of_world = robot_.links.front().name == "world";
    if (of_world) root_ = "world";
    if (given.empty()) return;
    const std::vector<std::string> known = {"planar", "free", "fixed"};
    if (of_world)
      wrong(fmt::format("root: got '{}', but its root link 'world' is the ground", given.back()));
    else if (std::ranges::find(known, given.back()) == known.end())
      wrong(unknown_name("root", given.back(), known));
    root_ = given.back();
    robot_.root_free = root_ == "free";
  }

  // A root without mass cannot move on its own: a rail, a stand, the flange of an arm.
  void hang_massless_root() {
    if (root_ != "planar" || !values_of("root").empty() || !values_of("wheel").empty()) return;
    std::vector<bool> of_root(robot_.links.size(), true);
    for (int i = 0; i < robot_.count(); ++i) {
      const RobotLink& l = robot_.link(i);
      const auto at = static_cast<size_t>(i);
      of_root[at] = i == 0 || (of_root[static_cast<size_t>(l.parent)] && !l.joint.moves());
      if (of_root[at] && l.mass > 0) return;
    }
    root_ = "fixed";
    note("the root has no mass and is fixed to the ground (--root planar or free)",
         {robot_.links.front().name});
  }

  // Refuses joints that move no mass, and hinges that turn no moment of inertia.
  void check_masses() {
    for (int i = 0; i < robot_.count(); ++i) {
      const RobotLink& l = robot_.link(i);
      const bool moves = i == 0 ? root_ == "planar" || root_ == "free" : l.joint.moves();
      const auto [mass, moment] = carried_by(i);
      const bool turns = i > 0 && l.joint.kind == "hinge";
      if (!moves || (mass > 0 && (!turns || moment != 0))) continue;
      wrong(fmt::format(
          "link '{}': it and all that it carries have no {}: give it an <inertial> "
          "with mass and inertia{}",
          l.name, mass > 0 ? "moment of inertia about joint '" + l.joint.name + "'" : "mass",
          i == 0 ? "" : ", or make the joint rigid: --weld " + l.joint.name));
    }
  }
  // Mass of a link and of all that hangs on it, and their moment of inertia about its joint's axis.
  std::pair<double, double> carried_by(int i) const {
    const RobotJoint& joint = robot_.link(i).joint;
    double mass = 0, moment = 0;
    std::vector<bool> inside(robot_.links.size(), false);
    for (int k = i; k < robot_.count(); ++k) {
      const RobotLink& l = robot_.link(k);
      if (k != i && (l.parent < 0 || !inside[static_cast<size_t>(l.parent)])) continue;
      inside[static_cast<size_t>(k)] = true;
      mass += l.mass;
      moment += l.mass * (l.centre - joint.at).cross(joint.axis).squaredNorm() +
                joint.axis.dot(l.inertia * joint.axis);
    }
    return {mass, moment};
  }

  void check_mimics() {
    for (const RobotLink& l : robot_.links) {
      if (!l.joint.mimic) continue;
      const std::string& to = l.joint.mimic->to;
      const int other = robot_.link_of_joint(to);
      if (other < 0 || !robot_.link(other).joint.turns_or_slides()) {
        wrong(fmt::format("joint '{}': mimic: {}", l.joint.name,
                          unknown_name("joint", to, robot_.joint_names())));
      } else if (to == l.joint.name) {
        wrong(fmt::format("joint '{}': mimic: expected another joint, it follows itself", to));
      }
    }
  }
  void weld_all() {
    if (welds_.size() > 1) wrong(fmt::format("all of these: --weld {}", fmt::join(welds_, ",")));
  }

  // The ground at the lowest wheel.
  void raise() {
    double lowest = 0;
    for (size_t i = 0; i < wheels_.size(); ++i)
      lowest = i == 0 ? wheels_[i].lowest() : std::min(lowest, wheels_[i].lowest());
    const Vec3 up = -lowest * Vec3::UnitZ();
    for (RobotLink& l : robot_.links) {
      l.joint.at += up;
      l.centre += up;
      for (auto* shapes : {&l.visuals, &l.collisions})
        for (RobotShape& shape : *shapes) shape.pose.position += up;
    }
    for (RobotWheel& wheel : wheels_) wheel.centre += up;
    root_at_ = up;
  }

  std::vector<std::string> joints(const RobotBodies& bodies) const {
    std::vector<std::string> out;
    if (root_ != "world") {
      std::string name = "root";
      while (robot_.link_of_joint(name) >= 0) name += "_";
      out.push_back(fmt::format("name = {}, kind = \"{}\", child = {}, at = {}", toml_string(name),
                                root_ == "fixed" ? "weld" : root_, bodies.name_of(0),
                                spelled(root_at_)));
    }
    for (int i = 1; i < robot_.count(); ++i) {
      const RobotJoint& joint = robot_.link(i).joint;
      const std::string parent = bodies.name_of(robot_.link(i).parent), child = bodies.name_of(i);
      if (parent == child) continue;
      std::string line =
          fmt::format("name = {}, kind = \"{}\", parent = {}, child = {}, at = {}",
                      toml_string(joint.name), joint.kind, parent, child, spelled(joint.at));
      if (joint.moves() && joint.kind != "free") line += ", axis = " + spelled(joint.axis);
      if (joint.damping != 0) line += ", damping = " + spelled(joint.damping);
      if (joint.rubs) line += ", friction = " + spelled(joint.friction);
      out.push_back(line);
    }
    out.insert(out.end(), bodies.welds.begin(), bodies.welds.end());
    return out;
  }

  std::vector<std::string> motors() const {
    std::vector<std::string> out;
    for (const int i : driven_) {
      const RobotJoint& joint = robot_.link(i).joint;
      std::string line = "joint = " + toml_string(joint.name);
      if (const double most = joint.effort.value_or(0); most > 0)
        line += fmt::format(", least = {}, most = {}", spelled(-most), spelled(most));
      out.push_back(line);
    }
    return out;
  }

  // joint = ratio * to + offset.
  std::vector<std::string> couplings() const {
    std::vector<std::string> out;
    for (const RobotLink& l : robot_.links)
      if (l.joint.mimic)
        out.push_back(fmt::format("name = {}, joint = {}, to = {}, ratio = {}, offset = {}",
                                  toml_string(l.joint.name + "_mimic"), toml_string(l.joint.name),
                                  toml_string(l.joint.mimic->to), spelled(l.joint.mimic->ratio),
                                  spelled(l.joint.mimic->offset)));
    return out;
  }

  void write_wheels(const RobotBodies& bodies, std::string& out) const {
    using Kind = RobotWheel::Kind;
    std::vector<std::string> wheels, balls, rollers;
    for (const RobotWheel& w : wheels_) {
      std::string line = fmt::format("body = {}, at = {}, radius = {}", bodies.name_of(w.link),
                                     spelled(w.centre), spelled(w.radius));
      if (w.kind != Kind::ball) line += ", axle = " + spelled(w.axle);
      const bool rolls = w.kind == Kind::omni || w.kind == Kind::mecanum;
      if (rolls) line += ", angle = " + spelled(w.angle);
      if (w.friction) line += ", friction = " + spelled(*w.friction);
      (w.kind == Kind::ball ? balls : rolls ? rollers : wheels).push_back(line);
    }
    table("wheel", wheels, out);
    table("roller", rollers, out);
    table("ball", balls, out);
  }
  static void table(const std::string& kind, const std::vector<std::string>& entries,
                    std::string& out) {
    if (entries.empty()) return;
    out += kind + " = [\n";
    for (const std::string& entry : entries) out += "  { " + entry + " },\n";
    out += "]\n";
  }

  // ---- notes on what the mechanism leaves out -------------------------------------------------

  void note(const std::string& what, const std::vector<std::string>& names) {
    if (!names.empty()) notes_.push_back(fmt::format("{}: {}", what, quoted(names)));
  }
  void note_wheels() {
    using Kind = RobotWheel::Kind;
    std::vector<std::string> ahead_left;
    for (const RobotWheel& w : wheels_)
      if (w.kind == Kind::mecanum && w.angle < 0) ahead_left.push_back(robot_.link(w.link).name);
    note(
        "mecanum wheels with rollers at a negative angle, the others at a positive one "
        "(--wheel LINK:mecanum:angle=a sets it)",
        ahead_left);
    if (!wheels_.empty() || (root_ != "planar" && root_ != "free")) return;
    std::string text = fmt::format("no --wheel is given: nothing {}: {}",
                                   root_ == "planar" ? "rolls on the ground, and the root slides "
                                                       "on it freely"
                                                     : "touches the ground, and the root falls",
                                   quoted({robot_.links.front().name}));
    std::vector<std::string> names;
    for (const RobotWheel& w : wheels_by_shape(robot_)) names.push_back(robot_.link(w.link).name);
    if (!names.empty())
      text += "; these look like wheels, --wheel auto takes them: " + quoted(names);
    else if (const auto others = wheels_by_joint(robot_); !others.empty())
      text += fmt::format("; these may be wheels: --wheel {}", fmt::join(others, " --wheel "));
    notes_.push_back(text);
  }
  void note_rest(const RobotBodies& bodies) {
    std::vector<std::string> limited, friction, idle;
    for (const RobotLink& l : robot_.links) {
      if (l.joint.limited) limited.push_back(l.joint.name);
      if (l.joint.friction != 0 && !l.joint.rubs) friction.push_back(l.joint.name);
      if (l.joint.idle) idle.push_back(l.joint.name);
    }
    note("limits of position and velocity are not kept", limited);
    note("friction is left out (--joint-friction keeps it), damping is kept", friction);
    note("damping, friction and limits of fixed joints mean nothing and are left out", idle);
    note("a link 'ground' goes by another name, as the ground has this one", bodies.renamed);
    note("angles within 0.002 rad of a right angle are taken as that", robot_.rounded);
    note("macros of xacro are taken out, or replaced by their defaults", robot_.cleaned);
    note("meshes are not drawn", bodies.undrawn);
    note("boxes that are turned against the axes are not drawn", bodies.turned);
  }

  Robot robot_;
  std::string path_;
  const NameOptions& options_;
  std::string root_ = "planar";  // "world": the root link is the ground
  Vec3 root_at_ = Vec3::Zero();
  std::vector<RobotWheel> wheels_;
  std::vector<int> driven_;  // links
  std::vector<std::string> notes_, mistakes_;
  std::vector<std::string> welds_;  // joints that would be no mistake if they were rigid
};

}  // namespace

FileFormat::Converted mechanism_of(Robot robot, const std::string& path,
                                   const NameOptions& options) {
  return Writer(std::move(robot), path, options).convert();
}

}  // namespace hamel::mechanisms
