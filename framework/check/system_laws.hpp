// The laws of a system, measured: `hamel::check_system(MySystem{})` on the type, with the equations of
// motion; `hamel::check_system(registry, "my_system")` by name, everything that needs no group algebra.
//
// Bounds: algebraic 1e-12 relative; derivatives along the exact motion 1e-9 relative, by central
// differences of order 6 with step 4e-3 (round-off 1e-13, truncation below 1e-10 for rates up to 10);
// the exact motion against lift composed to order 8, 1e-9.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include <hamel/framework/check/group_laws.hpp>
#include <hamel/framework/check/system_samples.hpp>
#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/framework/run/registry.hpp>
#include <hamel/framework/run/simulation.hpp>

namespace hamel {

/// Matrices, start, exact motion and invariants of an erased system.
inline LawReport check_system(const SystemModel& model, double until = 5,
                              const Geometry* geometry = nullptr) {
  LawReport report;
  const auto initial = check::matrices_at(
      model, geometry,
      model.start.configuration.empty() ? model.group.identity : model.start.configuration);
  const Eigen::MatrixXd& inertia = initial.inertia;
  const Eigen::MatrixXd& rows = initial.rows;
  report.push_back({"inertia symmetric", (inertia - inertia.transpose()).norm() / inertia.norm(),
                    check::algebraic});
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(inertia).eigenvalues();
  report.push_back(
      {"inertia positive definite", values.minCoeff() > 1e-14 * values.maxCoeff() ? 0.0 : 1.0, 0});
  if (rows.rows() > 0) {
    const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(rows).singularValues();
    report.push_back({"constraint rows independent",
                      singular.minCoeff() > 1e-12 * singular.maxCoeff() ? 0.0 : 1.0, 0});
  }
  const Start start = check::admissible_start(model, geometry);
  if (start.velocity.empty()) return report;
  const auto& given = model.start.velocity;
  if (!given.empty()) {
    report.push_back({"the default start is admissible", check::difference(given, start.velocity),
                      check::algebraic});
  }
  report.push_back(
      {"the default configuration is an element",
       check::difference(model.group.element(start.configuration), start.configuration),
       check::algebraic});
  if (!model.exact) return report;

  for (const double sign : {1.0, -1.0}) {
    const std::string direction = sign > 0 ? "forwards" : "backwards";
    const ExactFlow flow = model.exact(start);
    const auto [g0, xi0] = flow(0);
    report.push_back(
        {"exact motion starts at the start, " + direction,
         check::difference(g0, start.configuration) + check::difference(xi0, start.velocity),
         check::algebraic});
    check::Largest residual, element;
    std::vector<check::Largest> drift(model.invariants.size());
    for (int i = 1; i <= 50; ++i) {
      const auto [g, xi] = flow(sign * until * i / 50);
      const Eigen::VectorXd velocity =
          Eigen::Map<const Eigen::VectorXd>(xi.data(), static_cast<Eigen::Index>(xi.size()));
      if (rows.rows() > 0) {
        const auto here = check::matrices_at(model, geometry, g, sign * until * i / 50);
        residual((here.rows * velocity - here.drift).norm() / (1 + velocity.norm()));
      }
      element(check::difference(model.group.element(g), g));
      for (size_t j = 0; j < drift.size(); ++j) {
        const double at_start = model.invariants[j].value(start.configuration, start.velocity);
        drift[j](std::abs(model.invariants[j].value(g, xi) - at_start) / (1 + std::abs(at_start)));
      }
    }
    report.push_back(
        {"A xi = b along the exact motion, " + direction, residual.value, check::algebraic});
    report.push_back(
        {"the exact motion stays in the group, " + direction, element.value, check::algebraic});
    for (size_t j = 0; j < drift.size(); ++j) {
      report.push_back({"exact motion keeps '" + model.invariants[j].name + "', " + direction,
                        drift[j].value, check::algebraic});
    }
  }
  return report;
}

/// A registered system: the laws above for its defaults, its parameters, and its exact motion against
/// lift composed to order 8 with the group's first symmetric retraction.
inline LawReport check_system(const Registry& registry, const std::string& name, double until = 5) {
  const SystemInfo* info = registry.system(name);
  if (info == nullptr) throw ConfigError({unknown_name("system", name, registry.systems())});
  SystemModel model = info->make({});
  if (model.group.dim == 0) model.group = *registry.group_or_product(model.group.name);
  const std::string retraction = registry.retractions_or_common(model.group.name).front();
  const auto geometry = registry.geometry(model.group.name, retraction);
  LawReport report = check_system(model, until, geometry.get());

  // Parameters: what describe shows is what a run gets, and a parameter that is set comes back.
  Parameters as_shown, changed;
  for (const Field& field : info->fields) {
    as_shown[field.name] = field.value;
    changed[field.name] = check::changed_value(*info, field);
  }
  const SystemModel again = info->make(as_shown), other = info->make(changed);
  const auto& g =
      model.start.configuration.empty() ? model.group.identity : model.start.configuration;
  const auto before = check::matrices_at(model, geometry.get(), g),
             after = check::matrices_at(again, geometry.get(), g);
  double lost = (after.inertia - before.inertia).norm() + (after.rows - before.rows).norm() +
                (after.drift - before.drift).norm();
  for (const Field& field : other.fields) {
    lost += check::difference(field.value, changed[field.name]);
  }
  report.push_back({"fields round trip", lost, 0});
  double accepted = 0;
  try {
    info->make({{"no_such_parameter", {1.0}}});
    accepted = 1;
  } catch (const ConfigError&) {
  }
  report.push_back({"an unknown parameter is refused", accepted, 0});

  if (model.exact) {
    Simulation run(registry, name);
    const Result result = run.scheme("lift")
                              .s(0.5)
                              .retraction("exp")
                              .compose("suzuki_umeno8")
                              .step(0.01)
                              .until(until)
                              .every(1000000)
                              .run();
    report.push_back({"exact motion against lift composed to order 8",
                      result.status.ok ? result.exact_error_final + result.exact_velocity_error_max
                                       : std::numeric_limits<double>::quiet_NaN(),
                      1e-9});
  }
  return report;
}

/// The differentials of potential, holonomic rows and inertia, automatic or by hand, against sixth-order
/// differences along g tau(e eta) with step 4e-3 (error below 1e-9).
template <class S, class R>
LawReport check_differentials(const S& system,
                              const typename S::Group::template Element<double>& g) {
  using G = typename S::Group;
  constexpr int n = G::dim;
  const TypedMechanics<S> mechanics(system);
  const Vec<n> direction = Vec<n>::LinSpaced(0.3, 1.1);
  const auto moved = [&](double e) { return G::compose(g, R::tau(Vec<n>(e * direction))); };
  LawReport report;
  if constexpr (requires { system.potential(g); }) {
    const double slope =
        check::derivative([&](double e) { return double(system.potential(moved(e))); }, 4e-3);
    report.push_back({"dV is the differential of V",
                      std::abs(slope - mechanics.potential_differential(g).dot(direction)) /
                          (1 + std::abs(slope)),
                      check::differentiated});
  }
  if constexpr (holonomic_count<S>() > 0) {
    constexpr int r = holonomic_count<S>();
    const Vec<r> slope =
        check::derivative([&](double e) -> Vec<r> { return system.holonomic(moved(e)); }, 4e-3);
    report.push_back({"the last rows are the differential of phi",
                      (slope - mechanics.holonomic_differential(g) * direction).norm(),
                      check::differentiated});
  }
  if constexpr (!requires { system.inertia(); }) {
    const Vec<n> xi = Vec<n>::LinSpaced(-0.7, 0.9);
    const double slope = check::derivative(
        [&](double e) -> double { return 0.5 * xi.dot(system.inertia(moved(e)) * xi); }, 4e-3);
    report.push_back({"the differential of the kinetic energy",
                      std::abs(slope - mechanics.inertia_differential(g, xi).dot(direction)) /
                          (1 + std::abs(slope)),
                      check::differentiated});
  }
  return report;
}

/// A system by its type: the laws of the erased system, and the equations of motion along its exact
/// motion, E'(I xi' - ad*_xi I xi) = 0 and g' = g xi. R: any retraction of its group, tau^-1 of
/// g(t)^-1 g(t + d) being d xi(t) to first order.
template <System S, class R = typename check::FirstRetraction<typename S::Group>::type>
LawReport check_system(const S& system, double until = 5) {
  using G = typename S::Group;
  constexpr int n = G::dim;
  const SystemModel model = erase(system);
  const TypedGeometry<R> geometry;
  LawReport report = check_system(model, until, &geometry);
  const Start start = check::admissible_start(model, &geometry);
  if constexpr (!is_left_invariant<S>()) {
    const LawReport more =
        check_differentials<S, R>(system, G::from_coordinates(start.configuration));
    report.insert(report.end(), more.begin(), more.end());
    return report;  // the equations of motion: tests/verification/lagrange_dalembert.cpp
  }
  if (!model.exact) return report;
  const check::Matrices at = check::matrices_at(model, &geometry, start.configuration);
  const Mat<n, n> inertia = at.inertia;
  const Eigen::MatrixXd e = hamel_frame(at.inertia, at.rows);
  constexpr double d = 4e-3;
  for (const double sign : {1.0, -1.0}) {
    const std::string direction = sign > 0 ? "forwards" : "backwards";
    check::Largest dynamics, kinematics;
    const ExactFlow flow = model.exact(start);
    for (int i = 0; i < 25; ++i) {
      const double centre = 3 * d + until * i / 25;
      std::vector<std::pair<std::vector<double>, std::vector<double>>> samples;
      for (int k = -3; k <= 3; ++k) samples.push_back(flow(sign * (centre + k * d)));
      const auto g = G::from_coordinates(samples[3].first);
      const Vec<n> xi = Eigen::Map<const Vec<n>>(samples[3].second.data());
      const auto at = [&](double t) -> size_t {
        return static_cast<size_t>(std::lround(sign * t / d) + 3);
      };
      const Vec<n> acceleration = check::derivative(
          [&](double t) -> Vec<n> {
            return Eigen::Map<const Vec<n>>(samples[at(t)].second.data());
          },
          d);
      const Vec<n> velocity = check::derivative(
          [&](double t) -> Vec<n> {
            return R::tau_inverse(
                G::compose(G::inverse(g), G::from_coordinates(samples[at(t)].first)));
          },
          d);
      const Vec<n> mu = inertia * xi;
      const Vec<n> balance = inertia * acceleration - G::ad(xi).transpose() * mu;
      dynamics((e.transpose() * balance).norm() / (1 + mu.norm() * xi.norm()));
      kinematics((velocity - xi).norm() / (1 + xi.norm()));
    }
    report.push_back({"E'(I xi' - ad*_xi I xi) = 0 along the exact motion, " + direction,
                      dynamics.value, check::differentiated});
    report.push_back({"g' = g xi along the exact motion, " + direction, kinematics.value,
                      check::differentiated});
  }
  return report;
}

}  // namespace hamel
