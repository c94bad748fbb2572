// The run whose equations are asked for, at the state asked for last. Not installed.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <hamel/framework/analysis/equations.hpp>
#include <hamel/framework/analysis/recorded_motion.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/run/driver.hpp>
#include <hamel/framework/run/run/rows/reactions.hpp>

namespace hamel {

struct Equations::Insides {
  Simulation simulation;
  Run run;
  const RunPlan& plan;
  const Mechanics& mechanics;
  std::unique_ptr<Reactions> motion;  // of systems with rows or without
  // Formulas of a type whose rates are differences, in a run without inputs: null where there is
  // none.
  std::shared_ptr<const RecordedMotion> recorded;
  Eigen::VectorXd g, xi;
  Snapshot state;

  static std::vector<double> numbers_of(const Eigen::VectorXd& x) {
    return {x.data(), x.data() + x.size()};
  }
  static void check_numbers(const char* name, const std::vector<double>& got, int expected,
                            std::vector<std::string>& mistakes) {
    if (static_cast<int>(got.size()) != expected)
      mistakes.push_back(
          fmt::format("{}: got {} numbers, expected {}", name, got.size(), expected));
    else if (!std::ranges::all_of(got, [](double x) { return std::isfinite(x); }))
      mistakes.push_back(fmt::format("{}: expected finite numbers", name));
  }

  explicit Insides(const Simulation& of)
      : simulation(of),
        run(of.build()),
        plan(run.driver().plan()),
        mechanics(*plan.setup.mechanics) {
    if (plan.geometry == nullptr)
      throw ConfigError({fmt::format(
          "equations: the group of {} is not registered: its equations are its own types'",
          plan.system->name)});
    motion = std::make_unique<Reactions>(plan.geometry, plan.setup.mechanics, plan.setup.inputs,
                                         plan.contacts);
    g.setZero(plan.geometry->size());
    xi.setZero(mechanics.dim());
    put({}, 0);
    if (!mechanics.exact_rates() && plan.setup.inputs == nullptr)
      recorded = RecordedMotion::of(*plan.system, plan.geometry, g);
  }

  Eigen::MatrixXd inertia() const {
    Eigen::MatrixXd out(mechanics.dim(), mechanics.dim());
    mechanics.inertia(g.data(), out);
    return out;
  }

  // The coordinates of g tau(eta).
  std::vector<double> moved(const Eigen::VectorXd& from, const Eigen::VectorXd& eta) const {
    Eigen::VectorXd there(from.size());
    plan.geometry->tau(eta.data(), there.data());
    plan.geometry->compose(from.data(), there.data(), there.data());
    std::vector<double> out(static_cast<size_t>(plan.geometry->columns()));
    plan.geometry->coordinates(there.data(), out.data());
    return out;
  }

  void put(const Start& given, double t) {
    const Start& usual = plan.config.start;
    const bool by_momentum = !given.momentum.empty();
    std::vector<std::string> mistakes;
    state.time = t;
    state.element.clear();
    state.coordinates = given.configuration.empty() ? usual.configuration : given.configuration;
    state.velocity = given.velocity.empty() ? usual.velocity : given.velocity;
    if (!std::isfinite(t)) mistakes.push_back(fmt::format("t: got {}, expected a finite time", t));
    if (by_momentum && !given.velocity.empty())
      mistakes.emplace_back("state: expected a velocity or a momentum, not both");
    check_numbers("configuration", state.coordinates, plan.geometry->columns(), mistakes);
    check_numbers("velocity", state.velocity, mechanics.dim(), mistakes);
    if (by_momentum) check_numbers("momentum", given.momentum, mechanics.dim(), mistakes);
    if (!mistakes.empty()) throw ConfigError(mistakes);
    try {
      plan.geometry->from_coordinates(state.coordinates, g.data());
    } catch (const std::invalid_argument& error) {
      throw ConfigError({fmt::format("configuration: {}", error.what())});
    }
    if (by_momentum) {
      const Eigen::Map<const Eigen::VectorXd> mu(given.momentum.data(), mechanics.dim());
      state.velocity = numbers_of(inertia().llt().solve(mu));
    }
    xi = Eigen::Map<const Eigen::VectorXd>(state.velocity.data(), mechanics.dim());
  }
};

}  // namespace hamel
