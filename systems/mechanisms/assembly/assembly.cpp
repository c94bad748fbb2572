#include <hamel/systems/mechanisms/assembly/assembly.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/starts/poses.hpp>

namespace hamel {
namespace {

using namespace mechanisms;

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

// Without places and forces where nothing depends on the configuration; else null.
std::shared_ptr<const Mechanics> invariant(const Multibody& system) {
  if (!system.constant_inertia() || !system.constant_constraints() ||
      !system.constant_potential() || system.has_force() || system.has_drift())
    return nullptr;
  Eigen::MatrixXd inertia(system.dim(), system.dim()), a(system.constraint_count(), system.dim());
  Eigen::VectorXd b(system.constraint_count());
  system.inertia(system.drawn().data(), inertia);
  system.constraints(0, system.drawn().data(), a, b);
  return std::make_shared<LeftInvariantMechanics>(inertia, a);
}

}  // namespace

void Assembly::wrong(const Part& part, const std::string& kind, const std::string& text) {
  mistakes_.push_back(fmt::format("{}{} '{}': {}", part.where, kind, part.name, text));
}
void Assembly::unknown(const Part& part, const std::string& kind, const std::string& what,
                       const std::string& name, const std::vector<std::string>& known) {
  wrong(part, kind,
        name.empty() ? fmt::format("{}: missing, expected one of {}", what, join(known))
                     : unknown_name(what, name, known));
}
void Assembly::stop_at_mistakes() const {
  if (!mistakes_.empty()) throw ConfigError(mistakes_);
}

std::vector<std::string> Assembly::body_names() const {
  std::vector<std::string> out;
  std::set<std::string> there;
  for (const auto& body : parts_.bodies_)
    if (!body.name.empty() && there.insert(body.name).second) out.push_back(body.name);
  return out;
}

int Assembly::link_of(const Part& part, const std::string& kind, const std::string& body) {
  const auto it = body_links_.find(body);
  if (it != body_links_.end()) return it->second;
  std::vector<std::string> known = body_names();
  if (kind == "loop" || kind == "spring" || kind == "sensor")
    known.push_back(kWorld);  // may hang on the ground
  unknown(part, kind, "body", body, known);
  return mechanisms::kGround;
}

void Assembly::check_moves(const Part& part, const std::string& kind, const std::string& body) {
  const auto it = body_links_.find(body);
  if (it != body_links_.end() && it->second == mechanisms::kGround)
    wrong(part, kind, "body: expected a body that moves, not the ground or what is welded to it");
}

int Assembly::joint_of(const Part& part, const std::string& kind) {
  std::vector<std::string> known;
  for (size_t j = 0; j < links_.size(); ++j) {
    if (links_[j].joint->dim() != 1) continue;
    if (link_names_[j] == part.name) return static_cast<int>(j);
    known.push_back(link_names_[j]);
  }
  unknown(part, kind, kinds_with_coordinate(), part.name, known);
  return -1;
}

Vec3 Assembly::direction(const Part& part, const std::string& kind, const std::string& what,
                         const Point& given) {
  const Vec3 v = vec(given);
  const double length = v.norm();
  if (length > 0 && std::isfinite(length)) return v / length;
  wrong(part, kind, fmt::format("{}: got ({}), expected a direction", what, join(given)));
  return Vec3::UnitX();  // of a part that is refused
}

ConstraintRows Assembly::rows() {
  ConstraintRows out;
  out.ground = ground();
  check_distribution();
  for (const auto& part : parts_.contacts_) {
    const int link = link_of(part, part.kind, part.body);
    check_moves(part, part.kind, part.body);
    const ContactKind* kind = find_contact_kind(part.kind);
    if (kind == nullptr) unknown(part, "contact", "kind", part.kind, names_of(contact_kinds()));
    else if (check_values(part, part.kind, kind->fields, part.values) &&
             check_level(part, kind->fields)) {
      const auto model = kind->make(part.values);
      if (const std::string flaw = model->flaw(); !flaw.empty()) wrong(part, part.kind, flaw);
      out.contacts.push_back({part.name, model, link, vec(part.at), 0, part.friction.has_value()});
    }
    check_friction(part, part.kind, part);
  }
  for (const auto& part : parts_.loops_) {
    const Vec3 axis = vec(part.axis);
    out.loops.push_back({part.name, link_of(part, part.kind, part.a),
                         link_of(part, part.kind, part.b), vec(part.at),
                         axis.isZero(0) ? axis : Vec3(axis.normalized())});
    if (out.loops.back().a == out.loops.back().b && body_links_.contains(part.a) &&
        body_links_.contains(part.b))
      wrong(part, part.kind, fmt::format("'{}' and '{}' are one body", part.a, part.b));
    if (part.kind == "loop") continue;
    out.loops.back().surface = surface(part);
    out.loops.back().slips = part.contact.friction.has_value();
  }
  out.couplings = couplings();
  std::ranges::move(slipping_couplings(), std::back_inserter(out.couplings));
  for (const auto& part : parts_.rates_) {
    const auto rate = part.rate ? part.rate : [](double) { return 0.0; };
    for (const Prescribed& other : out.prescribed)
      if (other.name == part.name) wrong(part, "prescribed", "this joint is prescribed already");
    if (const int link = joint_of(part, "prescribed"); link >= 0) {
      out.prescribed.push_back({part.name, link, rate, part.angle, part.time_dependent,
                                part.slope});  // the number of the velocity follows
      out.prescribed.back().driven = !part.rate;
    }
  }
  return out;
}

Forces Assembly::forces() {
  Forces out;
  out.gravity = vec(parts_.gravity_);
  for (const auto& joint : parts_.joints_) {
    if (!has_spring(joint) || !find_joint_kind(joint.kind)->has_coordinate) continue;
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
    if (spring.a != spring.b || !body_links_.contains(part.a) || !body_links_.contains(part.b))
      continue;
    wrong(part, "spring",
          spring.a == mechanisms::kGround
              ? "expected a body that moves at one of its ends, not the ground or what is welded "
                "to it"
              : fmt::format("'{}' and '{}' are one rigid body", part.a, part.b));
  }
  for (const auto& part : parts_.motors_) {
    if (const int link = joint_of(part, "motor"); link >= 0 && part.effort)
      out.motors.push_back({part.name, link, part.effort, part.time_dependent});
  }
  for (const auto& part : parts_.forces_) {
    const std::string kind = part.couple ? "torque" : "force";
    Force force{part.name,
                link_of(part, kind, part.body),
                vec(part.at),
                part.couple,
                part.of_body,
                part.time_dependent,
                {}};
    for (int i = 0; i < 3; ++i) force.along[i] = part.along[i];
    check_moves(part, kind, part.body);
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

void Assembly::make_tree() {
  model_.name = parts_.name_;
  check_names();
  check_numbers();
  for (const auto& body : parts_.bodies_) check_body(body);
  if (parts_.bodies_.empty()) mistakes_.push_back(fmt::format("{}: no body", parts_.name_));
  link_bodies();
  link_states();
  check_dimension();
  name_columns();
  state_inputs();
}

SystemModel Assembly::outline() {
  make_tree();
  return std::move(model_);
}

SystemModel Assembly::model() {
  make_tree();
  ConstraintRows rows = this->rows();
  Forces forces = this->forces();
  stop_at_mistakes();

  const Tree tree(links_);
  check_masses(tree);
  check_feet(rows, tree);
  stop_at_mistakes();
  for (Prescribed& p : rows.prescribed) {
    if (p.angle && !p.time_dependent && p.rate(0) == 0) p.held = p.dof;
    p.dof = tree.first(p.dof);
  }
  for (Motor& m : forces.motors) m.dof = tree.first(m.dof);
  const std::shared_ptr<Multibody> system = system_of(std::move(rows), std::move(forces));
  system->find_constants(poses_around(*system, system->drawn()));
  const std::vector<RowInfo>& words = system->row_info();
  for (const int row : system->kept()) {
    const RowInfo& word = words[static_cast<size_t>(row)];
    if (word.height && !word.slips)
      model_.contacts.push_back(static_cast<int>(model_.reactions.size()));
    model_.reactions.push_back(word.name);
  }

  model_.parts = body_names();
  model_.rows_may_depend = !system->all_rows().agreements.empty();
  model_.events = parts_.events_;
  sense(*system);
  state_contacts(*system);
  stop_at_mistakes();
  start(starts_);
  check_motions(*system, rows_said_);
  stop_at_mistakes();
  note_what_stands(*system, redundancy_);
  draw(system);
  const auto driven = [system,
                       drivers = drivers(tree)](const std::shared_ptr<const Inputs>& inputs) {
    const auto out = std::make_shared<Multibody>(*system);
    if (inputs != nullptr) out->drive(drivers, inputs);
    return out;
  };
  if (!model_.inputs.empty()) model_.drive = driven;
  if (model_.contact_laws.empty()) model_.mechanics = invariant(*system);
  if (model_.mechanics == nullptr) model_.mechanics = driven(nullptr);
  add_outputs();
  stop_at_mistakes();
  model_.start_mistakes = [driven, checks = start_checks(tree)](
                              double t, const double* g, std::span<const double> xi,
                              const std::shared_ptr<const Inputs>& inputs) {
    return mistakes_at_start(*driven(inputs), checks, inputs.get(), t, g, xi);
  };
  if (!system->has_force() && !system->has_drift() && model_.contact_laws.empty())
    model_.invariants.push_back({"energy", energy_of(system), true});
  return std::move(model_);
}

}  // namespace hamel
