#include <hamel/systems/mechanisms/urdf_wheels.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>

namespace hamel::mechanisms {
namespace {

constexpr double kParallel = 2e-3;  // rad

bool is_mesh(const RobotShape& shape) { return shape.kind == RobotShape::Kind::mesh; }

const RobotShape* round_shape(const RobotLink& link) {
  for (const auto* shapes : {&link.collisions, &link.visuals})
    for (const RobotShape& shape : *shapes)
      if (shape.round()) return &shape;
  return nullptr;
}

// The joint that moves this link, across welds; null where it is a part of the root.
const RobotJoint* carrying_joint(const Robot& robot, int i) {
  while (true) {
    const RobotLink& link = robot.links[static_cast<size_t>(i)];
    if (link.parent < 0) return nullptr;
    if (link.joint.moves()) return &link.joint;
    i = link.parent;
  }
}

class Finder {
 public:
  Finder(const Robot& robot, const std::string& path, std::vector<std::string>& mistakes)
      : robot_(robot), path_(path), mistakes_(mistakes) {
    for (const RobotLink& link : robot.links) names_.push_back(link.name);
  }

  void add(const std::string& given) {
    std::string name = given, kind;
    const size_t colon = given.rfind(':');
    if (!knows(given) && colon != std::string::npos) {
      name = given.substr(0, colon);
      kind = given.substr(colon + 1);
      if (kind != "wheel" && kind != "ball")
        return wrong(given, unknown_name("kind of wheel", kind, {"wheel", "ball"}));
    }
    if (!knows(name)) return wrong(given, unknown_name("link", name, names_));
    const auto index = static_cast<int>(std::ranges::find(names_, name) - names_.begin());
    const auto same = [&](const RobotWheel& wheel) { return wheel.link == index; };
    if (std::ranges::any_of(wheels, same)) return wrong(name, "named twice");
    add(index, name, kind);
  }

  std::vector<RobotWheel> wheels;

 private:
  bool knows(const std::string& name) const {
    return std::ranges::find(names_, name) != names_.end();
  }
  void wrong(const std::string& wheel, const std::string& what) {
    mistakes_.push_back(fmt::format("{}: wheel '{}': {}", path_, wheel, what));
  }

  void add(int index, const std::string& name, const std::string& kind) {
    const RobotLink& link = robot_.links[static_cast<size_t>(index)];
    const RobotShape* shape = round_shape(link);
    if (shape == nullptr) return no_round_shape(link);
    if (!(shape->radius() > 0))
      return wrong(name, fmt::format("radius: got {}, expected above 0", shape->radius()));
    const RobotJoint* joint = carrying_joint(robot_, index);
    if (joint == nullptr)
      return wrong(name, fmt::format("fixed to the root link '{}', it cannot roll; leave it out: a "
                                     "root that is planar needs no support, which then slides "
                                     "without friction",
                                     robot_.links.front().name));
    const bool sphere = shape->kind == RobotShape::Kind::sphere;
    RobotWheel wheel;
    wheel.link = index;
    wheel.ball = kind.empty() ? sphere : kind == "ball";
    wheel.radius = shape->radius();
    wheel.centre = shape->pose.position;
    if (wheel.ball && !sphere) return wrong(name, "a ball is a sphere, got a cylinder");
    const bool hinge = joint->kind == "hinge";
    if (sphere && !wheel.ball) {
      if (!hinge)
        return wrong(name, fmt::format("a sphere as a wheel turns about a hinge, but joint '{}' is "
                                       "none",
                                       joint->name));
      wheel.axle = joint->axis;
    } else if (!sphere) {
      const bool same = hinge && joint->axis.cross(shape->axis()).norm() < kParallel;
      wheel.axle = same ? joint->axis : shape->axis();
    }
    if (wheel.axle[1] < 0) wheel.axle = (-wheel.axle).eval();  // to the left
    wheels.push_back(wheel);
  }
  void no_round_shape(const RobotLink& link) {
    const bool mesh =
        std::ranges::any_of(link.collisions, is_mesh) || std::ranges::any_of(link.visuals, is_mesh);
    wrong(link.name, fmt::format("{}; give it a <collision> with a cylinder or a sphere, whose "
                                 "radius is that of the wheel",
                                 mesh ? "its geometry is a mesh" : "it has no cylinder or sphere"));
  }

  const Robot& robot_;
  const std::string& path_;
  std::vector<std::string>& mistakes_;
  std::vector<std::string> names_;
};

}  // namespace

double RobotWheel::lowest() const {
  return centre[2] - radius * (ball ? 1 : std::sqrt(std::max(0.0, 1 - axle[2] * axle[2])));
}

std::vector<RobotWheel> find_wheels(const Robot& robot, const std::vector<std::string>& names,
                                    const std::string& path, std::vector<std::string>& mistakes) {
  Finder finder(robot, path, mistakes);
  for (const std::string& name : names) finder.add(name);
  return std::move(finder.wheels);
}

}  // namespace hamel::mechanisms
