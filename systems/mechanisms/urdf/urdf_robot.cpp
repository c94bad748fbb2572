#include <hamel/systems/mechanisms/urdf/urdf_robot.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>
#include <set>
#include <string>
#include <string_view>

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/systems/mechanisms/urdf/urdf_text.hpp>

namespace hamel::mechanisms {
namespace {

constexpr double kRightAngle = 2e-3;  // rad: 1.57 and 3.14 mean right angles
constexpr double kSameAngle = 1e-9;   // rad, without notice
constexpr double kQuarter = std::numbers::pi / 2;

// The errors of urdfdom, which reports them through console_bridge.
class Messages : public console_bridge::OutputHandler {
 public:
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) errors.push_back(text);
  }
  std::vector<std::string> errors;
};

// Cures of mistakes that public descriptions have, by words of urdfdom's message.
struct UrdfCure {
  std::string_view words, cure;
};
constexpr UrdfCure kUrdfCures[] = {
    {"Unable to parse component", "separate numbers by blanks, without commas"},
    {"without limits", "add <limit effort=\"0\" velocity=\"0\"/> to the joint"},
    {"inertia element missing", "write all of ixx, ixy, ixz, iyy, iyz, izz"},
    {"Unknown geometry type", "box, cylinder, sphere and mesh are read: leave the element out"},
};

std::string with_cure(const std::string& error) {
  for (const UrdfCure& known : kUrdfCures)
    if (error.find(known.words) != std::string::npos)
      return fmt::format("{}; {}", error, known.cure);
  return error;
}

urdf::ModelInterfaceSharedPtr parse(const std::string& text, const std::string& path) {
  static std::mutex one_at_a_time;  // the handler is the process's
  const std::lock_guard lock(one_at_a_time);
  Messages messages;
  console_bridge::useOutputHandler(&messages);
  urdf::ModelInterfaceSharedPtr out;
  try {
    out = urdf::parseURDF(text);
  } catch (const std::exception& error) {
    messages.errors.emplace_back(error.what());
  }
  console_bridge::restorePreviousOutputHandler();
  if (out != nullptr && messages.errors.empty()) return out;
  std::vector<std::string> mistakes;
  for (const std::string& error : messages.errors)
    mistakes.push_back(fmt::format("{}: not a robot as URDF has it: {}", path, with_cure(error)));
  if (mistakes.empty()) mistakes.push_back(path + ": not a robot as URDF has it");
  throw ConfigError(mistakes);
}

Vec3 vec(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Mat<3, 3> matrix_of(const urdf::Rotation& q) {
  const double x = q.x, y = q.y, z = q.z, w = q.w;
  return Mat<3, 3>{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                   {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                   {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
}

// The rotation of roll, pitch and yaw, angles near multiples of a right angle taken as these.
Mat<3, 3> rounded(const urdf::Rotation& q) {
  std::array<double, 3> angles{};
  q.getRPY(angles[0], angles[1], angles[2]);
  Mat<3, 3> out = Mat<3, 3>::Identity();
  for (int i = 0; i < 3; ++i) {
    const double angle = angles[static_cast<size_t>(i)], count = std::round(angle / kQuarter);
    const double off = std::abs(angle - count * kQuarter);
    double c = std::cos(angle), s = std::sin(angle);
    if (off < (count == 0 ? 1e-12 : kRightAngle)) {
      c = std::round(c);
      s = std::round(s);
    }
    Mat<3, 3> about = Mat<3, 3>::Identity();
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    about(j, j) = about(k, k) = c;
    about(j, k) = -s;
    about(k, j) = s;
    out = (about * out).eval();
  }
  return out;
}

class Reader {
 public:
  Reader(const std::string& text, std::string path)
      : path_(std::move(path)),
        text_(read_urdf_text(text, path_)),
        model_(parse(text_.text, path_)) {}

  Robot read() {
    robot_.name = model_->getName();
    robot_.cleaned = text_.cleaned;
    struct Next {
      urdf::LinkConstSharedPtr link;
      int parent;
      Rigid pose;
    };
    std::vector<Next> waiting = {{model_->getRoot(), -1, {}}};
    std::set<std::string> seen;
    while (!waiting.empty()) {
      const Next next = waiting.back();
      waiting.pop_back();
      if (!seen.insert(next.link->name).second) {
        mistakes_.push_back(fmt::format("{}: link '{}': hangs on two joints, expected a tree",
                                        path_, next.link->name));
        continue;
      }
      Rigid pose = next.pose;
      RobotLink& link = robot_.links.emplace_back();
      link.name = next.link->name;
      link.parent = next.parent;
      if (next.parent >= 0) {
        const urdf::Joint& joint = *next.link->parent_joint;
        pose = pose * rigid(joint.parent_to_joint_origin_transform, "joint", joint.name);
        link.joint = joint_of(joint, pose);
      }
      link.origin = pose.position;
      fill(link, *next.link, pose);
      const auto index = static_cast<int>(robot_.links.size()) - 1;
      const auto& children = next.link->child_links;
      for (size_t i = children.size(); i > 0; --i)
        waiting.push_back({children[i - 1], index, pose});
    }
    for (const auto& [name, link] : model_->links_)
      if (!seen.contains(name))
        mistakes_.push_back(fmt::format("{}: link '{}': does not hang on the root link '{}'", path_,
                                        name, model_->getRoot()->name));
    if (!mistakes_.empty()) throw ConfigError(mistakes_);
    return std::move(robot_);
  }

 private:
  void wrong(const std::string& kind, const std::string& name, const std::string& what) {
    mistakes_.push_back(fmt::format("{}: {} '{}': {}", path_, kind, name, what));
  }

  Rigid rigid(const urdf::Pose& pose, const std::string& kind, const std::string& name) {
    const Mat<3, 3> exact = matrix_of(pose.rotation), near = rounded(pose.rotation);
    const double off = (exact - near).norm();
    if (off > 2 * kRightAngle) return {exact, vec(pose.position)};
    if (off > kSameAngle) robot_.rounded.push_back(fmt::format("{} '{}'", kind, name));
    return {near, vec(pose.position)};
  }

  RobotJoint joint_of(const urdf::Joint& joint, const Rigid& pose) {
    RobotJoint out;
    out.name = joint.name;
    out.at = pose.position;
    out.axis = pose.rotation * vec(joint.axis);
    switch (joint.type) {
      case urdf::Joint::REVOLUTE:
      case urdf::Joint::CONTINUOUS: out.kind = "hinge"; break;
      case urdf::Joint::PRISMATIC: out.kind = "slider"; break;
      case urdf::Joint::PLANAR: out.kind = "planar"; break;
      case urdf::Joint::FLOATING: out.kind = "free"; break;
      case urdf::Joint::FIXED: out.kind = "weld"; break;
      default: wrong("joint", joint.name, "of no type that a mechanism has");
    }
    const bool has_axis = out.kind != "weld" && out.kind != "free";
    if (has_axis && !(out.axis.norm() > 0))
      wrong("joint", joint.name, "axis: got 0 0 0, expected a direction");
    else if (has_axis) out.axis.normalize();
    if (joint.mimic != nullptr && out.turns_or_slides())
      out.mimic = {joint.mimic->joint_name, joint.mimic->multiplier, joint.mimic->offset};
    out.driven = text_.driven.contains(joint.name);
    if (!out.moves()) {
      out.idle = joint.dynamics != nullptr || joint.limits != nullptr;
      return out;
    }
    if (joint.dynamics != nullptr) {
      out.damping = joint.dynamics->damping;
      out.friction = joint.dynamics->friction;
      if (out.damping != 0 && !out.turns_or_slides())
        wrong("joint", joint.name,
              "damping: expected a revolute, continuous or prismatic joint, got " +
                  std::string(out.kind == "free" ? "a floating" : "a planar") +
                  " one: take its <dynamics> out");
    }
    if (joint.limits != nullptr) {
      out.effort = joint.limits->effort;
      out.limited = joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::PRISMATIC;
    }
    out.endless =
        out.kind == "hinge" &&
        (!out.limited || joint.limits->upper - joint.limits->lower > 2 * std::numbers::pi);
    return out;
  }

  void fill(RobotLink& link, const urdf::Link& from, const Rigid& pose) {
    if (from.inertial != nullptr) {
      const urdf::Inertial& i = *from.inertial;
      const Rigid frame = pose * rigid(i.origin, "inertial of link", link.name);
      link.mass = i.mass;
      link.centre = frame.position;
      const Mat<3, 3> moments{{i.ixx, i.ixy, i.ixz}, {i.ixy, i.iyy, i.iyz}, {i.ixz, i.iyz, i.izz}};
      link.inertia = frame.rotation * moments * frame.rotation.transpose();
      if (!(link.mass >= 0))
        wrong("link", link.name, fmt::format("mass: got {}, expected at least 0", link.mass));
    }
    for (const auto& visual : from.visual_array)
      if (visual->geometry != nullptr)
        link.visuals.push_back(
            shape_of(*visual->geometry, pose * rigid(visual->origin, "visual of link", link.name)));
    for (const auto& collision : from.collision_array)
      if (collision->geometry != nullptr)
        link.collisions.push_back(shape_of(
            *collision->geometry, pose * rigid(collision->origin, "collision of link", link.name)));
    if (from.inertial == nullptr) {
      const auto& shapes = link.visuals.empty() ? link.collisions : link.visuals;
      link.centre = shapes.empty() ? pose.position : shapes.front().pose.position;
    }
  }

  static RobotShape shape_of(const urdf::Geometry& geometry, const Rigid& pose) {
    using Kind = RobotShape::Kind;
    switch (geometry.type) {  // by their tags: no run-time types across the library
      case urdf::Geometry::BOX:
        return {Kind::box, pose, vec(static_cast<const urdf::Box&>(geometry).dim)};
      case urdf::Geometry::CYLINDER: {
        const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
        return {Kind::cylinder, pose, {cylinder.radius, cylinder.length, 0}};
      }
      case urdf::Geometry::SPHERE:
        return {Kind::sphere, pose, {static_cast<const urdf::Sphere&>(geometry).radius, 0, 0}};
      default: return {Kind::mesh, pose, Vec3::Zero()};
    }
  }

  std::string path_;
  UrdfText text_;
  urdf::ModelInterfaceSharedPtr model_;
  Robot robot_;
  std::vector<std::string> mistakes_;
};

}  // namespace

const RobotShape* RobotLink::round_shape() const {
  for (const auto* shapes : {&collisions, &visuals})
    for (const RobotShape& shape : *shapes)
      if (shape.round()) return &shape;
  return nullptr;
}

std::vector<std::string> Robot::link_names() const {
  std::vector<std::string> out;
  for (const RobotLink& l : links) out.push_back(l.name);
  return out;
}

std::vector<std::string> Robot::joint_names() const {
  std::vector<std::string> out;
  for (const RobotLink& l : links)
    if (l.parent >= 0 && l.joint.moves()) out.push_back(l.joint.name);
  return out;
}

int Robot::link_of_joint(const std::string& of) const {
  for (int i = 0; i < count(); ++i)
    if (link(i).parent >= 0 && link(i).joint.name == of) return i;
  return -1;
}

Robot read_robot(const std::string& text, const std::string& path) {
  return Reader(text, path).read();
}

}  // namespace hamel::mechanisms
