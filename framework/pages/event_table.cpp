#include <hamel/framework/pages/event_table.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Core>

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/names/registry.hpp>

namespace hamel::pages {
namespace {

// Velocities that have a column each; of more the table shows none.
constexpr size_t kMostVelocities = 8;

// The kinetic energy that an event takes, J; none where it changes nothing, or where the system is
// known by its recording alone.
class TakenEnergy {
 public:
  TakenEnergy(const Registry& registry, const Result& r)
      : mechanics_(r.system->mechanics),
        geometry_(registry.geometry(r.system->group.name, r.config.retraction)) {}
  std::optional<double> operator()(const EventMet& event) const {
    if (event.velocity_after.empty() || mechanics_ == nullptr || geometry_ == nullptr) return {};
    std::vector<double> g(static_cast<size_t>(geometry_->size()));
    geometry_->from_coordinates(event.coordinates, g.data());
    const int n = mechanics_->dim();
    Eigen::MatrixXd inertia(n, n);
    mechanics_->inertia(g.data(), inertia);
    const auto energy = [&](const std::vector<double>& velocity) {
      const Eigen::Map<const Eigen::VectorXd> xi(velocity.data(), n);
      return xi.dot(inertia * xi) / 2;
    };
    return energy(event.velocity) - energy(event.velocity_after);
  }

 private:
  std::shared_ptr<const Mechanics> mechanics_;
  std::shared_ptr<const Geometry> geometry_;
};

// Round-off beside the other velocities is 0; a change below four digits is none.
Cell velocity_cell(const EventMet& event, size_t i) {
  double size = 0;
  for (const double v : event.velocity) size = std::max(size, std::abs(v));
  const auto clean = [size](double v) { return std::abs(v) <= 1e-12 * size ? 0. : v; };
  const double before = clean(event.velocity[i]);
  if (event.velocity_after.empty()) return before;
  const std::string first = fmt::format("{:.4g}", before),
                    then = fmt::format("{:.4g}", clean(event.velocity_after[i]));
  if (first == then) return before;
  return first + " \u2192 " + then;
}

// "beak" of "beak.strikes"; "" of a name with another end.
std::string part_of(const std::string& name, std::string_view end) {
  return name.ends_with(end) ? name.substr(0, name.size() - end.size()) : "";
}

// Strikes of a part, and the energy that they take.
struct Strikes {
  int count = 0;
  double energy = 0;
};

// By names of parts: contacts that strike at once take their energy together.
std::map<std::string, Strikes> strikes_of(const std::vector<EventMet>& events,
                                          const std::vector<std::optional<double>>& energies) {
  std::map<std::string, Strikes> out;
  for (size_t k = 0; k < events.size();) {
    const EventMet& first = events[k];
    std::string parts;
    size_t end = k;
    for (; end < events.size() && events[end].time == first.time &&
           events[end].velocity == first.velocity;
         ++end)
      if (const std::string part = part_of(events[end].name, ".strikes"); !part.empty())
        parts += (parts.empty() ? "" : ", ") + part;
    if (!parts.empty() && energies[k]) {
      ++out[parts].count;
      out[parts].energy += *energies[k];
    }
    k = end;
  }
  return out;
}

// Strikes and friction of each contact that has taken energy.
void add_taken(Page& page, const Result& r, const std::map<std::string, Strikes>& strikes) {
  std::map<std::string, std::pair<Strikes, double>> taken;
  for (const auto& [part, sum] : strikes) taken[part].first = sum;
  for (const std::string& column : r.trajectory.columns()) {
    const std::string part = part_of(column, ".friction_work");
    if (part.empty() || r.trajectory.rows() == 0) continue;
    const double work = r.trajectory.column(column).back();
    if (work != 0 || taken.contains(part)) taken[part].second = -work;
  }
  if (taken.empty()) return;
  std::vector<std::vector<Cell>> rows;
  for (const auto& [part, sum] : taken)
    rows.push_back(
        {part, static_cast<double>(sum.first.count), sum.first.energy, sum.second + 0.0});
  page.table("Energy taken at contacts",
             {"contact", "strikes", "by strikes [J]", "by friction [J]"}, rows);
}

}  // namespace

void add_events(Page& page, const Registry& registry, const Result& r) {
  if (r.events.empty()) return add_taken(page, r, {});
  const std::vector<Component> components = components_of(*r.system);
  const TakenEnergy taken(registry, r);
  bool any_taken = false;
  std::vector<std::optional<double>> energies;
  for (const EventMet& event : r.events) {
    energies.push_back(taken(event));
    any_taken = any_taken || energies.back();
  }
  const size_t n = r.events.front().velocity.size();
  const bool velocities = n <= kMostVelocities && n == components.size();
  std::vector<std::string> columns = {"name", "time [s]"};
  for (size_t i = 0; i < n && velocities; ++i)
    columns.push_back(components[i].unit.empty()
                          ? components[i].name
                          : fmt::format("{} [{}]", components[i].name, components[i].unit));
  if (any_taken) columns.emplace_back("energy taken [J]");
  std::vector<std::vector<Cell>> rows;
  for (size_t k = 0; k < r.events.size(); ++k) {
    const EventMet& event = r.events[k];
    rows.push_back({event.name, event.time});
    for (size_t i = 0; i < n && velocities; ++i) rows.back().push_back(velocity_cell(event, i));
    if (any_taken) rows.back().push_back(energies[k] ? Cell(*energies[k]) : Cell(""));
  }
  page.table("Events", columns, rows);
  add_taken(page, r, strikes_of(r.events, energies));
}

}  // namespace hamel::pages
