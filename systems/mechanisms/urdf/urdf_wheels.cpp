#include <hamel/systems/mechanisms/urdf/urdf_wheels.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/systems/mechanisms/urdf/urdf_shapes.hpp>

namespace hamel::mechanisms {
namespace {

constexpr double kSameHeight = 1e-7;  // m

const std::vector<std::string>& wheel_kinds() {
  static const std::vector<std::string> all = {"wheel", "ball", "omni", "mecanum"};
  return all;
}

class Finder {
 public:
  Finder(const Robot& robot, const std::string& path, std::vector<std::string>& mistakes)
      : robot_(robot), path_(path), mistakes_(mistakes), names_(robot.link_names()) {}

  void add(const std::string& given) {
    WheelWords words;
    if (!read(given, words)) return;
    if (words.name == "auto" && !knows("auto") && words.kind.empty() && !words.radius &&
        !words.angle) {
      automatic = true;
      friction_of_all = words.friction;
      return;
    }
    if (!knows(words.name)) return wrong(given, unknown_name("link", words.name, names_));
    const auto index = static_cast<int>(std::ranges::find(names_, words.name) - names_.begin());
    if (std::ranges::find(wheels, index, &RobotWheel::link) != wheels.end())
      return wrong(words.name, "named twice");
    std::vector<std::string> why;
    if (auto wheel = wheel_of(robot_, index, words, why)) {
      wheels.push_back(*wheel);
      wheels.back().friction = words.friction;
      given_angle.push_back(words.angle.has_value());
    }
    for (const std::string& what : why) wrong(words.name, what);
  }

  void wrong(const std::string& wheel, const std::string& what) {
    mistakes_.push_back(fmt::format("{}: wheel '{}': {}", path_, wheel, what));
  }

  std::vector<RobotWheel> wheels;
  std::vector<bool> given_angle;  // of each wheel
  bool automatic = false;
  std::optional<double> friction_of_all;  // of wheels found by auto

 private:
  bool knows(const std::string& name) const {
    return std::ranges::find(names_, name) != names_.end();
  }

  // The longest name of a link before a colon; the whole up to the first where there is none.
  bool read(const std::string& given, WheelWords& out) {
    size_t end = given.size();
    while (!knows(given.substr(0, end)) && end != std::string::npos && end > 0)
      end = given.rfind(':', end - 1);
    if (end == std::string::npos || end == 0) end = given.find(':');
    out.name = given.substr(0, end);
    if (end == std::string::npos) return true;
    for (size_t at = end; at < given.size(); at = end) {
      end = std::min(given.find(':', at + 1), given.size());
      const std::string word = given.substr(at + 1, end - at - 1);
      if (!take(given, word, out)) return false;
    }
    return true;
  }
  bool take(const std::string& given, const std::string& word, WheelWords& out) {
    const size_t equal = word.find('=');
    const std::string key = word.substr(0, equal);
    if (equal == std::string::npos) {
      out.kind = word;
      if (std::ranges::find(wheel_kinds(), word) != wheel_kinds().end()) return true;
      wrong(given, unknown_name("kind of wheel", word, wheel_kinds()));
      return false;
    }
    if (key != "radius" && key != "angle" && key != "friction") {
      wrong(given, unknown_name("value", key, {"radius", "angle", "friction"}));
      return false;
    }
    double value = 0;
    const char* last = word.data() + word.size();
    const auto [behind, why] = std::from_chars(word.data() + equal + 1, last, value);
    const bool number = why == std::errc() && behind == last && std::isfinite(value);
    if (!number || (key == "radius" && !(value > 0)) || (key == "friction" && !(value >= 0))) {
      const char* const expected = key == "radius"  ? "a positive number, in m"
                                   : key == "angle" ? "a number, in rad"
                                                    : "a number of at least 0";
      wrong(given, fmt::format("{}: got '{}', expected {}", key, word.substr(equal + 1), expected));
      return false;
    }
    (key == "radius" ? out.radius : key == "angle" ? out.angle : out.friction) = value;
    return true;
  }

  const Robot& robot_;
  const std::string& path_;
  std::vector<std::string>& mistakes_;
  std::vector<std::string> names_;
};

// radius=r, angle=a and friction=mu behind a comma belong to the wheel before them.
std::vector<std::string> joined(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (const std::string& name : names) {
    const bool more =
        name.starts_with("radius=") || name.starts_with("angle=") || name.starts_with("friction=");
    if (more && !out.empty()) out.back() += ":" + name;
    else out.push_back(name);
  }
  return out;
}

// The rollers of mecanum wheels mounted as usual: those in contact with the ground lie across the
// diagonals, so that the direction without slip, cos(a) rolling + sin(a) sideways, of the wheel
// ahead on the left is (1, -1), and that of its neighbours (1, 1). With the rates w of the wheels,
// r w = vx -+ vy -+ (lx + ly) omega. Source: Muir, Neuman, Kinematic Modeling for Feedback Control
// of an Omnidirectional Wheeled Mobile Robot (ICRA 1987).
void turn_rollers(Finder& finder, const Robot& robot) {
  Vec3 middle = Vec3::Zero();
  int count = 0;
  for (const RobotWheel& wheel : finder.wheels) {
    if (wheel.kind != RobotWheel::Kind::mecanum) continue;
    middle += wheel.centre;
    ++count;
  }
  for (size_t i = 0; i < finder.wheels.size(); ++i) {
    RobotWheel& wheel = finder.wheels[i];
    if (wheel.kind != RobotWheel::Kind::mecanum || finder.given_angle[i]) continue;
    const Vec3 from = wheel.centre - middle / count, ahead = wheel.axle.cross(Vec3::UnitZ());
    const double along = from.dot(ahead), across = from.dot(wheel.axle);
    if (std::min(std::abs(along), std::abs(across)) < 1e-3 * from.norm() || from.isZero(1e-9))
      finder.wrong(robot.link(wheel.link).name,
                   "the angle of its rollers follows from the corner of the base at which it is, "
                   "but it is at none: give it, LINK:mecanum:angle=0.7853981633974483 (or with a "
                   "minus)");
    wheel.angle = along * across > 0 ? -std::numbers::pi / 4 : std::numbers::pi / 4;
  }
}

// --wheel auto: the links that look like wheels, beside those that are named.
void take_wheels_by_shape(Finder& finder, const Robot& robot, std::vector<std::string>& notes) {
  std::vector<std::string> taken, tipping;
  for (const RobotWheel& wheel : wheels_by_shape(robot, &tipping)) {
    if (std::ranges::find(finder.wheels, wheel.link, &RobotWheel::link) != finder.wheels.end())
      continue;
    finder.wheels.push_back(wheel);
    finder.wheels.back().friction = finder.friction_of_all;
    finder.given_angle.push_back(false);
    taken.push_back(robot.link(wheel.link).name);
  }
  const auto others = wheels_by_joint(robot, !taken.empty());
  const std::string more = others.empty() ? ""
                                          : fmt::format(
                                                "; on hinges without limits, without a cylinder or "
                                                "sphere: --wheel {}",
                                                fmt::join(others, " --wheel "));
  if (!taken.empty()) notes.push_back(fmt::format("--wheel auto takes {}{}", quoted(taken), more));
  std::string why;
  for (const std::string& one : tipping) why += "; " + one;
  if (!taken.empty() && !why.empty()) notes.push_back("--wheel auto: " + why.substr(2));
  if (const auto fixed = fixed_wheels(robot); !fixed.empty())
    why += fmt::format(
        "; called wheels, but on fixed joints: {}; a wheel rolls on a joint of "
        "type continuous",
        quoted(fixed));
  if (finder.wheels.empty()) {
    for (int i = 1; i < robot.count(); ++i)
      if (is_called_wheel(robot.link(i)) && robot.link(i).round_shape() != nullptr)
        finder.add(robot.link(i).name);  // with what is wrong with it
    finder.wrong("auto", "no link with a cylinder or sphere on a hinge is at the lowest point" +
                             why +
                             (more.empty() ? "; name the wheels, --wheel LINK:radius=r" : more));
  }
}

}  // namespace

double RobotWheel::depth() const {
  return radius * (kind == Kind::ball ? 1 : std::sqrt(std::max(0.0, 1 - axle[2] * axle[2])));
}

std::vector<RobotWheel> find_wheels(const Robot& robot, const std::vector<std::string>& names,
                                    const std::string& path, std::vector<std::string>& mistakes,
                                    std::vector<std::string>& notes) {
  Finder finder(robot, path, mistakes);
  for (const std::string& name : joined(names)) finder.add(name);
  if (finder.automatic) take_wheels_by_shape(finder, robot, notes);
  for (const RobotWheel& wheel : finder.wheels)
    notes.insert(notes.end(), wheel.corrected.begin(), wheel.corrected.end());
  turn_rollers(finder, robot);
  return std::move(finder.wheels);
}

void level_wheels(const Robot& robot, std::vector<RobotWheel>& wheels, const std::string& path,
                  std::vector<std::string>& mistakes, std::vector<std::string>& notes) {
  if (wheels.empty()) return;
  const RobotWheel lowest =
      *std::ranges::min_element(wheels, {}, [](const RobotWheel& w) { return w.lowest(); });
  for (RobotWheel& wheel : wheels) {
    const double gap = wheel.lowest() - lowest.lowest(), radius = wheel.radius;
    if (gap <= kSameHeight * 0.1) continue;
    wheel.radius *= 1 + gap / wheel.depth();
    if (gap <= kSameHeight) continue;
    const std::string& name = robot.link(wheel.link).name;
    const std::string where =
        fmt::format("{:.4g} m above the lowest point of '{}'", gap, robot.link(lowest.link).name);
    if (gap > kNearHeight * radius)
      mistakes.push_back(fmt::format(
          "{}: wheel '{}': does not touch the ground: its lowest point is {}; leave it out, or "
          "give its radius, --wheel {}:radius={:.6g}",
          path, name, where, name, wheel.radius));
    else
      notes.push_back(
          fmt::format("wheel '{}': its lowest point is {}: radius {:.6g} m instead of "
                      "{:.6g} m",
                      name, where, wheel.radius, radius));
  }
}

}  // namespace hamel::mechanisms
