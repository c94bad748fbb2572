// Assembly: bodies and joints, the tree.
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/assembly/assembly.hpp>

#include <hamel/framework/mechanics/quantity_names.hpp>

namespace hamel {

using namespace mechanisms;

// Moments of inertia about the mass centre, along the axes of the drawn pose.
Mat<3, 3> Assembly::moments_of(const Mechanism::BodyPart& body) {
  const std::vector<double>& given = body.inertia;
  Mat<3, 3> central = Mat<3, 3>::Zero();
  const Vec3 edges = vec(body.box);
  if (given.size() == 3) {
    central = vec({given[0], given[1], given[2]}).asDiagonal();
  } else if (given.size() == 6) {
    central << given[0], given[1], given[2], given[1], given[3], given[4], given[2], given[4],
        given[5];
  } else if (given.size() == 9) {
    for (int i = 0; i < 9; ++i) central(i / 3, i % 3) = given[static_cast<size_t>(i)];
    if (!(central - central.transpose()).isZero(1e-12 * central.norm()))
      wrong(body, "body", "inertia: expected a symmetric matrix");
  } else if (!given.empty()) {
    wrong(body, "body", fmt::format("inertia: got {} numbers, expected 3, 6 or 9", given.size()));
  } else if (body.sphere > 0) {
    central = 0.4 * body.mass * body.sphere * body.sphere * Mat<3, 3>::Identity();
  } else if (body.cylinder.size() == 2) {
    const double r2 = body.cylinder[0] * body.cylinder[0], l2 = body.cylinder[1] * body.cylinder[1];
    const Vec3 e = direction(body, "body", "axis", body.axis);
    const double across = body.mass * (3 * r2 + l2) / 12;
    central = across * Mat<3, 3>::Identity() + (0.5 * body.mass * r2 - across) * e * e.transpose();
  } else {
    const Vec3 squares = edges.cwiseAbs2();
    central = (body.mass / 12 * (Vec3::Constant(squares.sum()) - squares)).asDiagonal();
  }
  return central;
}

// Distance of the farthest mass centre or joint from the first joint, as drawn.
double Assembly::extent() const {
  double out = 0;
  const auto look_at = [&](const Point& at) {
    if (!parts_.joints_.empty())
      out = std::max(out, (vec(at) - vec(parts_.joints_.front().at)).norm());
  };
  for (const auto& body : parts_.bodies_) look_at(body.at);
  for (const auto& joint : parts_.joints_) look_at(joint.at);
  return out;
}

// Do the bodies and the kind of a joint exist? Else with mistakes.
bool Assembly::check_joint(const Mechanism::JointPart& joint) {
  bool known = true;
  const auto check = [&](const std::string& what, const std::string& body) {
    if (body == kWorld || (!body.empty() && bodies_.contains(body))) return;
    unknown(joint, "joint", what, body, body_names());
    known = false;
  };
  check("parent", joint.parent);
  check("child", joint.child);
  if (find_joint_kind(joint.kind) == nullptr) {
    unknown(joint, "joint", "kind", joint.kind, names_of(joint_kinds()));
    known = false;
  }
  return known;
}

// Joints that can hang bodies, one each; every body has one.
Assembly::Joints Assembly::joints_of_bodies() {
  std::map<std::string, const Mechanism::JointPart*> hangs_on;
  Joints out;
  for (const auto& joint : parts_.joints_) {
    if (!check_joint(joint)) continue;
    if (joint.child == kWorld) {
      wrong(joint, "joint", "child: expected a body, the ground hangs on nothing");
    } else if (const auto [other, is_new] = hangs_on.emplace(joint.child, &joint); !is_new) {
      wrong(joint, "joint",
            fmt::format(
                "body '{}' hangs on joint '{}' already: a joint that closes a chain is a loop",
                joint.child, other->second->name));
    } else {
      out.push_back(&joint);
    }
  }
  for (const auto& body : parts_.bodies_) {
    if (!hangs_on.contains(body.name) && mistakes_.empty())
      wrong(body, "body", "hangs on no joint; a root hangs on the ground by a planar or free one");
  }
  return out;
}

// A link for each joint, two for a universal one, none for a weld; parents first. Joints that the
// ground does not reach are a mistake.
void Assembly::link_from_ground(Joints waiting) {
  body_links_[kWorld] = mechanisms::kGround;
  for (size_t before = 0; before != waiting.size();) {
    before = waiting.size();
    Joints later;
    for (const auto* joint : waiting) {
      if (body_links_.contains(joint->parent)) link(*joint);
      else later.push_back(joint);
    }
    waiting = std::move(later);
  }
  if (waiting.empty()) return;
  std::string circle;
  for (const auto* joint : waiting)
    circle += fmt::format("{}'{}'", circle.empty() ? "" : ", ", joint->name);
  wrong(*waiting.front(), "joint",
        fmt::format("{} go round in a circle that does not reach the ground; hang one of the "
                    "bodies on it, and make one of the joints a loop",
                    circle));
}

void Assembly::check_hinge_names() {
  std::set<std::string> taken;
  for (size_t j = 0; j < links_.size(); ++j) {
    if (!taken.insert(link_names_[j]).second)
      wrong(*link_joints_[j], "joint",
            fmt::format("'{}' is the name of two hinges; those of a universal joint are 1 and 2 "
                        "behind its name",
                        link_names_[j]));
  }
}

void Assembly::link_bodies() {
  extent_ = extent();
  for (const auto& body : parts_.bodies_) bodies_.emplace(body.name, &body);
  Joints joints = joints_of_bodies();
  stop_at_mistakes();
  link_from_ground(std::move(joints));
  check_hinge_names();
  for (const auto& [link, bodies] : link_bodies_)
    links_[static_cast<size_t>(link)].inertia = inertia_of(bodies);
  stop_at_mistakes();
}

void Assembly::link_states() {
  const std::shared_ptr<const Joint> joint = find_joint_kind("slider")->make({}).front();
  for (const auto& part : parts_.states_) {
    Mechanism::JointPart& stated = state_joints_.emplace_back();
    stated.name = part.name;
    stated.where = part.where;
    add_link(mechanisms::kGround, joint, stated, stated.axis, "");
    links_.back().is_state = true;
    links_.back().is_time = part.is_time;
  }
}

void Assembly::link(const Mechanism::JointPart& part) {
  const int parent = body_links_.at(part.parent);
  const JointKind& kind = *find_joint_kind(part.kind);
  if (has_spring(part) && !kind.has_coordinate)
    wrong(part, "joint",
          fmt::format("stiffness and damping: expected a {}, got {}", kinds_with_coordinate(),
                      part.kind));
  const bool fits = check_values(part, "joint", kind.fields, part.values);
  int here = parent;
  for (const auto& joint : kind.make(fits ? part.values : Parameters())) {
    const bool first = here == parent;
    add_link(here, joint, part, first ? part.axis : part.axis2,
             kind.joints == 1 ? "" : (first ? "1" : "2"));
    here = static_cast<int>(links_.size()) - 1;
  }
  body_links_[part.child] = here;
  if (here != mechanisms::kGround) link_bodies_[here].push_back(bodies_.at(part.child));
}

// The frame of a joint has its third axis along `axis`.
void Assembly::add_link(int parent, const std::shared_ptr<const Joint>& joint,
                        const Mechanism::JointPart& part, const Point& axis,
                        const std::string& suffix) {
  const Vec3 e = joint->has_axis() ? direction(part, "joint", "axis", axis) : Vec3(Vec3::UnitZ());
  const Rigid on_child{frame_along(e), vec(part.at)};
  links_.push_back({parent, joint, joint->on_parent(on_child), on_child});
  link_names_.push_back(part.name + suffix);
  link_joints_.push_back(&part);
}

// A lone root joint's numbers go by their own names: x, theta, v1.
void Assembly::name_columns() {
  const auto roots = std::count_if(links_.begin(), links_.end(), [](const Link& l) {
    return l.parent == mechanisms::kGround && !l.is_state;
  });
  std::vector<GroupInfo> factors;
  std::string group, last;
  int power = 0;
  const auto write = [&] {
    if (power > 0)
      group += (group.empty() ? "" : "*") + last + (power > 1 ? fmt::format("^{}", power) : "");
  };
  for (size_t j = 0; j < links_.size(); ++j) {
    const Joint& joint = *links_[j].joint;
    factors.push_back(joint.group());
    if (joint.group().name != last) {
      write();
      power = 0;
      last = joint.group().name;
    }
    ++power;
    if (links_[j].is_state) {
      const std::string& unit = parts_.states_[j + parts_.states_.size() - links_.size()].unit;
      GroupFactor& factor = factors.back().factors.front();
      factor.units = {unit};
      factor.components = {{"rate", unit == "1" ? "1/s" : unit + "/s"}};
      model_.coordinates.push_back(link_names_[j]);
      model_.rates.push_back(link_names_[j] + ".rate");
      continue;
    }
    const bool alone =
        joint.turns_and_slides() && roots == 1 && links_[j].parent == mechanisms::kGround;
    const std::string front = alone ? "" : link_names_[j] + ".";
    for (const std::string& name : joint.columns()) model_.coordinates.push_back(front + name);
    for (const std::string& name : joint.rates()) model_.rates.push_back(front + name);
  }
  write();
  model_.group = product_info(group, factors);
  name_quantities(model_);
}

namespace {

const char* taken_by(const std::string& kind) {
  if (kind == "input") return "this name is taken";
  return kind == "brake" ? "this joint has a brake already"
                         : "this joint is driven by an input already";
}

// The input of a motor, of a prescribed joint, of a brake.
InputField input_of_joint(const std::string& joint, const std::string& kind, bool slider,
                          const Range& range) {
  const std::string effort = slider ? "force" : "torque", unit = slider ? "N" : "N m";
  if (kind == "prescribed")
    return {joint + ".rate", slider ? "m/s" : "rad/s", "rate of this joint", range};
  if (kind == "brake")
    return {joint + ".brake", unit, "bound of the " + effort + " of the brake", range};
  return {joint + "." + effort, unit, effort + " of the motor in this joint", range};
}

}  // namespace

// Motors and prescribed joints without a signal, brakes, then inputs by name.
void Assembly::state_inputs() {
  const auto add = [&](const Part& part, const std::string& kind, InputField field) {
    for (const InputField& other : model_.inputs) {
      if (other.name != field.name) continue;
      wrong(part, kind, taken_by(kind));
    }
    model_.inputs.push_back(std::move(field));
    if (model_.inputs.size() == kMostInputs + 1)
      wrong(part, kind, fmt::format("expected at most {} inputs", kMostInputs));
  };
  const auto of_joint = [&](const auto& part, const std::string& kind) {
    const auto at = std::find(link_names_.begin(), link_names_.end(), part.name);
    if (at == link_names_.end()) return;  // reported with the others
    const bool slider = links_[static_cast<size_t>(at - link_names_.begin())].joint->only_slides();
    add(part, kind, input_of_joint(part.name, kind, slider, part.range));
  };
  for (const auto& part : parts_.motors_)
    if (!part.effort) of_joint(part, "motor");
  for (const auto& part : parts_.rates_)
    if (!part.rate) of_joint(part, "prescribed");
  for (const auto& part : parts_.brakes_) of_joint(part, "brake");
  for (const auto& part : parts_.inputs_) add(part, "input", part.field);
}

}  // namespace hamel
