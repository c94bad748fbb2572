// Assembly: contacts that slide, open and strike; dry friction and stops of joints; walls.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/assembly/assembly.hpp>

namespace hamel {

using namespace mechanisms;

namespace {

bool is_size(const std::optional<double>& value) {
  return !value || (*value >= 0 && std::isfinite(*value));
}

}  // namespace

void Assembly::check_friction(const Part& part, const std::string& kind,
                              const ContactOptions& options) {
  const auto size = [&](const char* what, const std::optional<double>& value) {
    if (!is_size(value))
      wrong(part, kind, fmt::format("{}: got {}, expected at least 0", what, *value));
  };
  size("friction", options.friction);
  size("load", options.load);
  size("static_friction", options.static_friction);
  size("share", options.share);
  const auto coefficient = [&](const char* what, const std::optional<double>& value) {
    if (value && !(*value >= 0 && *value <= 1))
      wrong(part, kind, fmt::format("{}: got {}, expected in [0, 1]", what, *value));
  };
  coefficient("restitution", options.restitution);
  coefficient("tangential_restitution", options.tangential_restitution);
  if (options.friction && options.static_friction && *options.static_friction < *options.friction)
    wrong(part, kind,
          fmt::format("static_friction: got {}, expected at least friction, {}",
                      *options.static_friction, *options.friction));
  check_share(part, kind, options);
  if (options.friction) return;
  const auto alone = [&](const char* what) {
    wrong(part, kind,
          fmt::format("{}: set friction too, 0 for a smooth ground; without, the contact is ideal",
                      what));
  };
  if (options.static_friction) alone("static_friction");
  if (options.restitution) alone("restitution");
  if (options.tangential_restitution) alone("tangential_restitution");
  if (options.load) alone("load");
  if (options.unilateral && *options.unilateral) alone("unilateral");
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

// Refuses a contact or a coupling with the name of friction, a stop or a wall.
void Assembly::check_taken(const std::string& name) {
  const char* const taken = "this name is taken by a joint with friction";
  for (const auto& contact : parts_.contacts_)
    if (contact.name == name && contact.friction) wrong(contact, contact.kind, taken);
  for (const auto& pair : parts_.loops_)
    if (pair.name == name && pair.contact.friction) wrong(pair, pair.kind, taken);
  for (const auto& coupling : parts_.couplings_)
    if (coupling.name == name) wrong(coupling, "coupling", taken);
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
  for (const auto& part : parts_.walls_) {
    if (auto found = wall(part)) out.push_back(std::move(*found));
    if (auto found = slip_of_wall(part)) out.push_back(std::move(*found));
  }
  for (const Coupling& one : out) check_taken(one.name);
  return out;
}

// A row that does not always hold.
std::optional<Coupling> Assembly::row_of_wall(const Mechanism::WallPart& part,
                                              Mechanism::CouplingPart row, const std::string& key) {
  row.name = part.name;
  row.where = part.where;
  row.constants = part.constants;
  auto out = coupling(row, "wall", key);
  if (out) out->slips = true;
  return out;
}

std::optional<Coupling> Assembly::wall(const Mechanism::WallPart& part) {
  if (!(part.restitution >= 0 && part.restitution <= 1))
    wrong(part, "wall", fmt::format("restitution: got {}, expected in [0, 1]", part.restitution));
  Mechanism::CouplingPart distance;
  distance.formula = part.distance;
  return row_of_wall(part, std::move(distance), "distance");
}

std::optional<Coupling> Assembly::slip_of_wall(const Mechanism::WallPart& part) {
  if (!is_size(part.friction))
    wrong(part, "wall", fmt::format("friction: got {}, expected at least 0", *part.friction));
  if (part.friction && part.slip.empty())
    wrong(part, "wall",
          "friction: a distance has no point that slips; expected slip = \"...\" beside it, the "
          "velocity along the wall, linear in rates");
  if (!part.friction && !part.slip.empty())
    wrong(part, "wall", "slip: expected friction beside it");
  if (!part.friction || part.slip.empty()) return {};
  Mechanism::CouplingPart slip;
  slip.rates = part.slip;
  return row_of_wall(part, std::move(slip), "slip");
}

// Place of a row among the kept ones, or -1.
int Assembly::kept_place(const Multibody& system, size_t row) {
  const auto at = std::ranges::find(system.kept(), static_cast<int>(row));
  return at == system.kept().end() ? -1 : static_cast<int>(at - system.kept().begin());
}

void Assembly::add_law(const Multibody& system, const std::string& name,
                       const ContactOptions& options, size_t row, size_t rows, double load) {
  const size_t height = row + rows - 1;
  ContactLaw law;
  law.name = name;
  law.friction = *options.friction;
  law.static_friction = options.static_friction.value_or(0);
  law.restitution = options.restitution.value_or(0);
  law.tangential_restitution = options.tangential_restitution.value_or(0);
  for (; row < height; ++row)
    if (const int place = kept_place(system, row); place >= 0) law.tangential.push_back(place);
  if (const int place = kept_place(system, height); place >= 0) law.normal = place;
  else law.load = load;
  law.share = parts_.distribution_.name == "refuse" ? 0 : options.share.value_or(1);
  model_.contact_laws.push_back(std::move(law));
}

void Assembly::add_law(const Coupling& coupling, int place) {
  for (const auto& part : parts_.walls_) {  // behind that of its distance
    if (part.name != coupling.name || !coupling.of_rates()) continue;
    if (model_.contact_laws.empty() || model_.contact_laws.back().name != part.name) return;
    model_.contact_laws.back().tangential = {place};
    model_.contact_laws.back().friction = *part.friction;
    return;
  }
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
    const size_t count = rows.contacts[i].row_count();
    const Mechanism::ContactPart& part = parts_.contacts_[i];
    if (rows.contacts[i].slips) add_law(system, part.name, part, row, count, loads[i]);
    row += count;
  }
  for (size_t i = 0; i < rows.loops.size(); ++i) {
    const size_t count = rows.loops[i].row_count();
    const Mechanism::LoopPart& part = parts_.loops_[i];
    if (rows.loops[i].slips) add_law(system, part.name, part.contact, row, count, 0);
    row += count;
  }
  const std::string& policy = parts_.distribution_.name;
  if (std::ranges::count_if(model_.contact_laws, &ContactLaw::has_normal) > 3 && policy != "refuse")
    model_.notes.push_back(fmt::format(
        "more than three contacts: loads that the motion leaves open are those of contacts of {} "
        "(distribution)",
        policy == "stated" ? "the stated shares" : "equal compliance"));
  for (const Coupling& coupling : rows.couplings) {
    const int place = kept_place(system, row++);
    if (coupling.slips && place >= 0) add_law(coupling, place);
  }
}

}  // namespace hamel
