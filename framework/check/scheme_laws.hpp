// The laws of a scheme, measured on a run: order against the exact motion, time reversal,
// constraint residual, group defect. For anything that hamel::Simulation can run: registered by
// name, a system object, or types of your own.
//
//   for (const auto& law :
//        hamel::check_scheme(hamel::registry(), {.system = "my_system", .s = 0.5}))
//     std::cout << law << "\n";
// On all registered systems, a scheme of your own:
// hamel::check_scheme<MyScheme>(hamel::registry()). The claims of a scheme are SchemeInfo::claim;
// no scheme is named here. Bounds: orders 0.05 (order 2 to 4), 0.1 (order 1) and 0.9
// (above 4, at large steps; tests/verification/explicit_pairs is strict), the finest pair of three
// halvings; reversal 1e-10 (each solve leaves up to 1e-13 of the momentum, some hundred of them,
// and the motion may amplify them); constraint residual 8 eps (1 + |coordinates|)/|h|, since xi is
// recovered from differences of configurations that carry several eps; group defect 1e-14 (45 eps).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/check/group_laws.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/run/run/simulation.hpp>
#include <hamel/framework/schemes/composition.hpp>

namespace hamel {

/// Errors at the final time for steps h, h/2, h/4, ...
struct OrderMeasurement {
  std::vector<double> step, configuration, velocity;

  /// log2 of the ratio of the last two errors; infinite when both are round-off (the scheme is
  /// exact there), NaN when a run failed.
  static double slope(const std::vector<double>& error, double floor = 1e-11) {
    const double coarse = error[error.size() - 2], fine = error.back();
    if (coarse < floor && fine < floor) return std::numeric_limits<double>::infinity();
    return std::log2(coarse / fine);
  }
  double configuration_order() const { return slope(configuration); }
  double velocity_order() const { return slope(velocity); }
  /// The smaller of the two.
  double order() const {
    const double a = configuration_order(), b = velocity_order();
    return std::isnan(a) || a < b ? a : b;
  }
};

/// Runs to `until` with step, step/2, ... (`halvings` times) and compares with the exact motion.
inline OrderMeasurement measure_order(Simulation simulation, double step, double until,
                                      int halvings = 3) {
  OrderMeasurement out;
  for (int k = 0; k <= halvings; ++k, step /= 2) {
    simulation.step(step).until(until).every(std::numeric_limits<int>::max());
    const Result result = simulation.run();
    const double missed = result.status.ok ? 0 : std::numeric_limits<double>::quiet_NaN();
    out.step.push_back(step);
    out.configuration.push_back(result.exact_error_final + missed);
    const auto velocity_error = result.trajectory.index("exact_velocity_error");
    out.velocity.push_back(result.trajectory.at(result.trajectory.rows() - 1, velocity_error) +
                           missed);
  }
  return out;
}

/// How far `steps` steps with h and as many with -h end from the start, configuration and velocity
/// together. The run with -h starts from the nodal velocity, so that the scheme must keep it
/// admissible: for a scheme that leaves the constraint give a system without constraints.
inline double reversal_error(Simulation simulation, long steps) {
  hamel::Run forward = simulation.build();
  const Snapshot start = forward.state();
  if (!forward.step(steps).ok) return std::numeric_limits<double>::quiet_NaN();
  const Snapshot& end = forward.state();
  simulation.start({.configuration = end.coordinates, .velocity = end.velocity, .momentum = {}});
  const double before = simulation.config().from - simulation.config().until;
  simulation.step(-simulation.config().step_or_usual()).from(end.time).until(end.time + before);
  hamel::Run backward = simulation.build();
  if (!backward.step(steps).ok) return std::numeric_limits<double>::quiet_NaN();
  const Snapshot& back = backward.state();
  double sum = 0;
  for (size_t i = 0; i < start.coordinates.size(); ++i) {
    sum += std::pow(back.coordinates[i] - start.coordinates[i], 2);
  }
  for (size_t i = 0; i < start.velocity.size(); ++i) {
    sum += std::pow(back.velocity[i] - start.velocity[i], 2);
  }
  return std::sqrt(sum);
}

/// The floor of a constraint residual that is recovered from the configurations of this run.
inline double constraint_floor(const Result& result) {
  double size = 1, smallest = 1;
  for (size_t i = 0; i < result.trajectory.rows(); ++i) {
    for (size_t j = 1; j <= result.system->group.columns.size(); ++j) {
      size = std::max(size, 1 + std::abs(result.trajectory.at(i, j)));
    }
  }
  for (const Composition& c : compositions()) {
    if (c.name == result.config.compose) smallest = std::abs(c.coefficients.back());
  }
  return 8 * std::numeric_limits<double>::epsilon() * size /
         std::abs(smallest * result.config.step_or_usual());
}

/// A run, and the steps at which it is in its asymptotic regime.
struct SchemeCase {
  std::string system = "";
  Parameters parameters = {};
  Start start = {};
  std::string scheme = "lift";
  double s = 0.5;
  std::string retraction = "cayley";
  double step = 0.05;  // the coarsest of four
  double until = 2;
  /// Has the motion no symmetry that would make a scheme better than it claims? Then claims are
  /// checked from above too. A reversible scheme has even order: one that claims an odd order must
  /// then be seen not to return.
  bool generic = true;
};

/// The run of a case; the system registered by name.
inline Simulation simulation_of(const Registry& registry, const SchemeCase& c) {
  Simulation simulation(registry, c.system);
  for (const auto& [name, value] : c.parameters) simulation.set(name, value);
  return simulation.start(c.start)
      .scheme(c.scheme)
      .s(c.s)
      .retraction(c.retraction)
      .step(c.step)
      .until(c.until);
}

/// The order of a run against the exact motion, and that claimed.
inline LawReport check_order(const Simulation& simulation, ClaimedOrder claim, double step,
                             double until, bool generic) {
  // At a high order, only large steps leave an error to measure, and they are not quite asymptotic.
  const double coarsest = claim.order > 4 ? std::fmin(8 * step, until / 4) : step;
  const int halvings = claim.order > 6 ? 1 : claim.order > 4 ? 2 : 3;
  const OrderMeasurement measured = measure_order(simulation, coarsest, until, halvings);
  const double order = measured.order(), claimed = claim.order;
  const double bound = claim.order == 1 ? 0.1 : claim.order <= 4 ? 0.05 : 0.9;
  if (claim.order == 0) {
    const bool near = measured.configuration.back() + measured.velocity.back() < 1e-2;
    return {{"does not converge, as claimed", near && generic ? 1.0 : 0.0, 0}};
  }
  const double missing = std::isnan(order) ? order : std::max(0.0, claimed - order);
  LawReport report = {{"order at least " + std::to_string(claim.order), missing, bound}};
  if (generic && claim.order <= 4) {
    report.push_back(
        {"order not above " + std::to_string(claim.order), std::max(0.0, order - claimed), bound});
  }
  return report;
}

/// The laws of a run whose scheme and retraction claim `claim` and `adapted`.
inline LawReport check_scheme(const Simulation& simulation, ClaimedOrder claim, bool adapted,
                              double step, double until, bool generic = true,
                              bool steps_admissible = true) {
  LawReport report;
  Simulation simulated = simulation;
  simulated.step(step).until(until).every(1);
  const Result result = simulated.run();
  if (claim.order > 0) report.push_back({"the run ends", result.status.ok ? 0.0 : 1.0, 0});
  report.push_back({"group defect", result.group_defect_max, 1e-14});
  const bool constrained = result.system->mechanics->constraint_count() > 0;
  if (adapted && !steps_admissible) {
    // The nodes are admissible by construction, the steps are not: nothing to measure.
  } else if (adapted) {
    report.push_back({"constraint residual, recovered from the configurations",
                      result.constraint_max, constraint_floor(result)});
  } else if (constrained && generic) {
    report.push_back({"leaves the constraint, as claimed", 1e-6 / result.constraint_max, 1});
  }
  if (result.system->exact && (adapted || !constrained)) {
    const LawReport orders = check_order(simulation, claim, step, until, generic);
    report.insert(report.end(), orders.begin(), orders.end());
  }
  if (adapted || !constrained) {
    const double error = reversal_error(simulated, std::min(50L, simulated.config().steps()));
    if (claim.reversible) {
      report.push_back({"a run with h and one with -h return to the start", error, 1e-10});
    } else if (generic && claim.order % 2 == 1 && claim.order <= 4) {
      report.push_back({"does not return to the start, as claimed", 1e-9 / error, 1});
    }
  }
  return report;
}

/// Checks a scheme by name. Throws ConfigError when a name or a number does not fit.
inline LawReport check_scheme(const Registry& registry, const SchemeCase& c) {
  const Simulation simulation = simulation_of(registry, c);
  if (const auto mistakes = simulation.mistakes(); !mistakes.empty()) throw ConfigError(mistakes);
  const SchemeInfo& scheme = *registry.scheme(c.scheme);
  const SystemModel model = registry.system(c.system)->make(c.parameters);
  const TauTraits tau = registry.geometry(model.group.name, c.retraction)->traits();
  return check_scheme(simulation, scheme.claim(c.s, tau, *model.mechanics, Config().force_at),
                      scheme.adapted, c.step, c.until, c.generic, scheme.steps_admissible);
}

/// A registered scheme on every registered system for which it is defined, from the system's own
/// start, with one retraction for each claim that it makes there: the order against dop853 at a
/// tolerance of 1e-13 (bounds 0.1 for order 1, 0.05 for 2, 0.2 for 4; two more halvings where it
/// shows late), constraint and holonomic rows where its steps are admissible, group defect,
/// reversal. That it is no better than it claims is measured where it is worst. A scheme that
/// leaves the constraint is measured on systems without rows. A law has the place where it was
/// measured in its name. ConfigError on an unknown name.
LawReport check_scheme(const Registry& registry, const std::string& scheme);

/// Checks a descriptor that need not be registered; needs <hamel/hamel.hpp>.
template <class Scheme>
LawReport check_scheme(const Registry& registry) {
  Registry with = registry;
  add_scheme<Scheme>(with);
  return check_scheme(with, Scheme::name());
}

}  // namespace hamel
