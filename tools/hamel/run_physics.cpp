// Velocities, shape, reactions, energy and momenta of a run, as curves.
#include <algorithm>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include <hamel/framework/mechanics/components.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/run/events.hpp>

#include "run_figures.hpp"

namespace hamel::tools {
namespace {

// Curves that are measured in the same unit stand in one figure.
class ByUnit {
 public:
  void add(const std::string& unit, Series series) {
    if (!figures_.contains(unit)) order_.push_back(unit);
    figures_[unit].push_back(std::move(series));
  }
  void plot(Page& page, const std::map<std::string, std::string>& titles, const std::string& other,
            const std::vector<Mark>& marks) const {
    for (const std::string& unit : order_) {
      const auto title = titles.find(unit);
      Axes axes{.x = "time t [s]", .y = unit.empty() ? "" : "[" + unit + "]"};
      axes.marks = marks;
      page.plot(title == titles.end() ? other : title->second, axes, figures_.at(unit));
    }
  }

 private:
  std::vector<std::string> order_;
  std::map<std::string, std::vector<Series>> figures_;
};

Series component(const Result& r, const std::string& name, const std::string& column,
                 const std::string& key) {
  Series series = curve(r, name, column, false);
  series.key = key;
  return series;
}

// The reactions of one part together: a mechanism's rows of phi stand behind all others.
std::vector<int> rows_by_part(const Result& r) {
  const std::vector<std::string>& names = r.system->reactions;
  std::vector<int> out(static_cast<size_t>(r.system->mechanics->rows()));
  std::iota(out.begin(), out.end(), 0);
  if (names.empty()) return out;
  const auto part = [&](int row) {
    const std::string& name = names[static_cast<size_t>(row)];
    return name.substr(0, name.rfind('.'));
  };
  std::vector<std::string> parts;
  for (const DrawnForce& force : r.system->forces) parts.push_back(force.name);
  for (const int row : out) parts.push_back(part(row));
  std::stable_sort(out.begin(), out.end(), [&](int a, int b) {
    return std::find(parts.begin(), parts.end(), part(a)) <
           std::find(parts.begin(), parts.end(), part(b));
  });
  return out;
}

// Does the k-th contact push? The event says when it ceased to; the rows only what they show. Marks
// the first that pulls.
std::string contact_note(const Result& r, const std::string& column, size_t k, Axes& axes) {
  const std::string event = events_of(*r.system, nullptr)[r.system->events.size() + k].name;
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
  if (pulls) axes.marks.push_back({t, "contact pulls"});
  return is + in_rows + ".";
}

void add_reactions(Page& page, const Result& r, const std::vector<Mark>& marks) {
  std::vector<Series> reactions;
  Axes axes{.x = "time t [s]", .y = ""};
  bool forces = true;  // all in N
  axes.marks = marks;
  std::string note = fmt::format(
      "Multipliers of the rows A xi = b, from the equations of motion at the recorded "
      "states. Their work over the run: {:.2e}, with A xi measured on the "
      "configurations; where b = 0 a scheme that keeps the rows in its steps leaves it at "
      "round-off.",
      r.reaction_work);
  for (const int i : rows_by_part(r)) {
    const std::string column = r.system->reactions.empty()
                                   ? fmt::format("lambda{}", i + 1)
                                   : r.system->reactions[static_cast<size_t>(i)];
    if (!r.trajectory.has(column)) continue;
    const auto& contacts = r.system->contacts;
    const auto contact = std::find(contacts.begin(), contacts.end(), i);
    const bool is_contact = contact != contacts.end();
    const std::string name = with_unit(column, unit_of_reaction(*r.system, i));
    forces = forces && name != column;
    reactions.push_back(curve(r, is_contact ? name + ", contact" : name, column, false));
    if (is_contact)
      note += " " + contact_note(r, column, static_cast<size_t>(contact - contacts.begin()), axes);
  }
  axes.y = with_unit("lambda", forces ? "N" : "");
  if (!reactions.empty()) page.plot("Reaction forces", axes, reactions, note);
}

void add_energy_balance(Page& page, const Result& r, const std::vector<Mark>& marks) {
  std::vector<double> rest = r.trajectory.column("energy");
  const std::vector<double> work = r.trajectory.column("work");
  for (size_t i = 0; i < rest.size(); ++i) rest[i] -= work[i];
  Axes axes{.x = "time t [s]", .y = "[J]"};
  axes.marks = marks;
  page.plot("Energy balance", axes,
            {curve(r, "energy E [J]", "energy", false), curve(r, "work W [J]", "work", false),
             thinned("E - W [J]", r.trajectory.column("t"), rest, false)},
            "W is the work of forces and moving constraints, by a quadrature over all steps; E - W "
            "is constant but for the error of the scheme.");
}

}  // namespace

void add_physics(Page& page, const Result& r, const std::vector<Mark>& marks) {
  const std::vector<std::string>& columns = r.system->group.columns;
  const std::vector<Component> names = components_of(*r.system);
  ByUnit velocity, momentum, shape;
  for (size_t i = 0; i < names.size(); ++i) {
    const auto& [name, unit] = names[i];
    velocity.add(unit, component(r, with_unit(name, unit), fmt::format("xi{}", i + 1), name));
    const std::string dual = unit == "rad/s" ? "N m s" : unit == "m/s" ? "N s" : "";
    momentum.add(dual,
                 component(r, with_unit("mu of " + name, dual), fmt::format("mu{}", i + 1), name));
  }
  for (const ShapeCoordinate& s : shape_of(r.system->group, names)) {
    const std::string &column = columns[static_cast<size_t>(s.column)],
                      &rate = names[static_cast<size_t>(s.component)].name;
    shape.add(s.unit, component(r, with_unit(rate.ends_with('\'') ? s.name : column, s.unit),
                                column, rate));
  }
  velocity.plot(page, {{"rad/s", "Angular velocity"}, {"m/s", "Velocity"}}, "Body velocity xi",
                marks);
  shape.plot(page, {{"rad", "Angles of the shape"}, {"m", "Places"}}, "Shape", marks);
  if (r.system->mechanics->rows() > 0) add_reactions(page, r, marks);
  if (does_work(r)) add_energy_balance(page, r, marks);
  momentum.plot(page, {{"N m s", "Angular momentum in the body"}, {"N s", "Momentum in the body"}},
                "Body momentum mu", marks);
}

}  // namespace hamel::tools
