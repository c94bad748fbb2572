// A fit is the same in every unit of length, mass and time: rescaled numbers, as many iterations.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <hamel/framework/inverse/fit.hpp>
#include <hamel/hamel.hpp>

#include "random_units.hpp"

namespace hamel {
namespace {

using namespace test;

/// A fit, and what the new units make of each of its numbers.
struct Case {
  Simulation simulation;
  FitRequest request = {};
  std::vector<double> units = {};
};

/// Columns of the true motion with noise of its own, the same in all units.
void record(const Simulation& truth, const std::vector<std::string>& columns,
            const std::vector<double>& units, double until, Case& out) {
  const Result result = Simulation(truth).output(until / 40).until(until).run();
  ASSERT_TRUE(result.status.ok) << result.status.reason;
  Recording recording;
  recording.name = "recorded";
  recording.columns = columns;
  recording.t = result.trajectory.column("t");
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 1e-3);
  for (size_t i = 0; i < columns.size(); ++i) {
    recording.values.push_back(result.trajectory.column(columns[i]));
    for (double& x : recording.values.back()) x += noise(random) * units[i];
  }
  out.request.recordings.push_back(std::move(recording));
}

/// Lengths beside an angle, a number of the start between bounds and one above a bound.
Case sleigh(const Units& in) {
  const double moment = in.of(2, 1, 0), speed = in.of(1, 0, -1), rate = in.of(0, 0, -1);
  const Simulation truth = simulate("chaplygin_sleigh")
                               .set("mass", in.mass)
                               .set("inertia", moment)
                               .set("offset", 0.2 * in.length)
                               .start({.velocity = {rate, speed, 0}})
                               .tolerance({.relative = 1e-11});
  Case out{truth};
  record(truth, {"omega", "v1"}, {rate, speed}, 4 * in.time, out);
  out.request.names = {{"offset", 0.25 * in.length, 0, 1 * in.length},
                       {"start.v1", 0.9 * speed, 0},
                       {"start.omega", 1.1 * rate}};
  out.units = {in.length, speed, rate};
  return out;
}

/// No angles: sizes are those of the motion. A constant input whose guess is 0.
Case cart(const Units& in) {
  const double speed = in.of(1, 0, -1), stiffness = in.of(0, 1, -2), force = in.of(1, 1, -2);
  const Simulation truth = simulate(cart_file("fit_units_cart"))
                               .set("m", 1.3 * in.mass)
                               .set("k", 0.8 * stiffness)
                               .set("l", in.length)
                               .input("force", 0.1 * force)
                               .start({.velocity = {0.4 * speed, -0.2 * speed}})
                               .tolerance({.relative = 1e-11});
  Case out{truth};
  record(truth, {"x1", "x2"}, {in.length, in.length}, 6 * in.time, out);
  out.request.names = {{"k", 1 * stiffness}, {"force", 0.0}, {"start.xi1", 0.3 * speed}};
  out.request.sigma = {{"x1", 1e-3 * in.length}};
  out.units = {stiffness, force, speed};
  return out;
}

/// Nodes between segments, whose states are unknowns too; one number that the data do not see.
Case segments(const Units& in) {
  Case out = cart(in);
  out.request.segments = 3;
  out.request.names.push_back({"start.x1", 0.0});
  out.units.push_back(in.length);
  return out;
}

/// Mass and stiffness: their common scale is not in the data.
Case scale_unseen(const Units& in) {
  Case out = cart(in);
  out.request.names = {{"k", 1 * in.of(0, 1, -2)}, {"m", 1.2 * in.mass}};
  out.simulation.input("force", 0);
  out.request.recordings.clear();
  record(out.simulation, {"x1", "x2"}, {in.length, in.length}, 6 * in.time, out);
  out.units = {in.of(0, 1, -2), in.mass};
  return out;
}

class UnitsOfAFit : public testing::TestWithParam<Case (*)(const Units&)> {};

TEST_P(UnitsOfAFit, MakeNoDifference) {
  const Case one = GetParam()(Units{});
  const Fit old = fit(one.simulation, one.request);
  ASSERT_TRUE(old.converged) << old.reason;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Units in = random_units(seed);
    SCOPED_TRACE(testing::Message()
                 << in.length << " lengths, " << in.mass << " masses, " << in.time << " times");
    const Case other = GetParam()(in);
    const Fit found = fit(other.simulation, other.request);
    ASSERT_TRUE(found.converged) << found.reason;
    // The last one may be of round-off, and more than one along what the data do not see.
    if (old.undetermined.empty()) {
      EXPECT_NEAR(static_cast<double>(found.iterations), static_cast<double>(old.iterations), 1);
    }
    EXPECT_NEAR(found.chi2, old.chi2, 1e-6 * old.chi2);
    ASSERT_EQ(found.undetermined.size(), old.undetermined.size());
    for (size_t i = 0; i < old.undetermined.size(); ++i)
      for (const auto& [name, part] : old.undetermined[i]) {
        ASSERT_TRUE(found.undetermined[i].contains(name)) << name;
        EXPECT_NEAR(found.undetermined[i].at(name), part, 1e-5) << name;
      }
    for (size_t i = 0; i < old.parameters.size(); ++i) {
      SCOPED_TRACE(old.parameters[i].name);
      const double unit = other.units[i], sigma = old.parameters[i].sigma;
      EXPECT_EQ(std::isfinite(found.parameters[i].sigma), std::isfinite(sigma));
      if (!std::isfinite(sigma)) continue;
      EXPECT_NEAR(found.parameters[i].sigma / unit, sigma, 1e-5 * sigma);
      EXPECT_NEAR(found.parameters[i].value / unit, old.parameters[i].value, 1e-3 * sigma);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fits, UnitsOfAFit, testing::Values(sleigh, cart, segments, scale_unseen));

}  // namespace
}  // namespace hamel
