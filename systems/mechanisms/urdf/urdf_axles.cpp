// Wheel of a robot: its shape, its axle and the joint that lets it roll.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/urdf/urdf_wheels.hpp>

namespace hamel::mechanisms {
namespace {

using WheelKind = RobotWheel::Kind;

constexpr double kParallel = 2e-3;  // rad, without notice
constexpr double kAcross = 0.1;     // rad: an axle that leans so much is no axle of the joint
constexpr double kCentred = 1e-6;   // m, without notice
constexpr double kBeside = 0.25;    // of the radius: a wheel so far off the axis is not about it
constexpr double kVertical = 0.9;   // of the third component of a direction

WheelKind kind_of(const std::string& word, bool sphere) {
  if (word.empty()) return sphere ? WheelKind::ball : WheelKind::wheel;
  if (word == "ball") return WheelKind::ball;
  if (word == "omni") return WheelKind::omni;
  return word == "mecanum" ? WheelKind::mecanum : WheelKind::wheel;
}

Vec3 on_axis(const Vec3& point, const RobotJoint& joint) {
  return joint.at + (point - joint.at).dot(joint.axis) * joint.axis;
}

std::string in_words(const Vec3& v) {
  return fmt::format("({:.3g}, {:.3g}, {:.3g})", v[0] + 0.0, v[1] + 0.0, v[2] + 0.0);
}

class Axle {
 public:
  Axle(const Robot& robot, int link, const WheelWords& words, std::vector<std::string>& mistakes)
      : robot_(robot), index_(link), words_(words), mistakes_(mistakes) {}

  std::optional<RobotWheel> find() {
    const size_t before = mistakes_.size();
    find_shape();
    if (mistakes_.size() == before) find_joints();
    if (mistakes_.size() == before && wheel_.kind != WheelKind::ball) find_axle();
    if (words_.angle && wheel_.kind != WheelKind::mecanum && wheel_.kind != WheelKind::omni)
      wrong("angle: of the rollers of an omni or mecanum wheel, got it for neither");
    if (mistakes_.size() != before) return {};
    if (wheel_.axle[1] < 0) wheel_.axle = (-wheel_.axle).eval();  // to the left
    return wheel_;
  }

 private:
  const RobotLink& link() const { return robot_.link(index_); }
  void wrong(const std::string& what) { mistakes_.push_back(what); }

  void find_shape() {
    shape_ = link().round_shape();
    if (shape_ == nullptr && !words_.radius) return no_round_shape();
    const bool sphere = shape_ != nullptr && shape_->kind == RobotShape::Kind::sphere;
    wheel_.link = index_;
    wheel_.kind = kind_of(words_.kind, sphere);
    wheel_.angle = words_.angle.value_or(0);
    wheel_.radius = words_.radius ? *words_.radius : shape_->radius();
    if (!(wheel_.radius > 0))
      return wrong(fmt::format("radius: got {}, expected above 0", wheel_.radius));
    wheel_.centre = shape_ == nullptr ? link().origin : shape_->pose.position;
    if (wheel_.kind == WheelKind::ball && shape_ != nullptr && !sphere)
      wrong("a ball is a sphere, got a cylinder");
    placed_ = shape_ != nullptr;
    if (sphere) shape_ = nullptr;  // without an axis
  }
  void no_round_shape() {
    const auto is_mesh = [](const RobotShape& s) { return s.kind == RobotShape::Kind::mesh; };
    const bool mesh = std::ranges::any_of(link().collisions, is_mesh) ||
                      std::ranges::any_of(link().visuals, is_mesh);
    const double height = link().origin[2];
    const std::string example = height > 0 ? fmt::format("{:.4g}", height) : "0.1";
    wrong(fmt::format(
        "{}: give its radius in m, --wheel {}:radius={}{}, or a <collision> with a "
        "cylinder or a sphere",
        mesh ? "its geometry is a mesh" : "it has no cylinder or sphere", link().name, example,
        height > 0 ? " (the height of its origin above that of the root link)" : ""));
  }

  // The joints between it and the root that move.
  void find_joints() {
    const RobotJoint* welded = nullptr;
    for (int i = index_; robot_.link(i).parent >= 0; i = robot_.link(i).parent) {
      if (robot_.link(i).joint.moves()) joints_.push_back(i);
      if (robot_.link(i).joint.welded && joints_.empty()) welded = &robot_.link(i).joint;
    }
    if (wheel_.kind == WheelKind::ball && !joints_.empty() &&
        robot_.link(joints_.front()).joint.kind == "hinge")
      wheel_.turns = joints_.front();
    if (welded != nullptr)
      return wrong(
          fmt::format("cannot roll: its joint '{0}' is welded: leave it out of --weld, or "
                      "add it to --weld-all-but",
                      welded->name));
    if (!joints_.empty() || robot_.root_free) return;
    wrong(
        fmt::format("fixed to the root link '{}', it cannot roll; leave it out: a root that is "
                    "planar needs no support, which then slides without friction; or let it roll "
                    "with the whole robot, --root free",
                    robot_.links.front().name));
  }
  bool rolls_freely() const {
    const auto free = [&](int i) { return robot_.link(i).joint.kind == "free"; };
    return robot_.root_free || std::ranges::any_of(joints_, free);
  }

  void find_axle() {
    double best = kAcross;
    for (const int i : joints_) {
      const RobotJoint& joint = robot_.link(i).joint;
      if (joint.kind != "hinge") continue;
      const double off = (wheel_.centre - on_axis(wheel_.centre, joint)).norm();
      if (placed_ && off > kBeside * wheel_.radius) continue;
      const double angle = shape_ == nullptr
                               ? (std::abs(joint.axis[2]) < kVertical ? 0 : std::numbers::pi)
                               : std::asin(std::min(1.0, joint.axis.cross(shape_->axis()).norm()));
      if (angle >= best) continue;
      best = angle;
      wheel_.turns = i;
      if (angle < kParallel) break;
    }
    if (wheel_.turns >= 0) {
      const RobotJoint& joint = robot_.link(wheel_.turns).joint;
      const Vec3 centre = on_axis(wheel_.centre, joint);
      const double off = (wheel_.centre - centre).norm();
      if (best >= kParallel)
        correct(fmt::format("its cylinder leans by {:.3g} rad against the axis", best));
      if (placed_ && off > kCentred)
        correct(fmt::format("its centre is {:.3g} m off the axis", off));
      wheel_.axle = joint.axis;
      wheel_.centre = centre;
    } else if (shape_ != nullptr && rolls_freely()) {
      wheel_.axle = shape_->axis();
    } else {
      return no_axle();
    }
    if (std::abs(wheel_.axle[2]) >= kVertical)
      wrong(fmt::format("its axle {} is upright as drawn, expected a level one",
                        in_words(wheel_.axle)));
  }
  void correct(const std::string& what) {
    const std::string& joint = robot_.link(wheel_.turns).joint.name;
    wheel_.corrected.push_back(fmt::format(
        "wheel '{}': {} of joint '{}', which is taken as its axle", link().name, what, joint));
  }
  void no_axle() {
    std::string text = "cannot roll: no joint turns about its axle";
    if (shape_ != nullptr) text += fmt::format(", which is along {}", in_words(shape_->axis()));
    else text += ": no hinge about a level axis carries it";
    if (!joints_.empty()) {
      const RobotJoint& joint = robot_.link(joints_.front()).joint;
      text += joint.kind == "hinge"
                  ? fmt::format("; joint '{}' turns about {}", joint.name, in_words(joint.axis))
                  : fmt::format("; joint '{}' is a {}", joint.name, joint.kind);
      if (joint.kind == "hinge" && placed_) {
        const Vec3 at = on_axis(wheel_.centre, joint);
        text += fmt::format(", {:.3g} m from its centre", (wheel_.centre - at).norm());
      }
    }
    wrong(text +
          "; correct the <axis> of the joint or the <origin> of the cylinder, or leave the "
          "wheel out");
  }

  const Robot& robot_;
  int index_;
  const WheelWords& words_;
  std::vector<std::string>& mistakes_;
  const RobotShape* shape_ = nullptr;  // a cylinder
  bool placed_ = false;                // its centre is that of a shape
  std::vector<int> joints_;            // the nearest first
  RobotWheel wheel_;
};

}  // namespace

std::optional<RobotWheel> wheel_of(const Robot& robot, int link, const WheelWords& words,
                                   std::vector<std::string>& mistakes) {
  return Axle(robot, link, words, mistakes).find();
}

}  // namespace hamel::mechanisms
