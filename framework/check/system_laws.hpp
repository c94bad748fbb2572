// The laws of a system, measured: `hamel::check_system(MySystem{})` on the type, with the equations
// of motion; `hamel::check_system(registry, "my_system")` by name, everything that needs no group
// algebra.
//
// Bounds: algebraic 1e-12 relative; derivatives along the exact motion 1e-9 relative, by central
// differences of order 6 with step 4e-3 (round-off 1e-13, truncation below 1e-10 for rates up to
// 10); the exact motion against lift composed to order 8, 1e-9.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/check/group_laws.hpp>
#include <hamel/framework/check/system_samples.hpp>
#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/framework/run/names/registry.hpp>

namespace hamel {

/// Matrices, start, exact motion and invariants of an erased system.
LawReport check_system(const SystemModel& model, double until = 5,
                       const Geometry* geometry = nullptr);

/// A registered system: the laws above for its defaults, its parameters, and its exact motion
/// against lift composed to order 8. ConfigError on an unknown name.
LawReport check_system(const Registry& registry, const std::string& name, double until = 5);

/// The differentials of potential, holonomic rows and inertia, automatic or by hand, against
/// sixth-order differences along g tau(e eta) with step 4e-3 (error below 1e-9).
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
template <System S, class R = check::FirstRetraction<typename S::Group>>
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
  const check::Matrices given = check::matrices_at(model, &geometry, start.configuration);
  const Mat<n, n> inertia = given.inertia;
  const Eigen::MatrixXd e = hamel_frame(given.inertia, given.rows);
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
