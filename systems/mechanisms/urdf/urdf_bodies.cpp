#include <hamel/systems/mechanisms/urdf/urdf_bodies.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/toml_reader.hpp>

namespace hamel::mechanisms {

std::string quoted(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (const std::string& name : names) out.push_back(toml_string(name));
  return join(out);
}
std::string spelled(double x) { return fmt::format("{}", x + 0.0); }  // no -0
std::string spelled(const Vec3& v) {
  return fmt::format("[{}, {}, {}]", spelled(v[0]), spelled(v[1]), spelled(v[2]));
}

RobotBodies::RobotBodies(Robot& robot, bool root_is_ground)
    : robot_(robot), root_is_ground_(root_is_ground) {
  find_bodies();
  name_bodies();
  for (int i = 0; i < robot_.count(); ++i)
    if (bodies_of_[static_cast<size_t>(i)] == i && !(i == 0 && root_is_ground_))
      write(robot_.link(i));
}

bool RobotBodies::is_frame(const RobotLink& l) {
  return l.mass == 0 && l.inertia.isZero(0) && l.visuals.empty() && l.collisions.empty();
}

// The body of a link; of a frame, without mass and shape, the one that it is welded to.
void RobotBodies::find_bodies() {
  bodies_of_.resize(robot_.links.size());
  for (int i = 0; i < robot_.count(); ++i) bodies_of_[static_cast<size_t>(i)] = i;
  for (int i = robot_.count() - 1; i > 0; --i) {  // the first body that is welded to a frame
    const int parent = robot_.link(i).parent, body = bodies_of_[static_cast<size_t>(i)];
    if (parent == 0 && root_is_ground_) continue;  // which is the ground
    if (!robot_.link(i).joint.moves() && is_frame(robot_.link(parent)) &&
        !is_frame(robot_.link(body)))
      bodies_of_[static_cast<size_t>(parent)] = body;
  }
  for (int i = 1; i < robot_.count(); ++i)
    if (!robot_.link(i).joint.moves() && is_frame(robot_.link(bodies_of_[static_cast<size_t>(i)])))
      bodies_of_[static_cast<size_t>(i)] = bodies_of_[static_cast<size_t>(robot_.link(i).parent)];
}

std::string RobotBodies::name_of(int i) const {
  const int body = bodies_of_[static_cast<size_t>(i)];
  const bool ground = body == 0 && root_is_ground_;
  return toml_string(ground ? "ground" : robot_.link(body).name);
}

// A name that no body has yet: this one, or with bars behind it.
std::string RobotBodies::unused(std::string name) {
  while (!taken_.insert(name).second) name += "_";
  return name;
}

// "ground" is what rests in the world, and a link of this name is a body as others are.
void RobotBodies::name_bodies() {
  taken_.insert("ground");
  for (const RobotLink& l : robot_.links)
    if (l.name != "ground") taken_.insert(l.name);
  for (RobotLink& l : robot_.links) {
    if (l.name != "ground") continue;
    l.name = unused(l.name);
    renamed.push_back(l.name);
  }
}

// A box along the axes of the pose, a cylinder or a sphere as a body has it; "" for others.
std::string RobotBodies::words_of(const RobotShape& shape, const RobotLink& l) {
  using Kind = RobotShape::Kind;
  if (shape.kind == Kind::sphere) return ", sphere = " + spelled(shape.radius());
  if (shape.kind == Kind::cylinder)
    return fmt::format(", cylinder = [{}, {}], axis = {}", spelled(shape.size[0]),
                       spelled(shape.size[1]), spelled(shape.axis()));
  if (shape.kind == Kind::mesh) return "";
  const Mat<3, 3> size = shape.pose.rotation.cwiseAbs();
  const Mat<3, 3> near = size.array().round();
  if ((size - near).isZero(1e-9)) return ", box = " + spelled(Vec3(near * shape.size));
  turned.push_back(l.name);
  return "";
}

// The visuals; where all of them are meshes, the collisions.
const std::vector<RobotShape>& RobotBodies::drawn_shapes(const RobotLink& l) {
  const auto mesh = [](const RobotShape& s) { return s.kind == RobotShape::Kind::mesh; };
  if (std::ranges::any_of(l.visuals, mesh)) undrawn.push_back(l.name);
  return std::ranges::all_of(l.visuals, mesh) ? l.collisions : l.visuals;
}

void RobotBodies::write(const RobotLink& l) {
  std::string body = fmt::format("name = {}, mass = {}, at = {}", toml_string(l.name),
                                 spelled(l.mass), spelled(l.centre));
  if (l.mass > 0 || !l.inertia.isZero(0)) {
    const Mat<3, 3>& m = l.inertia;
    body += fmt::format(", inertia = [{}, {}, {}, {}, {}, {}]", spelled(m(0, 0)), spelled(m(0, 1)),
                        spelled(m(0, 2)), spelled(m(1, 1)), spelled(m(1, 2)), spelled(m(2, 2)));
  }
  bool drawn = false;
  std::vector<std::string> others;
  for (const RobotShape& shape : drawn_shapes(l)) {
    const std::string words = words_of(shape, l);
    if (words.empty()) continue;
    if (!drawn && (shape.pose.position - l.centre).isZero(1e-12)) {
      body += words;
      drawn = true;
    } else {
      others.push_back(fmt::format("mass = 0, at = {}{}", spelled(shape.pose.position), words));
    }
  }
  bodies.push_back(body);
  for (size_t k = 0; k < others.size(); ++k) {
    const std::string name = toml_string(unused(fmt::format("{} shape {}", l.name, k + 1)));
    bodies.push_back(fmt::format("name = {}, {}", name, others[k]));
    welds.push_back(fmt::format("name = {0}, kind = \"weld\", parent = {1}, child = {0}", name,
                                toml_string(l.name)));
  }
}

}  // namespace hamel::mechanisms
