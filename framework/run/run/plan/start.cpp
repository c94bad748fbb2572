// Start of a run: the user's state or the system's default, onto the constraints, and the events
// there.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/metric/equations_of_motion.hpp>
#include <hamel/framework/run/run/plan/plan.hpp>
#include <hamel/framework/run/run/plan/start_names.hpp>
#include <hamel/framework/schemes/dynamic_problem.hpp>

namespace hamel {
namespace {

std::vector<double> to_vector(const Eigen::VectorXd& v) { return {v.begin(), v.end()}; }

bool finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

// The speed, or fewer numbers than velocities, give the start that the system makes of them.
SystemStart fill_from_few(const SystemModel& system, const Config& config, Mistakes& mistakes) {
  const Start& start = config.start;
  const size_t given = start.velocity.size();
  try {
    if (!config.start_values.empty()) {
      return start_by_name(system, config);
    } else if (config.speed) {
      if (!start.configuration.empty() || given > 0 || !start.momentum.empty()) {
        mistakes.add("speed: give it alone, or configuration with velocity or momentum");
      } else if (system.start_at_speed) {
        if (!system.start_pushed) return system.start_at_speed(*config.speed, config.from);
        SystemStart pushed = system.start_pushed(*config.speed, config.from);
        pushed.notes.push_back(
            fmt::format("the start is pushed, as the system's file has it: {}", system.push));
        return pushed;
      } else {
        mistakes.add(
            fmt::format("speed: {} defines no straight motion; give velocity", system.name));
      }
    } else if (given > 0 && given < static_cast<size_t>(system.group.dim) &&
               given <= system.start_parameters.size() && start.configuration.empty()) {
      return system.start_from(start.velocity, config.from);
    }
  } catch (const ConfigError& error) {
    mistakes.add(error.mistakes());
  }
  return start;
}

// The system's own start at this time; mistakes are added.
SystemStart own_start(const SystemModel& system, double from, Mistakes& mistakes) {
  if (from == 0 || !system.start_from) return system.start;
  try {
    return system.start_from({}, from);
  } catch (const ConfigError& error) {
    mistakes.add(error.mistakes());
    return system.start;
  }
}

}  // namespace

Snapshot state_of(const Start& start, double t) {
  Snapshot out;
  out.time = t;
  out.coordinates = start.configuration;
  out.velocity = start.velocity;
  return out;
}

std::vector<double> admissible(const SystemModel& system,
                               const std::shared_ptr<const Geometry>& geometry,
                               const EventState& state, const std::string& event) {
  const auto n = static_cast<Eigen::Index>(system.group.dim);
  const auto refuse = [&](const std::string& why) {
    throw ConfigError({fmt::format("on_event {}: at t = {:.6g} {}", event, state.time, why)});
  };
  if (static_cast<Eigen::Index>(state.velocity.size()) != n)
    refuse(fmt::format("velocity: got {} values, expected {}", state.velocity.size(), n));
  if (!finite(state.velocity)) refuse("velocity: " + join(state.velocity) + " is not finite");
  try {
    (void)element_of(system.group, state.coordinates);
  } catch (const std::invalid_argument& error) {
    refuse(error.what());
  }
  Eigen::VectorXd xi = Eigen::Map<const Eigen::VectorXd>(state.velocity.data(), n);
  const auto& mechanics = system.mechanics;
  if (geometry == nullptr || mechanics->constraint_count() == 0) return to_vector(xi);
  EquationsOfMotion<DynamicProblem> motion(DynamicProblem(geometry, mechanics));
  Eigen::VectorXd g(geometry->size());
  geometry->from_coordinates(state.coordinates, g.data());
  Eigen::VectorXd phi(mechanics->holonomic_rows());
  mechanics->holonomic(g.data(), phi);
  if (phi.size() > 0 && !(phi.lpNorm<Eigen::Infinity>() < 1e-6))
    refuse(fmt::format("the holonomic constraints do not hold, |phi| = {:.2g}",
                       phi.lpNorm<Eigen::Infinity>()));
  motion.set(state.time, g);
  motion.project(xi);
  return to_vector(xi);
}

namespace {

constexpr size_t kMostNames = 24;  // in a message

// Checks the numbers of a velocity or momentum.
void check_datum(const SystemModel& system, const char* name, const std::vector<double>& values,
                 bool few, Mistakes& mistakes) {
  const auto n = static_cast<size_t>(system.group.dim);
  if (values.empty()) return;
  if (values.size() != n) {
    const auto& parameters = system.start_parameters;
    const std::string shorter =
        parameters.empty() || !few
            ? ""
            : fmt::format(", or {} without a configuration", join(parameters));
    std::vector<std::string> names;
    for (const Component& component : components_of(system)) names.push_back(component.name);
    const std::string named = n <= kMostNames ? fmt::format(" ({})", join(names)) : "";
    mistakes.add(fmt::format("{}: got {} values, expected {}{} for {}{}", name, values.size(), n,
                             named, system.group.name, shorter));
  } else if (!finite(values)) {
    mistakes.add(fmt::format("{}: {} is not finite", name, join(values)));
  }
}

}  // namespace

// The user's start, else the system's own, else rest at the identity.
PlannedStart plan_start(const SystemModel& system, const Config& config, Mistakes& mistakes) {
  PlannedStart out;
  SystemStart given = fill_from_few(system, config, mistakes);
  const auto take_notes = [&](const SystemStart& of) {
    out.notes = of.notes;
    if (!config.slip)
      out.notes.insert(out.notes.begin(), of.notes_of_projection.begin(),
                       of.notes_of_projection.end());
  };
  take_notes(given);
  out.start = std::move(given);
  Start& start = out.start;
  if (!start.velocity.empty() && !start.momentum.empty())
    mistakes.add("start: give velocity or momentum, not both");
  const bool whole =
      !start.configuration.empty() && (!start.velocity.empty() || !start.momentum.empty());
  const SystemStart own = whole ? SystemStart{} : own_start(system, config.from, mistakes);
  if (start.velocity.empty() && start.momentum.empty()) {
    take_notes(own);
    start.velocity = own.velocity;
    start.momentum = own.momentum;
    if (start.velocity.empty() && start.momentum.empty()) {
      mistakes.add(
          fmt::format("start: {} has no default start; give velocity or momentum", system.name));
    }
  }
  if (start.configuration.empty()) start.configuration = own.configuration;
  if (start.configuration.empty()) start.configuration = system.group.identity;
  try {
    start.configuration = element_of(system.group, start.configuration);
  } catch (const std::invalid_argument& error) {
    mistakes.add(fmt::format("configuration: {}", error.what()));
    start.configuration = system.group.identity;
    out.refused = true;
  }
  check_datum(system, "velocity", start.velocity, true, mistakes);
  check_datum(system, "momentum", start.momentum, false, mistakes);
  return out;
}

}  // namespace hamel
