#include <hamel/systems/mechanisms/urdf/urdf_joints.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/inputs.hpp>

namespace hamel::mechanisms {
namespace {

constexpr double kUpright = 0.9;  // at least, of the third component of a swivel
constexpr double kTrail = 0.1;    // of the radius: a wheel that is steered has less

void weld_joint(RobotJoint& joint) {
  const Vec3 at = joint.at, axis = joint.axis;
  joint = {joint.name, "weld", at, axis};
  joint.welded = true;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

class Motors {
 public:
  Motors(const Robot& robot, const std::vector<RobotWheel>& wheels)
      : robot_(robot), wheels_(wheels) {}

  std::vector<int> chosen() {
    std::vector<int> of_wheels;
    for (const RobotWheel& wheel : wheels_)
      if (wheel.turns >= 0 && may(wheel.turns) && !is_caster(wheel))
        of_wheels.push_back(wheel.turns);
    const auto marks = [&](int i) { return marked(i); };
    if (std::ranges::any_of(of_wheels, marks))
      std::erase_if(of_wheels, [&](int i) { return !marked(i); });
    for (const int i : of_wheels) take(i);
    bool any = false;
    for (int i = 0; i < robot_.count(); ++i) {
      if (!marked(i)) continue;
      any = true;
      take(i);
    }
    if (wheels_.empty() && !any)
      for (int i = 0; i < robot_.count(); ++i)
        if (may(i)) take(i);
    return out_;
  }

 private:
  const RobotJoint& joint(int i) const { return robot_.link(i).joint; }
  // May it have a motor, and is it said to have one?
  bool may(int i) const {
    return robot_.link(i).parent >= 0 && joint(i).turns_or_slides() && !joint(i).mimic &&
           !(joint(i).effort && !(*joint(i).effort > 0) && !joint(i).driven);
  }
  bool marked(int i) const { return may(i) && (joint(i).driven || joint(i).effort); }
  void take(int i) {
    if (std::ranges::find(out_, i) == out_.end()) out_.push_back(i);
  }

  bool is_caster(const RobotWheel& wheel) const {
    if (marked(wheel.turns)) return false;
    for (int i = robot_.link(wheel.turns).parent; i > 0; i = robot_.link(i).parent) {
      const RobotJoint& swivel = joint(i);
      if (swivel.kind != "hinge" || std::abs(swivel.axis[2]) < kUpright) continue;
      const Vec3 arm = (wheel.centre - swivel.at).cross(swivel.axis);
      return !marked(i) && arm.norm() > kTrail * wheel.radius;
    }
    return false;
  }

  const Robot& robot_;
  const std::vector<RobotWheel>& wheels_;
  std::vector<int> out_;
};

}  // namespace

void keep_friction(Robot& robot, const std::vector<std::string>& names, const std::string& path,
                   std::vector<std::string>& mistakes) {
  std::vector<std::string> known = robot.joint_names();
  known.emplace_back("all");
  for (const std::string& name : names) {
    const int i = robot.link_of_joint(name);
    const auto wrong = [&](const std::string& what) {
      mistakes.push_back(path + ": --joint-friction: " + what);
    };
    if (name == "all" && i < 0) {
      for (RobotLink& link : robot.links)
        link.joint.rubs = link.joint.turns_or_slides() && link.joint.friction != 0;
    } else if (i < 0) {
      wrong(unknown_name("joint", name, known));
    } else if (RobotJoint& joint = robot.link(i).joint;
               !joint.turns_or_slides() || joint.friction == 0) {
      wrong(
          fmt::format("joint '{}' has {}, expected <dynamics friction=\"...\"> of a revolute, "
                      "continuous or prismatic joint",
                      name, joint.friction == 0 ? "none" : "friction that means nothing"));
    } else {
      joint.rubs = true;
    }
  }
}

void weld_joints(Robot& robot, const std::vector<std::string>& weld,
                 const std::vector<std::string>& all_but, const std::string& path,
                 std::vector<std::string>& mistakes, std::vector<std::string>& notes) {
  const auto wrong = [&](const std::string& what) { mistakes.push_back(path + ": " + what); };
  if (!weld.empty() && !all_but.empty())
    return wrong("--weld and --weld-all-but are inconsistent: give one of them");
  const std::vector<std::string> known = robot.joint_names();
  for (const std::string& name : weld) {
    const int i = robot.link_of_joint(name);
    if (i < 0) wrong("--weld: " + unknown_name("joint", name, known));
    else if (robot.link(i).joint.moves()) weld_joint(robot.link(i).joint);
  }
  for (const std::string& name : all_but)
    if (!contains(known, name)) wrong("--weld-all-but: " + unknown_name("joint", name, known));
  for (RobotLink& link : robot.links)
    if (!all_but.empty() && link.parent >= 0 && link.joint.moves() &&
        !contains(all_but, link.joint.name))
      weld_joint(link.joint);
  std::vector<std::string> followers;
  for (bool more = true; more;) {
    more = false;
    for (RobotLink& link : robot.links) {
      if (!link.joint.mimic || link.joint.welded) continue;
      const int to = robot.link_of_joint(link.joint.mimic->to);
      if (to < 0 || !robot.link(to).joint.welded) continue;
      followers.push_back(link.joint.name);
      weld_joint(link.joint);
      more = true;
    }
  }
  if (!followers.empty())
    notes.push_back("welded too, as they mimic a joint that is: " + quoted(followers));
}

std::vector<int> driven_joints(const Robot& robot, const std::vector<RobotWheel>& wheels,
                               const std::vector<std::string>& names, const std::string& path,
                               std::vector<std::string>& mistakes,
                               std::vector<std::string>& notes) {
  std::vector<std::string> known;
  for (const RobotLink& link : robot.links)
    if (link.parent >= 0 && link.joint.turns_or_slides()) known.push_back(link.joint.name);
  constexpr auto kMost = static_cast<size_t>(kMostInputs);
  std::vector<int> out;
  for (const std::string& name : names) {
    const int i = robot.link_of_joint(name);
    const bool twice = std::ranges::find(out, i) != out.end();
    if (!contains(known, name))
      mistakes.push_back(fmt::format("{}: --motor: {}", path, unknown_name("joint", name, known)));
    else if (twice) mistakes.push_back(fmt::format("{}: --motor: '{}' named twice", path, name));
    else out.push_back(i);
  }
  if (!names.empty()) {
    if (out.size() > kMost)
      mistakes.push_back(fmt::format("{}: --motor: got {} joints, a system has at most {} inputs",
                                     path, out.size(), kMost));
    return out;
  }
  out = Motors(robot, wheels).chosen();
  std::vector<std::string> without;
  for (size_t i = kMost; i < out.size(); ++i) without.push_back(robot.link(out[i]).joint.name);
  if (out.size() > kMost) out.resize(kMost);
  if (!without.empty())
    notes.push_back(
        fmt::format("no motor, as a system has at most {} inputs (--motor JOINT names "
                    "those that have one): {}",
                    kMost, quoted(without)));
  if (out.empty() && !known.empty())
    notes.push_back(fmt::format("no joint has a motor; --motor JOINT adds one: {}", quoted(known)));
  return out;
}

}  // namespace hamel::mechanisms
