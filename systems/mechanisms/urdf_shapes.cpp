#include <hamel/systems/mechanisms/urdf_shapes.hpp>

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

}  // namespace

bool is_called_wheel(const RobotLink& link) {
  std::string name = link.name;
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name.find("wheel") != std::string::npos;
}

std::vector<RobotWheel> wheels_by_shape(const Robot& robot) {
  std::vector<RobotWheel> all;
  std::vector<std::string> unused;
  for (int i = 1; i < robot.count(); ++i) {
    WheelWords words{robot.link(i).name};
    const RobotShape* shape = robot.link(i).round_shape();
    if (shape == nullptr) continue;
    if (shape->kind == RobotShape::Kind::sphere) words.kind = "wheel";
    const auto wheel = wheel_of(robot, i, words, unused);
    if (!wheel || wheel->turns < 0 || !robot.link(wheel->turns).joint.endless) continue;
    if (std::abs(wheel->axle[2]) < kLevel) all.push_back(*wheel);
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
