#include <hamel/systems/mechanisms/urdf/urdf_shapes.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace hamel::mechanisms {
namespace {

constexpr double kLevel = 0.3;       // the most of the third component of a level axle
constexpr double kSameLevel = 0.02;  // m, of axles

double lowest_of(const RobotShape& shape) {
  using Kind = RobotShape::Kind;
  const double z = shape.pose.position[2];
  if (shape.kind == Kind::sphere) return z - shape.radius();
  if (shape.kind == Kind::box)
    return z - 0.5 * shape.pose.rotation.row(2).cwiseAbs().dot(shape.size.transpose());
  const double e = std::abs(shape.axis()[2]);  // of a cylinder
  return z - shape.radius() * std::sqrt(std::max(0.0, 1 - e * e)) - 0.5 * shape.size[1] * e;
}

// The lowest point of the shapes of known size.
double lowest_of(const Robot& robot) {
  double out = std::numeric_limits<double>::infinity();
  for (const RobotLink& link : robot.links)
    for (const auto* shapes : {&link.collisions, &link.visuals})
      for (const RobotShape& shape : *shapes)
        if (shape.kind != RobotShape::Kind::mesh) out = std::min(out, lowest_of(shape));
  return out;
}

// The hinge on which the fork of a wheel tips; null without one.
const RobotJoint* tipping_hinge(const Robot& robot, const RobotWheel& wheel) {
  const Vec3 way = wheel.axle.cross(Vec3::UnitZ()).normalized();
  for (int i = robot.link(wheel.turns).parent; i > 0; i = robot.link(i).parent) {
    const RobotJoint& joint = robot.link(i).joint;
    if (joint.endless && std::abs(joint.axis.dot(way)) > 1 - kLevel) return &joint;
  }
  return nullptr;
}

}  // namespace

bool is_called_wheel(const RobotLink& link) {
  std::string name = link.name;
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name.find("wheel") != std::string::npos;
}

std::vector<RobotWheel> wheels_by_shape(const Robot& robot, std::vector<std::string>* tipping) {
  std::vector<RobotWheel> all;
  std::vector<std::string> unused;
  for (int i = 1; i < robot.count(); ++i) {
    WheelWords words{robot.link(i).name};
    const RobotShape* shape = robot.link(i).round_shape();
    if (shape == nullptr) continue;
    if (shape->kind == RobotShape::Kind::sphere) words.kind = "wheel";
    const auto wheel = wheel_of(robot, i, words, unused);
    if (!wheel || wheel->turns < 0 || !robot.link(wheel->turns).joint.endless) continue;
    if (!(std::abs(wheel->axle[2]) < kLevel)) continue;
    const RobotJoint* const hinge = tipping_hinge(robot, *wheel);
    if (hinge == nullptr) all.push_back(*wheel);
    else if (tipping != nullptr)
      tipping->push_back(fmt::format(
          "'{}' is left out, since the hinge '{}' of its fork is along the way that it rolls, as "
          "one without <axis> is: the ground holds it; a swivel is upright, <axis xyz=\"0 0 1\"/>",
          robot.link(i).name, hinge->name));
  }
  if (all.empty()) return all;
  const double lowest =
      std::ranges::min_element(all, {}, [](const RobotWheel& w) { return w.lowest(); })->lowest();
  const double all_lowest = lowest_of(robot);
  std::erase_if(all, [&](const RobotWheel& w) {
    return w.lowest() > lowest + kNearHeight * w.radius || lowest > all_lowest + w.radius;
  });
  return all;
}

std::vector<std::string> fixed_wheels(const Robot& robot) {
  const auto turns = [&](const RobotLink& link) {
    const RobotLink* one = &link;
    while (one->parent >= 0 && !one->joint.moves()) one = &robot.link(one->parent);
    return one->parent >= 0;
  };
  std::vector<std::string> out;
  for (const RobotLink& link : robot.links)
    if (is_called_wheel(link) && !turns(link)) out.push_back(link.name);
  return out;
}

std::vector<std::string> wheels_by_joint(const Robot& robot, bool called) {
  std::vector<const RobotLink*> all;
  double lowest = std::numeric_limits<double>::infinity();
  for (const RobotLink& link : robot.links) {
    if (link.parent < 0 || !link.joint.endless || link.round_shape() != nullptr) continue;
    if (std::abs(link.joint.axis[2]) > kLevel) continue;
    all.push_back(&link);
    lowest = std::min(lowest, link.origin[2]);
  }
  const bool some =
      called || std::ranges::any_of(all, [](const RobotLink* l) { return is_called_wheel(*l); });
  std::vector<std::string> out;
  for (const RobotLink* link : all) {
    const double height = link->origin[2];
    if (some ? !is_called_wheel(*link) : height > lowest + kSameLevel) continue;
    out.push_back(height > 0 ? fmt::format("{}:radius={:.4g}", link->name, height)
                             : link->name + ":radius=0.1");
  }
  return out;
}

}  // namespace hamel::mechanisms
