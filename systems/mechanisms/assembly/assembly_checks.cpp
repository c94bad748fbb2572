// Assembly: what the parts do not allow together, each mistake with the place of its part.
#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/assembly/assembly.hpp>
#include <hamel/systems/mechanisms/programs/body_formulas.hpp>

namespace hamel {

using namespace mechanisms;

namespace {

constexpr double kTouching = 1e-6;  // m

}  // namespace

void Assembly::check_names() {
  const auto unique = [&](const auto& parts, const std::string& kind,
                          std::set<std::string>& taken) {
    for (const auto& part : parts) {
      if (part.name.empty()) wrong(part, kind, "expected a name");
      else if (part.name == kWorld) wrong(part, kind, "is the name of what rests in the world");
      else if (!taken.insert(part.name).second) wrong(part, kind, "this name is taken");
      if (std::ranges::any_of(part.name, [](unsigned char c) {
            return c < ' ' || c == 0x7f || c == ',' || c == '"';
          }))  // in the head of a CSV file
        wrong(part, kind, "expected a name without commas, double quotes and control characters");
    }
  };
  std::set<std::string> bodies, joints, rows, springs, forces, sensors;
  unique(parts_.bodies_, "body", bodies);
  unique(parts_.joints_, "joint", joints);
  unique(parts_.contacts_, "contact", rows);
  unique(parts_.loops_, "loop", rows);
  unique(parts_.states_, "state", joints);
  unique(parts_.states_, "state", rows);
  for (const auto& part : parts_.states_)
    if (!Expression::allows(part.name))
      wrong(part, "state", "expected a name allowed in a formula");
  unique(parts_.couplings_, "coupling", rows);
  unique(parts_.walls_, "wall", rows);
  unique(parts_.springs_, "spring", springs);
  unique(parts_.forces_, "force", forces);
  unique(parts_.sensors_, "sensor", sensors);
}

void Assembly::check_body(const Mechanism::BodyPart& body) {
  if (std::isnan(body.mass))
    wrong(body, "body", "mass: not given; a body without one has `mass = 0`");
  else if (!(body.mass >= 0) || !std::isfinite(body.mass))
    wrong(body, "body", fmt::format("mass: got {}, expected at least 0", body.mass));
  const auto extent = [&](const char* what, std::span<const double> sizes) {
    if (std::ranges::any_of(sizes, [](double size) { return !(size >= 0); }))
      wrong(body, "body", fmt::format("{}: got {}, expected at least 0", what, join(sizes)));
  };
  extent("box", body.box);
  extent("cylinder", body.cylinder);
  extent("sphere", {&body.sphere, 1});
  const int shapes = (vec(body.box).isZero(0) ? 0 : 1) + (body.cylinder.empty() ? 0 : 1) +
                     (body.sphere != 0 ? 1 : 0);
  if (shapes > 1) wrong(body, "body", "expected one of box, cylinder and sphere");
  if (!body.cylinder.empty() && body.cylinder.size() != 2)
    wrong(
        body, "body",
        fmt::format("cylinder: got {} numbers, expected radius and length", body.cylinder.size()));
}

// A body that can be moved for nothing has no equation of motion.
void Assembly::check_masses(const Tree& tree) {
  const Eigen::MatrixXd inertia = inertia_at(tree, tree.drawn());
  for (const auto& joint : parts_.joints_) {
    const int link = body_links_.at(joint.child);
    if (find_joint_kind(joint.kind)->joints == 0 || link == kGround) continue;
    for (int i = 0; i < tree.count(link); ++i) {
      if (inertia(tree.first(link) + i, tree.first(link) + i) > 0) continue;
      wrong(joint, "joint",
            fmt::format("body '{}' and all that it carries have no inertia against its motion; "
                        "give it a mass, or weld it",
                        joint.child));
      break;
    }
  }
}

// Contacts touch level ground as drawn (that of a height is found at the start), loops are closed.
void Assembly::check_contacts(const Multibody& system) {
  const ConstraintRows& rows = system.all_rows();
  const Tree& tree = system.tree(system.drawn().data());
  for (size_t i = 0; i < rows.contacts.size(); ++i) {
    const auto& part = parts_.contacts_[i];
    const double height = rows.ground.height ? 0 : rows.touch(rows.contacts[i], tree)[2];
    if (!(std::abs(height) < kTouching) && !(rows.contacts[i].slips && height > 0)) {
      wrong(part, part.kind,
            fmt::format("does not touch the ground z = 0 as drawn: its lowest point is at {:.6g} m",
                        height));
    }
  }
  for (size_t i = 0; i < rows.loops.size(); ++i) {
    const Loop& loop = rows.loops[i];
    const double apart = loop.open_by(tree);
    if (std::abs(apart) < kTouching || (loop.slips && apart > 0)) continue;
    const auto& part = parts_.loops_[i];
    wrong(part, part.kind,
          loop.surface
              ? fmt::format("does not touch '{}' as drawn: its gap is {:.6g} m", part.a, apart)
              : fmt::format("is open as drawn by {:.6g} m", apart));
  }
}

// The element at which it is stated to start.
std::vector<double> Assembly::start_configuration(const Multibody& system,
                                                  const Starts& starts) const {
  Starts::Values stated;
  Starts::Places places;
  for (const auto& part : parts_.start_) {
    stated[part.name] = part.value;
    places[part.name] = part.where;
  }
  std::vector<double> g(system.drawn().size());
  system.geometry().from_coordinates(starts.configuration(stated, 0, places), g.data());
  return g;
}

// Refuses start values that contradict prescribed joints, and start_arguments that name one.
void Assembly::check_prescribed(const Starts& starts) {
  for (const auto& [name, angle] : starts.prescribed(0)) {
    for (const auto& part : parts_.start_) {
      if (part.name == name && !(std::abs(part.value - angle) < 1e-9))
        mistakes_.push_back(
            fmt::format("{}start: {} = {}, but it is prescribed as {} at t = 0; leave it out",
                        part.where, name, part.value, angle));
    }
    const auto& start_arguments = parts_.start_arguments_.names;
    if (std::find(start_arguments.begin(), start_arguments.end(), name) != start_arguments.end())
      mistakes_.push_back(
          fmt::format("{}start_arguments: {} is prescribed", parts_.start_arguments_.where, name));
  }
}

StartChecks Assembly::start_checks(const Tree& tree) {
  StartChecks out{rows_said_, redundancy_.repeats, {}, {}};
  for (const auto& part : parts_.motors_)
    out.signals.push_back(
        {fmt::format("{}motor '{}': effort", part.where, part.name), part.effort});
  for (const auto& part : parts_.forces_)
    for (const Signal& along : part.along)
      out.signals.push_back({fmt::format("{}force '{}': along", part.where, part.name), along});
  std::erase_if(out.signals, [](const Watched& signal) { return !signal.value; });
  for (const auto& part : parts_.rates_) {
    if (!part.angle) continue;
    const int link = joint_of(part, "prescribed");
    size_t column = 0;
    for (int j = 0; j < link; ++j) column += tree.joint(j).columns().size();
    out.held.push_back(
        {fmt::format("{}prescribed '{}': {}", part.where, part.name, model_.group.columns[column]),
         column, tree.joint(link).only_turns(), part.angle});
  }
  for (size_t j = 0, column = 0; j < links_.size(); ++j) {
    if (links_[j].is_time)
      out.held.push_back({model_.group.columns[column], column, false, [](double t) { return t; }});
    column += links_[j].joint->columns().size();
  }
  return out;
}

// The start as stated, and the starts given by numbers (start_arguments).
void Assembly::start(const std::shared_ptr<const Starts>& starts) {
  const auto& columns = model_.group.columns;
  std::map<std::string, double> stated, usual;
  std::map<std::string, std::string> places;
  for (const auto& part : parts_.start_) {
    stated[part.name] = part.value;
    places[part.name] = part.where;
    // The stated coordinates hold at other velocities too.
    if (std::find(columns.begin(), columns.end(), part.name) != columns.end())
      usual[part.name] = part.value;
  }
  check_prescribed(*starts);
  std::vector<std::string> start_arguments = parts_.start_arguments_.names;
  const bool runs = starts->mistakes({"speed"}).empty();
  if (start_arguments.empty() && runs) start_arguments = {"speed"};
  for (const std::string& wrong : starts->mistakes(start_arguments))
    mistakes_.push_back(parts_.start_arguments_.where + "start_arguments: " + wrong);
  stop_at_mistakes();
  model_.start = starts->solve(stated, 0, places);
  model_.start_parameters = start_arguments;
  std::map<std::string, double> pushed = usual;
  for (const auto& part : parts_.push_) {
    pushed[part.name] = part.value;
    model_.push += fmt::format("{}{} = {}", model_.push.empty() ? "" : ", ", part.name, part.value);
    for (const std::string& wrong : starts->mistakes({part.name}))
      mistakes_.push_back(part.where + "push: " + wrong);
  }
  stop_at_mistakes();
  const auto at_speed = [starts](const std::map<std::string, double>& others) {
    return [starts, others](double speed, double t) {
      std::map<std::string, double> values = others;
      values["speed"] = speed;
      return starts->solve(values, t);
    };
  };
  if (runs) {
    model_.start_at_speed = at_speed(usual);
    if (!parts_.push_.empty()) model_.start_pushed = at_speed(pushed);
  }
  model_.start_with = [starts, stated, usual, pushed](const std::map<std::string, double>& given,
                                                      double t, bool push) {
    const bool with_speed = given.contains("speed");
    std::map<std::string, double> values = !with_speed ? stated : push ? pushed : usual;
    for (const auto& [name, value] : given) {
      if (starts->is_speed(name))
        std::erase_if(values, [&](const auto& other) { return starts->is_speed(other.first); });
      values[name] = value;
    }
    return starts->solve(values, t);
  };
  model_.start_from = [starts, start_arguments, stated, pushed](std::span<const double> given,
                                                                double t) {
    std::map<std::string, double> values = given.empty() ? stated : pushed;
    for (size_t i = 0; i < given.size(); ++i) values[start_arguments[i]] = given[i];
    return starts->solve(values, t);
  };
}

}  // namespace hamel
