// Assembly: contacts that slide, open and strike; dry friction and stops of joints; walls.
//
// Loads of contacts without a height, as on a planar root, are those of statics in the drawn pose,
// with c the mass centre of all that the root carries, W = m g its weight, and N_i at (x_i, y_i):
//   sum N_i = -W_z,   sum y_i N_i = -(c x W)_x,   sum x_i N_i = (c x W)_y;
// friction at z = 0 has no moment about the horizontal axes. Where these leave the loads of more
// than three contacts open, they are those of the least sum of squares: supports of equal
// compliance.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/assembly.hpp>
#include <hamel/systems/mechanisms/mobility.hpp>

namespace hamel {

using namespace mechanisms;

namespace {

bool is_size(const std::optional<double>& value) {
  return !value || (*value >= 0 && std::isfinite(*value));
}

int root_of(const Tree& tree, int link) {
  while (tree.parent(link) != kGround) link = tree.parent(link);
  return link;
}

}  // namespace

void Assembly::check_friction(const Mechanism::ContactPart& part) {
  const auto size = [&](const char* what, const std::optional<double>& value) {
    if (!is_size(value))
      wrong(part, part.kind, fmt::format("{}: got {}, expected at least 0", what, *value));
  };
  size("friction", part.friction);
  size("load", part.load);
  size("static_friction", part.static_friction);
  size("share", part.share);
  const auto coefficient = [&](const char* what, const std::optional<double>& value) {
    if (value && !(*value >= 0 && *value <= 1))
      wrong(part, part.kind, fmt::format("{}: got {}, expected in [0, 1]", what, *value));
  };
  coefficient("restitution", part.restitution);
  coefficient("tangential_restitution", part.tangential_restitution);
  if (part.friction && part.static_friction && *part.static_friction < *part.friction)
    wrong(part, part.kind,
          fmt::format("static_friction: got {}, expected at least friction, {}",
                      *part.static_friction, *part.friction));
  check_share(part);
  if (part.friction) return;
  const auto alone = [&](const char* what) {
    wrong(part, part.kind,
          fmt::format("{}: set friction too, 0 for a smooth ground; without, the contact is ideal",
                      what));
  };
  if (part.static_friction) alone("static_friction");
  if (part.restitution) alone("restitution");
  if (part.tangential_restitution) alone("tangential_restitution");
  if (part.load) alone("load");
  if (part.unilateral && *part.unilateral) alone("unilateral");
}

void Assembly::check_distribution() {
  const Part& policy = parts_.distribution_;
  const std::vector<std::string> known = {"equal_compliance", "refuse", "stated"};
  if (std::ranges::count(known, policy.name) == 0)
    mistakes_.push_back(policy.where + unknown_name("distribution", policy.name, known));
}

void Assembly::check_share(const Mechanism::ContactPart& part) {
  const bool stated = parts_.distribution_.name == "stated";
  if (part.share && !stated)
    wrong(part, part.kind, "share: expected distribution = \"stated\" beside it");
  if (stated && part.friction && !(part.share && *part.share > 0))
    wrong(part, part.kind,
          "share: distribution is \"stated\": expected a positive number, its part of the loads "
          "that are not determined");
}

void Assembly::check_brakes() {
  for (const auto& part : parts_.brakes_) {
    joint_of(part, "brake");
    if (!(part.range.least >= 0))
      wrong(part, "brake", fmt::format("least: got {}, expected at least 0", part.range.least));
  }
}

void Assembly::check_joint_friction(const Mechanism::JointPart& part) {
  if (!part.friction && part.stop.empty() && !part.restitution) return;
  if (!find_joint_kind(part.kind)->has_coordinate) {
    wrong(part, "joint",
          fmt::format("friction and stop: expected a {}, got {}", kinds_with_coordinate(),
                      part.kind));
    return;
  }
  if (!is_size(part.friction))
    wrong(part, "joint", fmt::format("friction: got {}, expected at least 0", *part.friction));
  if (!part.stop.empty() && !(part.stop.size() == 2 && part.stop[0] < part.stop[1] &&
                              std::isfinite(part.stop[1] - part.stop[0])))
    wrong(
        part, "joint",
        fmt::format("stop: got [{}], expected two numbers, the lower one first", join(part.stop)));
  if (!part.restitution) return;
  if (part.stop.empty()) wrong(part, "joint", "restitution: expected a stop beside it");
  else if (!(*part.restitution >= 0 && *part.restitution <= 1))
    wrong(part, "joint", fmt::format("restitution: got {}, expected in [0, 1]", *part.restitution));
}

bool Assembly::is_of_joint(const std::string& row, const Mechanism::JointPart& part) {
  return row == part.name || row == part.name + ".low" || row == part.name + ".high";
}

// In this order: friction and stops of a joint, one after the other; walls.
std::vector<Coupling> Assembly::slipping_couplings() {
  std::vector<Coupling> out;
  check_brakes();
  const auto add = [&](const std::string& name, const std::string& formula, double limit, int link,
                       std::vector<int> velocities) {
    out.push_back({name,
                   Expression(formula, {"q", "rate"}, {{"limit", limit}}),
                   {link},
                   std::move(velocities),
                   false,
                   {},
                   true});
  };
  int first = 0;
  for (size_t j = 0; j < links_.size(); ++j) {
    const Mechanism::JointPart& part = *link_joints_[j];
    const int link = static_cast<int>(j), dof = first;
    first += links_[j].joint->dim();
    if (links_[j].is_state) continue;
    check_joint_friction(part);
    if (links_[j].joint->dim() != 1 || !find_joint_kind(part.kind)->has_coordinate) continue;
    const bool braked = std::ranges::any_of(
        parts_.brakes_, [&](const auto& brake) { return brake.name == part.name; });
    if (part.friction || braked) add(part.name, "rate", 0, link, {dof});
    if (part.stop.size() != 2) continue;
    add(part.name + ".low", "q - limit", part.stop[0], link, {});
    add(part.name + ".high", "limit - q", part.stop[1], link, {});
  }
  for (const auto& part : parts_.walls_)
    if (auto found = wall(part)) out.push_back(std::move(*found));
  for (const Coupling& one : out) {
    for (const auto& contact : parts_.contacts_)
      if (contact.name == one.name && contact.friction)
        wrong(contact, contact.kind, "this name is taken by a joint with friction");
    for (const auto& coupling : parts_.couplings_)
      if (coupling.name == one.name)
        wrong(coupling, "coupling", "this name is taken by a joint with friction");
  }
  return out;
}

std::optional<Coupling> Assembly::wall(const Mechanism::WallPart& part) {
  if (!(part.restitution >= 0 && part.restitution <= 1))
    wrong(part, "wall", fmt::format("restitution: got {}, expected in [0, 1]", part.restitution));
  Mechanism::CouplingPart formula;
  formula.name = part.name;
  formula.where = part.where;
  formula.formula = part.distance;
  formula.constants = part.constants;
  auto out = coupling(formula, "wall", "distance");
  if (out) out->slips = true;
  return out;
}

// Loads of the contacts without a height on what a root carries.
void Assembly::find_loads(const Multibody& system, int root, std::vector<double>& loads) {
  const Tree& tree = system.tree(system.drawn().data());
  const std::vector<Contact>& contacts = system.all_rows().contacts;
  double mass = 0;
  Vec3 first = Vec3::Zero();
  for (int link = 0; link < tree.links(); ++link) {
    if (root_of(tree, link) != root) continue;
    mass += links_[static_cast<size_t>(link)].inertia.mass;
    first += links_[static_cast<size_t>(link)].inertia.first;
  }
  const Vec3 g = vec(parts_.gravity_), moment = first.cross(g);
  Vec3 right(-mass * g[2], -moment[0], moment[1]);
  std::vector<size_t> open;
  bool wanted = false;
  for (size_t i = 0; i < contacts.size(); ++i) {
    if (root_of(tree, contacts[i].link) != root) continue;
    const Vec3 at = system.all_rows().touch(contacts[i], tree);
    if (parts_.contacts_[i].load) {
      loads[i] = *parts_.contacts_[i].load;
      right -= loads[i] * Vec3(1, at[1], at[0]);
      continue;
    }
    open.push_back(i);
    wanted = wanted || contacts[i].slips;
  }
  if (!wanted) return;
  Eigen::MatrixXd a(3, static_cast<Eigen::Index>(open.size()));
  for (size_t k = 0; k < open.size(); ++k) {
    const Vec3 at = system.all_rows().touch(contacts[open[k]], tree);
    a.col(static_cast<Eigen::Index>(k)) = Vec3(1, at[1], at[0]);
  }
  if (open.size() > 3 && parts_.distribution_.name == "refuse") {
    const Mechanism::ContactPart& part = parts_.contacts_[open.front()];
    wrong(part, part.kind,
          fmt::format("load: {} contacts share the weight, statics determines three, and "
                      "distribution is \"refuse\"; give the loads of the others",
                      open.size()));
    return;
  }
  const Eigen::VectorXd shares = shares_of(open);
  Eigen::VectorXd found = least(a * shares.cwiseSqrt().asDiagonal(), right);
  found.array() *= shares.array().sqrt();
  const Mechanism::ContactPart& part = parts_.contacts_[open.front()];
  if (!((a * found - right).norm() <= 1e-9 * (1 + right.norm()))) {
    wrong(part, part.kind,
          fmt::format("load: the contacts do not balance the weight, {:.6g} N at ({:.6g}, {:.6g}) "
                      "m; give the loads, or add the support that is missing",
                      -mass * g[2], first[0] / mass, first[1] / mass));
    return;
  }
  std::string list;
  for (size_t k = 0; k < open.size(); ++k) {
    const double load = found[static_cast<Eigen::Index>(k)];
    const Mechanism::ContactPart& of = parts_.contacts_[open[k]];
    if (load < -1e-9 * right.norm())
      wrong(of, of.kind,
            fmt::format("load: {:.6g} N by statics in the drawn pose: it would tip; give the loads",
                        load));
    loads[open[k]] = std::max(load, 0.0);
    if (contacts[open[k]].slips)
      list += fmt::format("{}{} '{}' {:.6g} N", list.empty() ? "" : ", ", of.kind, of.name, load);
  }
  const bool stated = parts_.distribution_.name == "stated";
  model_.notes.push_back(fmt::format("loads of statics in the drawn pose{}: {}",
                                     open.size() <= 3 ? ""
                                     : stated         ? ", as the shares have it"
                                                      : ", of least sum of squares",
                                     list));
}

// sum N^2/share is least.
Eigen::VectorXd Assembly::shares_of(const std::vector<size_t>& contacts) const {
  Eigen::VectorXd out = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(contacts.size()));
  for (size_t k = 0; k < contacts.size(); ++k)
    out[static_cast<Eigen::Index>(k)] = parts_.contacts_[contacts[k]].share.value_or(1);
  return out;
}

std::vector<double> Assembly::loads(const Multibody& system) {
  const Tree& tree = system.tree(system.drawn().data());
  const std::vector<RowInfo>& words = system.row_info();
  std::vector<double> out(parts_.contacts_.size(), 0);
  std::vector<int> roots;
  size_t row = 0;
  for (size_t i = 0; i < parts_.contacts_.size(); ++i) {
    const Mechanism::ContactPart& part = parts_.contacts_[i];
    const Contact& contact = system.all_rows().contacts[i];
    row += contact.row_count();
    if (!contact.slips) continue;
    const int height = static_cast<int>(row) - 1;
    const bool changes =
        std::ranges::count(system.kept(), height) > 0 && words[static_cast<size_t>(height)].height;
    if (changes && part.load)
      wrong(part, part.kind,
            "load: the height of this contact may change, so that its load is a reaction; leave it "
            "out");
    if (changes && part.unilateral && !*part.unilateral)
      wrong(part, part.kind, "unilateral: a contact with friction may open; leave friction out");
    if (!changes && part.unilateral && *part.unilateral)
      wrong(part, part.kind,
            "unilateral: no joint changes the height of this contact, so that it cannot open");
    if (changes) continue;
    if (part.restitution || part.tangential_restitution)
      wrong(part, part.kind,
            "restitution: no joint changes the height of this contact, so that it cannot strike");
    const int root = root_of(tree, contact.link);
    if (part.load) out[i] = *part.load;
    else if (!tree.joint(root).turns_and_slides())
      wrong(part, part.kind,
            "load: not given, and its joints, not the ground, may bear the weight; give it in N");
    else if (std::ranges::count(roots, root) == 0) roots.push_back(root);
  }
  for (const int root : roots) find_loads(system, root, out);
  return out;
}

// Place of a row among the kept ones, or -1.
int Assembly::kept_place(const Multibody& system, size_t row) {
  const auto at = std::ranges::find(system.kept(), static_cast<int>(row));
  return at == system.kept().end() ? -1 : static_cast<int>(at - system.kept().begin());
}

void Assembly::add_law(const Multibody& system, size_t contact, size_t row, double load) {
  const Mechanism::ContactPart& part = parts_.contacts_[contact];
  const size_t height = row + system.all_rows().contacts[contact].row_count() - 1;
  ContactLaw law;
  law.name = part.name;
  law.friction = *part.friction;
  law.static_friction = part.static_friction.value_or(0);
  law.restitution = part.restitution.value_or(0);
  law.tangential_restitution = part.tangential_restitution.value_or(0);
  law.share = part.share.value_or(1);
  law.refuses = parts_.distribution_.name == "refuse";
  for (; row < height; ++row)
    if (const int place = kept_place(system, row); place >= 0) law.tangential.push_back(place);
  if (const int place = kept_place(system, height); place >= 0) law.normal = place;
  else law.load = load;
  model_.contact_laws.push_back(std::move(law));
}

void Assembly::add_law(const Coupling& coupling, int place) {
  ContactLaw law;
  law.name = coupling.name;
  law.of_joint = true;
  if (coupling.of_rates()) law.tangential = {place};
  else law.normal = place;
  law.friction = coupling.of_rates() ? 1 : 0;
  for (const auto& part : parts_.joints_) {
    if (!is_of_joint(coupling.name, part)) continue;
    law.restitution = part.restitution.value_or(0);
    if (!coupling.of_rates()) continue;
    law.load = part.friction.value_or(0);
    for (size_t i = 0; i < model_.inputs.size(); ++i)
      if (model_.inputs[i].name == part.name + ".brake") law.load_input = static_cast<int>(i);
  }
  for (const auto& part : parts_.walls_)
    if (part.name == coupling.name) law.restitution = part.restitution;
  model_.contact_laws.push_back(std::move(law));
}

void Assembly::state_contacts(const Multibody& system) {
  const std::vector<double> loads = this->loads(system);
  const ConstraintRows& rows = system.all_rows();
  size_t row = 0;
  for (size_t i = 0; i < rows.contacts.size(); ++i) {
    if (rows.contacts[i].slips) add_law(system, i, row, loads[i]);
    row += rows.contacts[i].row_count();
  }
  for (const Loop& loop : rows.loops) row += loop.row_count();
  for (const Coupling& coupling : rows.couplings) {
    const int place = kept_place(system, row++);
    if (coupling.slips && place >= 0) add_law(coupling, place);
  }
}

}  // namespace hamel
