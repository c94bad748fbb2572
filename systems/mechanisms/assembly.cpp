#include <hamel/systems/mechanisms/assembly.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/poses.hpp>

namespace hamel {
namespace {

using namespace mechanisms;

constexpr double kTouching = 1e-6;  // m

// Reads a start as the drawn pose has it, for the energy.
std::function<double(std::span<const double>, std::span<const double>)> energy_of(
    std::shared_ptr<const Multibody> system) {
  return [system](std::span<const double> coordinates, std::span<const double> xi) {
    std::vector<double> g(system->drawn().size());
    system->geometry().from_coordinates(coordinates, g.data());
    const Eigen::VectorXd v = Eigen::Map<const Eigen::VectorXd>(xi.data(), system->dim());
    Eigen::MatrixXd inertia(system->dim(), system->dim());
    system->inertia(g.data(), inertia);
    return 0.5 * v.dot(inertia * v) + system->potential(g.data());
  };
}

// With its words; without places and forces where nothing depends on the configuration.
std::shared_ptr<const Mechanics> simplest(const Multibody& system, MotionWords words) {
  const bool invariant = system.constant_inertia() && system.constant_constraints() &&
                         system.constant_potential() && !system.has_force() && !system.has_drift();
  if (!invariant) return std::make_shared<WithWords<Multibody>>(system, std::move(words));
  Eigen::MatrixXd inertia(system.dim(), system.dim()), a(system.rows(), system.dim());
  Eigen::VectorXd b(system.rows());
  system.inertia(system.drawn().data(), inertia);
  system.constraints(0, system.drawn().data(), a, b);
  return std::make_shared<WithWords<LeftInvariantMechanics>>(LeftInvariantMechanics(inertia, a),
                                                             std::move(words));
}

}  // namespace

void Assembly::wrong(const Part& part, const std::string& kind, const std::string& text) {
  mistakes_.push_back(fmt::format("{}{} '{}': {}", part.where, kind, part.name, text));
}
void Assembly::unknown(const Part& part, const std::string& kind, const std::string& what,
                       const std::string& name, const std::vector<std::string>& known) {
  wrong(part, kind, unknown_name(what, name, known));
}
void Assembly::stop_at_mistakes() const {
  if (!mistakes_.empty()) throw ConfigError(mistakes_);
}

std::vector<std::string> Assembly::body_names() const {
  std::vector<std::string> out;
  for (const auto& body : parts_.bodies_) out.push_back(body.name);
  return out;
}

int Assembly::link_of(const Part& part, const std::string& kind, const std::string& body) {
  const auto it = body_links_.find(body);
  if (it != body_links_.end()) return it->second;
  unknown(part, kind, "body", body, body_names());
  return mechanisms::kGround;
}

int Assembly::joint_of(const Part& part, const std::string& kind) {
  std::vector<std::string> known;
  for (size_t j = 0; j < links_.size(); ++j) {
    if (links_[j].kind != JointKind::hinge && links_[j].kind != JointKind::slider) continue;
    if (link_names_[j] == part.name) return static_cast<int>(j);
    known.push_back(link_names_[j]);
  }
  unknown(part, kind, "hinge or slider", part.name, known);
  return -1;
}

Vec3 Assembly::direction(const Part& part, const std::string& kind, const std::string& what,
                         const Point& given) {
  const Vec3 v = vec(given);
  const double length = v.norm();
  if (length > 0 && std::isfinite(length)) return v / length;
  wrong(part, kind, fmt::format("{}: got ({}), expected a direction", what, join(given)));
  return Vec3::UnitZ();
}

Rows Assembly::rows() {
  Rows out;
  out.ground = {parts_.ground_rate_, vec(parts_.ground_velocity_)};
  for (const auto& part : parts_.contacts_) {
    Contact contact{part.name, ContactKind::wheel, link_of(part, part.kind, part.body),
                    vec(part.at)};
    contact.radius = part.radius;
    contact.angle = part.angle;
    if (part.kind == "roller") contact.kind = ContactKind::roller;
    if (part.kind == "blade") contact.kind = ContactKind::blade;
    if (part.kind == "ball") contact.kind = ContactKind::ball;
    const bool edge = contact.kind == ContactKind::blade;
    contact.axis = direction(part, part.kind, edge ? "along" : "axle", part.axle);
    if (contact.kind != ContactKind::ball && contact.axis.cross(Vec3::UnitZ()).norm() < 1e-6)
      wrong(part, part.kind, fmt::format("{}: is vertical", edge ? "along" : "axle"));
    if (!edge && !(part.radius > 0 && std::isfinite(part.radius)))
      wrong(part, part.kind,
            fmt::format("radius: got {}, expected a positive number", part.radius));
    if (part.body == kWorld) wrong(part, part.kind, "body: expected a body, not the ground");
    out.contacts.push_back(std::move(contact));
  }
  for (const auto& part : parts_.loops_) {
    const Vec3 axis = vec(part.axis);
    out.loops.push_back({part.name, link_of(part, "loop", part.a), link_of(part, "loop", part.b),
                         vec(part.at), axis.isZero(0) ? axis : Vec3(axis.normalized())});
    if (out.loops.back().a == out.loops.back().b)
      wrong(part, "loop", fmt::format("'{}' and '{}' are one body", part.a, part.b));
  }
  for (const auto& part : parts_.rates_) {
    const auto rate = part.rate ? part.rate : [](double) { return 0.0; };
    if (const int link = joint_of(part, "prescribed"); link >= 0)
      out.prescribed.push_back({part.name, link, rate});  // the number of the velocity follows
  }
  return out;
}

Forces Assembly::forces() {
  Forces out;
  out.gravity = vec(parts_.gravity_);
  for (const auto& joint : parts_.joints_) {
    if (joint.stiffness == 0 && joint.damping == 0) continue;
    Spring spring;
    spring.name = joint.name;
    spring.joint = joint_of(joint, "joint");
    spring.stiffness = joint.stiffness;
    spring.rest = joint.rest;
    spring.damping = joint.damping;
    out.springs.push_back(spring);
  }
  for (const auto& part : parts_.springs_) {
    Spring spring{part.name,
                  -1,
                  link_of(part, "spring", part.a),
                  link_of(part, "spring", part.b),
                  vec(part.from),
                  vec(part.to),
                  part.stiffness,
                  0,
                  part.damping};
    spring.rest = part.rest.value_or((spring.at_b - spring.at_a).norm());
    out.springs.push_back(spring);
  }
  for (const auto& part : parts_.motors_) {
    if (const int link = joint_of(part, "motor"); link >= 0 && part.effort)
      out.motors.push_back({part.name, link, part.effort});
  }
  for (const auto& part : parts_.forces_) {
    Force force{part.name, link_of(part, "force", part.body), vec(part.at), part.of_body, {}};
    for (int i = 0; i < 3; ++i) force.along[i] = part.along[i];
    out.forces.push_back(std::move(force));
  }
  return out;
}

// In the order of state_inputs().
std::vector<Multibody::Driver> Assembly::drivers(const Tree& tree) {
  std::vector<Multibody::Driver> out;
  for (const auto& part : parts_.motors_)
    if (!part.effort) out.push_back({tree.first(joint_of(part, "motor")), false});
  for (const auto& part : parts_.rates_)
    if (!part.rate) out.push_back({tree.first(joint_of(part, "prescribed")), true});
  return out;
}

// Contacts touch the ground as drawn, loops are closed.
void Assembly::check_contacts(const Multibody& system) {
  const Rows& rows = system.all_rows();
  const Tree& tree = system.tree(system.drawn().data());
  for (size_t i = 0; i < rows.contacts.size(); ++i) {
    const auto& part = parts_.contacts_[i];
    const double height = rows.height(rows.contacts[i], tree);
    if (!(std::abs(height) < kTouching)) {
      wrong(part, part.kind,
            fmt::format("does not touch the ground z = 0 as drawn: its lowest point is at {:.6g} m",
                        height));
    }
  }
  for (size_t i = 0; i < rows.loops.size(); ++i) {
    const Loop& loop = rows.loops[i];
    const double apart =
        (tree.in_world(loop.b).apply(loop.at) - tree.in_world(loop.a).apply(loop.at)).norm();
    if (!(apart < kTouching))
      wrong(parts_.loops_[i], "loop", fmt::format("is open as drawn by {:.6g} m", apart));
  }
}

void Assembly::make_tree() {
  model_.name = parts_.name_;
  check_names();
  for (const auto& body : parts_.bodies_) check_body(body);
  if (parts_.bodies_.empty()) mistakes_.push_back(fmt::format("{}: no body", parts_.name_));
  link_bodies();
  name_columns();
  state_inputs();
}

std::pair<SystemModel, MotionWords> Assembly::outline() {
  make_tree();
  return {std::move(model_), std::move(words_)};
}

SystemModel Assembly::model() {
  make_tree();
  Rows rows = this->rows();
  Forces forces = this->forces();
  stop_at_mistakes();

  const Tree tree(links_);
  check_masses(tree);
  for (Prescribed& p : rows.prescribed) p.dof = tree.first(p.dof);
  for (Motor& m : forces.motors) m.dof = tree.first(m.dof);
  std::vector<std::shared_ptr<const Geometry>> factors;
  for (const Link& link : links_) factors.push_back(type_of(link.kind).geometry);
  const auto system = std::make_shared<Multibody>(tree, std::move(rows), std::move(forces),
                                                  std::make_shared<ProductGeometry>(factors));
  check_contacts(*system);
  stop_at_mistakes();

  const std::vector<RowWords> words = system->all_rows().words();
  const Redundancy redundancy = look_for_redundancy(*system, system->drawn());
  if (parts_.redundant_ != "drop" && parts_.redundant_ != "refuse") {
    mistakes_.push_back(parts_.name_ + ": " +
                        unknown_name("redundant", parts_.redundant_, {"drop", "refuse"}));
  }
  for (const auto& [row, others] : redundancy.repeats) {
    const auto say = [&](int i) {
      return "'" + words[static_cast<size_t>(i)].part + "' (" +
             words[static_cast<size_t>(i)].meaning + ")";
    };
    std::string list;
    for (const int other : others) list += (list.empty() ? "" : ", ") + say(other);
    const std::string text = fmt::format("{} says nothing beyond {}", say(row), list);
    if (parts_.redundant_ == "drop") words_.notes.push_back("row dropped: " + text);
    else
      mistakes_.push_back(fmt::format(
          "{}: redundant row: {}; take a part with fewer rows (a roller for a wheel), or "
          "redundant = \"drop\"",
          parts_.name_, text));
  }
  stop_at_mistakes();
  system->keep(redundancy.rows);
  system->look_for_constants(poses_around(*system, system->drawn()));
  for (const int row : system->kept()) {
    const RowWords& word = words[static_cast<size_t>(row)];
    if (word.height) model_.contacts.push_back(static_cast<int>(words_.reactions.size()));
    words_.reactions.push_back(word.name);
  }

  const auto starts =
      std::make_shared<Starts>(system, parts_.name_, model_.group.columns, words_.rates);
  std::vector<std::string> asks = parts_.asks_;
  if (asks.empty() && starts->mistakes({"speed"}).empty()) asks = {"speed"};
  if (const auto wrong = starts->mistakes(asks); !wrong.empty()) throw ConfigError(wrong);
  model_.start = starts->solve(parts_.start_);
  words_.start_parameters = asks;
  // The stated coordinates hold there too, the stated velocities do not.
  std::map<std::string, double> usual = parts_.start_;
  std::erase_if(usual, [&](const auto& entry) {
    const auto& columns = model_.group.columns;
    return std::find(columns.begin(), columns.end(), entry.first) == columns.end();
  });
  words_.start_from = [starts, asks, usual](std::span<const double> given) {
    std::map<std::string, double> values = usual;
    for (size_t i = 0; i < given.size(); ++i) values[asks[i]] = given[i];
    return starts->solve(values);
  };
  draw(system);
  if (!model_.inputs.empty()) {
    model_.drive = [system, words = words_,
                    drivers = drivers(tree)](const std::shared_ptr<const Inputs>& inputs) {
      Multibody driven = *system;
      driven.drive(drivers, inputs);
      return std::make_shared<WithWords<Multibody>>(driven, words);
    };
  }
  model_.mechanics = simplest(*system, std::move(words_));
  if (!system->has_force() && !system->has_drift())
    model_.invariants.push_back({"energy", energy_of(system)});
  return std::move(model_);
}

}  // namespace hamel
