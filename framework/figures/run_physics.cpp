// Velocities, shape, reactions, energy and momenta of a run, as curves.
#include <algorithm>
#include <map>
#include <memory>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Core>

#include <hamel/framework/figures/curves.hpp>
#include <hamel/framework/figures/run_figures.hpp>
#include <hamel/framework/mechanics/components.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/run/run/events.hpp>

namespace hamel::figures {
namespace {

constexpr size_t kMostParts = 8;  // that have a figure of their reactions each

// Curves of the same unit share one figure.
class ByUnit {
 public:
  void add(const std::string& unit, Curve curve) {
    if (!curves_.contains(unit)) order_.push_back(unit);
    curves_[unit].push_back(in_unit(std::move(curve), unit));
  }
  void add_to(std::vector<Figure>& out, const std::map<std::string, std::string>& titles,
              const std::string& other, const std::vector<Mark>& marks) const {
    for (const std::string& unit : order_) {
      const auto title = titles.find(unit);
      out.push_back(over_time(title == titles.end() ? other : title->second, {"", unit},
                              curves_.at(unit), "", "", marks));
    }
  }

 private:
  std::vector<std::string> order_;
  std::map<std::string, std::vector<Curve>> curves_;
};

Curve component(const Result& r, const std::string& name, const std::string& column,
                const std::string& key) {
  Curve out = curve(r, name, column);
  out.key = key;
  return out;
}

// The part of a mechanism that a reaction belongs to: "rear" of "rear.reaction3"; "" where there is
// none.
std::string part_of_reaction(const std::string& name) {
  const size_t dot = name.rfind('.');
  return dot == std::string::npos ? "" : name.substr(0, dot);
}

// How many rows A xi = b there are; of a system that is only known by a recording how many have
// multipliers there.
int rows_with_reactions(const Result& r) {
  const SystemModel& system = *r.system;
  return system.mechanics != nullptr ? system.mechanics->constraint_count()
                                     : static_cast<int>(system.reactions.size());
}

// The rows of each part, in the order in which the mechanism draws them; in one list where there
// are more parts than figures help.
std::vector<std::pair<std::string, std::vector<int>>> rows_by_part(const Result& r) {
  const std::vector<std::string>& names = r.system->reactions;
  std::vector<std::pair<std::string, std::vector<int>>> out;
  const auto rows_of = [&](const std::string& part) -> std::vector<int>& {
    const auto at = std::find_if(out.begin(), out.end(),
                                 [&](const auto& known) { return known.first == part; });
    return at != out.end() ? at->second : out.emplace_back(part, std::vector<int>{}).second;
  };
  if (!names.empty())
    for (const DrawnForce& force : r.system->forces) rows_of(force.name);
  for (int row = 0; row < rows_with_reactions(r); ++row)
    rows_of(names.empty() ? "" : part_of_reaction(names[static_cast<size_t>(row)])).push_back(row);
  std::erase_if(out, [](const auto& part) { return part.second.empty(); });
  if (out.size() <= kMostParts) return out;
  std::vector<int> all;
  for (const auto& [part, rows] : out) all.insert(all.end(), rows.begin(), rows.end());
  return {{"", all}};
}

// Does the k-th contact push? The event has the time when it ceased to; the rows only what they
// show. Marks the first that pulls.
std::string contact_note(const Result& r, const std::string& column, size_t k,
                         std::vector<Mark>& marks) {
  const std::string event = events_of(*r.system)[r.system->events.size() + k].name;
  const auto met = std::find_if(r.events.begin(), r.events.end(),
                                [&](const EventMet& e) { return e.name == event; });
  const std::string is = fmt::format("`{}` is a normal reaction: ", column);
  const std::vector<double> force = r.trajectory.column(column);
  const double least = *std::min_element(force.begin(), force.end());
  const auto pull = std::find_if(force.begin(), force.end(), [](double f) { return f < 0; });
  const bool pulls = pull != force.end();
  const double t = pulls ? r.trajectory.at(static_cast<size_t>(pull - force.begin()), 0) : 0;
  const std::string in_rows =
      pulls ? fmt::format(
                  "at the state at t = {:.4g} the contact would have to **pull** (least "
                  "{:.3g} N), where a real body lifts off",
                  t, least)
            : fmt::format("at the {} states the contact pushes, by {:.3g} N at least",
                          r.trajectory.stride() > 1 ? "shown" : "recorded", least);
  if (met != r.events.end())
    return is + fmt::format("the contact **ceases to push** at t = {:.6g} (`{}`); {}.", met->time,
                            event, in_rows);
  if (pulls) marks.push_back({t, "contact pulls"});
  return is + in_rows + ".";
}

void add_reactions_of(std::vector<Figure>& out, const Result& r, const std::vector<Mark>& marks,
                      const std::string& part, const std::vector<int>& rows, std::string note) {
  std::vector<Curve> curves;
  std::vector<Mark> all_marks = marks;
  bool forces = true;  // all in N
  for (const int i : rows) {
    const std::string column = r.system->reactions.empty()
                                   ? fmt::format("lambda{}", i + 1)
                                   : r.system->reactions[static_cast<size_t>(i)];
    if (!r.trajectory.has(column)) continue;
    const auto& contacts = r.system->contacts;
    const auto contact = std::find(contacts.begin(), contacts.end(), i);
    Curve& reaction =
        curves.emplace_back(in_unit(curve(r, column, column), unit_of_reaction(*r.system, i)));
    forces = forces && !reaction.unit.empty();
    if (contact == contacts.end()) continue;
    reaction.note = "contact";
    note += (note.empty() ? "" : " ") +
            contact_note(r, column, static_cast<size_t>(contact - contacts.begin()), all_marks);
  }
  if (curves.empty()) return;
  out.push_back(over_time(part.empty() ? "Reaction forces" : "Reaction forces: " + part,
                          {"lambda", forces ? "N" : ""}, std::move(curves),
                          part.empty() ? "reactions" : "reactions-" + part, std::move(note),
                          std::move(all_marks)));
}

void add_reactions(std::vector<Figure>& out, const Result& r, const std::vector<Mark>& marks) {
  std::string note = fmt::format(
      "Multipliers of the rows A xi = b, from the equations of motion at the recorded "
      "states. Their work over the run: {:.2e}, with A xi measured on the "
      "configurations; where b = 0 a scheme that keeps the rows in its steps leaves it at "
      "round-off.",
      r.reaction_work);
  for (const auto& [part, rows] : rows_by_part(r)) {
    add_reactions_of(out, r, marks, part, rows, note);
    note.clear();  // of all parts
  }
}

// Angles that the equations do not depend on: of wheels and rotors. They are as large as the way is
// long. Not found of a system that is only known by a recording.
class Spins {
 public:
  Spins(const Registry& registry, const Result& r) : mechanics_(r.system->mechanics.get()) {
    const std::vector<std::string> maps = registry.retractions_or_common(r.system->group.name);
    if (mechanics_ == nullptr || maps.empty()) return;
    geometry_ = registry.geometry(r.system->group.name, maps.front());
    const std::span<const double> row = r.trajectory.row(r.trajectory.rows() - 1);
    const size_t columns = r.system->group.columns.size();
    time_ = row[0];
    coordinates_.assign(row.begin() + 1, row.begin() + 1 + static_cast<std::ptrdiff_t>(columns));
    velocity_ = Eigen::Map<const Eigen::VectorXd>(row.data() + 1 + columns, mechanics_->dim());
    here_ = equations(coordinates_);
  }
  bool has(const ShapeCoordinate& shape) const {
    if (geometry_ == nullptr || shape.unit != "rad") return false;
    std::vector<double> turned = coordinates_;
    turned[static_cast<size_t>(shape.column)] += 1;
    return (equations(turned) - here_).norm() <= kUnmoved * here_.norm();
  }

 private:
  // I, A, b, the force and V, one behind the other.
  Eigen::VectorXd equations(const std::vector<double>& coordinates) const {
    const Eigen::Index n = mechanics_->dim(), k = mechanics_->constraint_count();
    Eigen::VectorXd g(geometry_->size()), b = Eigen::VectorXd::Zero(k), force(n);
    Eigen::MatrixXd inertia(n, n), rows(k, n);
    geometry_->from_coordinates(coordinates, g.data());
    mechanics_->inertia(g.data(), inertia);
    mechanics_->constraints(time_, g.data(), rows, b);
    mechanics_->force(time_, g.data(), velocity_, force);
    Eigen::VectorXd out(n * n + k * n + k + n + 1);
    out << inertia.reshaped(), rows.reshaped(), b, force, mechanics_->potential(g.data());
    return out;
  }

  static constexpr double kUnmoved = 1e-10;
  const Mechanics* mechanics_;                // null where nothing is found
  std::shared_ptr<const Geometry> geometry_;  // null where nothing is found
  double time_ = 0;
  std::vector<double> coordinates_;
  Eigen::VectorXd velocity_, here_;
};

void add_energy_balance(std::vector<Figure>& out, const Result& r, const std::vector<Mark>& marks) {
  std::vector<double> rest = r.trajectory.column("energy");
  const std::vector<double> work = r.trajectory.column("work");
  for (size_t i = 0; i < rest.size(); ++i) rest[i] -= work[i];
  out.push_back(over_time(
      "Energy balance", {"", "J"},
      {in_unit(curve(r, "energy E", "energy"), "J"), in_unit(curve(r, "work W", "work"), "J"),
       in_unit(thinned("E - W", r.trajectory.column("t"), rest, false), "J")},
      "energy",
      "W is the work of forces and moving constraints, by a quadrature over all steps; E - W is "
      "constant but for the error of the scheme.",
      marks));
}

}  // namespace

void add_physics(std::vector<Figure>& out, const Registry& registry, const Result& r,
                 const std::vector<Mark>& marks) {
  const std::vector<Component> names = components_of(*r.system);
  ByUnit velocity, spin, momentum, shape, spun;
  const Spins spins(registry, r);
  const std::vector<ShapeCoordinate> coordinates = shape_of(r.system->group);
  const auto spinning = [&](size_t i) {
    return std::any_of(coordinates.begin(), coordinates.end(), [&](const ShapeCoordinate& s) {
      return s.component == static_cast<int>(i) && spins.has(s);
    });
  };
  for (size_t i = 0; i < names.size(); ++i) {
    const std::string &name = names[i].name, &unit = names[i].unit;
    (spinning(i) ? spin : velocity).add(unit, component(r, name, name, name));
    momentum.add(unit == "rad/s" ? "N m s"
                 : unit == "m/s" ? "N s"
                                 : "",
                 component(r, "mu of " + name, fmt::format("mu{}", i + 1), name));
  }
  for (const ShapeCoordinate& s : coordinates) {
    const std::string& rate = names[static_cast<size_t>(s.component)].name;
    (spins.has(s) ? spun : shape).add(s.unit, component(r, s.name, s.name, rate));
  }
  velocity.add_to(out, {{"rad/s", "Angular velocity"}, {"m/s", "Velocity"}}, "Body velocity xi",
                  marks);
  spin.add_to(out, {{"rad/s", "Spin of wheels and rotors"}}, "", marks);
  shape.add_to(out, {{"rad", "Angles of the shape"}, {"m", "Places"}}, "Shape", marks);
  spun.add_to(out, {{"rad", "Angles of wheels and rotors"}}, "", marks);
  if (rows_with_reactions(r) > 0) add_reactions(out, r, marks);
  if (does_work(r)) add_energy_balance(out, r, marks);
  momentum.add_to(out, {{"N m s", "Angular momentum in the body"}, {"N s", "Momentum in the body"}},
                  "Body momentum mu", marks);
}

}  // namespace hamel::figures
