// The energy balance (M47) (M48) (M49): where forces or moving constraints do work, its defect goes
// to zero with the order of the scheme, at every recorded state and with any --every, and without
// work it is not there.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <tuple>

#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/run/run/rows/nodal_quadrature.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/product_retraction.hpp>
#include <hamel/systems/segway.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

// Held upright by its motors, which push the wheels forwards and the body back.
struct BalancedSegway : Segway {
  static std::string name() { return "balanced_segway"; }
  using Segway::force;
  Vec<6> force(const auto& g, const Vec<6>& xi) const {
    const double torque = 300 * g.template part<3>().s + 80 * xi[5];
    return {0, 0, 0, torque, torque, -2 * torque};
  }
  void invariants(auto& /*add*/) const {}
};

constexpr const char* kSkate = R"(
group = "se2"
inertia = [0.1, 1, 1]
constraints = [[0, 0, 1]]
velocity = [1.2, 0.8, 0]
force = ["-0.02*omega", "-0.3*v1", 0]
)";

Simulation skate() {
  return {registry(), "damped skate",
          OwnSystem{data_system_maker(registry(), "damped skate", kSkate)}};
}

struct Case {
  const char* name;
  std::function<Simulation()> make;
  double until;
};
std::vector<Case> cases() {
  return {{"snakeboard", [] { return simulate("snakeboard"); }, 3},
          {"roller_racer", [] { return simulate("roller_racer"); }, 3},
          {"ball_on_turntable", [] { return simulate("ball_on_turntable"); }, 3},
          {"segway with feedback", [] { return simulate(BalancedSegway{}); }, 3},
          {"damped skate", [] { return skate(); }, 3}};
}

Result run(const Case& c, const char* scheme, double h, long every = 1) {
  Simulation simulation = c.make();
  return simulation.scheme(scheme).step(h).until(c.until).every(every).run();
}

TEST(EnergyBalance, DefectHasTheOrderOfTheScheme) {
  for (const Case& c : cases()) {
    double second =
        std::numeric_limits<double>::infinity();  // of the better of two schemes of order 2
    for (const auto& [scheme, order] : {std::pair{"lift", 2.0}, {"balance", 2.0}, {"rkmk4", 4.0}}) {
      const double coarse = run(c, scheme, 0.02).energy_balance_error_max,
                   fine = run(c, scheme, 0.01).energy_balance_error_max;
      EXPECT_GT(std::log2(coarse / fine), order - 0.25) << c.name << ", " << scheme;
      const Result finest = run(c, scheme, 0.001);
      if (order == 2) second = std::min(second, finest.energy_balance_error_max);
      else EXPECT_LT(finest.energy_balance_error_max, 3e-11) << c.name;  // near round-off
      EXPECT_LT(finest.energy_balance_error_max, 3e-6) << c.name << ", " << scheme;
      EXPECT_EQ(finest.energy_balance_error_max, finest.energy_error_max) << c.name;
      EXPECT_GT(std::abs(finest.work), 1e-3) << c.name << ": forces do work here";
    }
    EXPECT_LT(second, 1e-6) << c.name;
  }
}

// Work is summed over all nodes: recording fewer rows does not change it.
TEST(EnergyBalance, DoesNotDependOnTheRowsRecorded) {
  for (const Case& c : cases()) {
    const Result all = run(c, "lift", 0.01), few = run(c, "lift", 0.01, 50);
    EXPECT_EQ(all.work, few.work) << c.name;
    const size_t error = all.trajectory.index("energy_error"), work = all.trajectory.index("work");
    for (size_t i = 0; i < few.trajectory.rows(); ++i) {
      const size_t same = std::min(50 * i, all.trajectory.rows() - 1);
      EXPECT_EQ(few.trajectory.at(i, error), all.trajectory.at(same, error)) << c.name;
      EXPECT_EQ(few.trajectory.at(i, work), all.trajectory.at(same, work)) << c.name;
    }
    EXPECT_EQ(all.trajectory.at(0, error), 0) << c.name;
  }
}

// A table that turns does work on the ball: the energy itself changes by more than a tenth.
TEST(EnergyBalance, IsNotTheChangeOfTheEnergy) {
  const Result r = run(cases()[2], "lift", 0.01);
  const size_t energy = r.trajectory.index("energy");
  double change = 0;
  for (size_t i = 0; i < r.trajectory.rows(); ++i)
    change =
        std::max(change, std::abs(r.trajectory.at(i, energy) / r.trajectory.at(0, energy) - 1));
  EXPECT_GT(change, 0.1);
  EXPECT_LT(r.energy_error_max, 1e-4);
  EXPECT_NE(r.record().find("energy balance"), std::string::npos) << "the notes";
}

// Nothing does work: no balance, and the energy error is what it was, (E - E0) / |E0|.
TEST(EnergyBalance, IsNotThereWhereTheEnergyIsKept) {
  for (const char* name : {"chaplygin_sleigh", "falling_disk", "n_trailer", "segway"}) {
    const Result r = simulate(name).until(1).run();
    EXPECT_TRUE(std::isnan(r.energy_balance_error_max)) << name;
    EXPECT_FALSE(r.trajectory.has("work")) << name;
    const auto energy = r.trajectory.column("energy"), error = r.trajectory.column("energy_error");
    for (size_t i = 0; i < energy.size(); ++i)
      EXPECT_EQ(error[i], (energy[i] - energy[0]) / std::abs(energy[0])) << name;
  }
}

// Unadapted runs as if there were no rows: those that move do no work in it.
TEST(EnergyBalance, OfASchemeWithoutRows) {
  const Result r = simulate("ball_on_turntable").scheme("unadapted").until(2).run();
  EXPECT_LT(r.energy_error_max, 1e-12);
}

TEST(NodalQuadrature, IsExactToDegreeSevenOnAnySteps) {
  const auto f = [](double t) { return 8 * std::pow(t - 0.3, 7) - 3 * t * t + 1; };
  const auto integral = [](double t) { return std::pow(t - 0.3, 8) - t * t * t + t; };
  NodalQuadrature sum;
  double t = 0;
  for (int i = 0; i < 20; ++i) {
    sum.add(t, f(t));
    if (i == 7) {  // to any time so far
      for (double at = 0; at < t; at += 0.01)
        EXPECT_NEAR(sum.value(at), integral(at) - integral(0), 1e-14) << at;
    }
    if (i >= 7) {
      EXPECT_NEAR(sum.value(t), integral(t) - integral(0), 1e-13);
      EXPECT_NEAR(sum.value(t - 0.01), integral(t - 0.01) - integral(0), 1e-13);
    }
    t += 0.03 + 0.04 * (i % 3);
  }
}

// Behind far smaller steps: the errors of the values, here 1e-9 up and down, stay what they are.
// The polynomial through eight such nodes has made 1e5 of them.
TEST(NodalQuadrature, DoesNotMagnifyErrorsWhereStepsGrow) {
  for (const double growth : {1.5, 3.0, 10.0}) {
    NodalQuadrature sum;
    double t = 0, h = 1e-6;
    for (int i = 0; i < 100; ++i) {
      sum.add(t, std::cos(t) + (i % 2 == 0 ? 1e-9 : -1e-9));
      if (sum.settled()) {
        EXPECT_NEAR(sum.value(t), std::sin(t), 2e-8) << growth << ", " << t;
      }
      h = i % 50 == 49 ? 1e-6 : std::min(0.02, h * growth);
      t += h;
    }
  }
}

// Rows between the nodes have their own work.
TEST(EnergyBalance, OfRowsAtOtherTimes) {
  const Result r = simulate("roller_racer").step(0.002).until(1).output(0.0137).run();
  EXPECT_LT(r.energy_balance_error_max, 2e-5);
  const Result nodes = simulate("roller_racer").step(0.002).until(1).run();
  EXPECT_NEAR(r.energy_balance_error_max, nodes.energy_balance_error_max,
              nodes.energy_balance_error_max);
}

// The explicit pairs take long steps, within which the power is asked for too, where the motion is
// not moved onto the constraints.
TEST(EnergyBalance, OfLongSteps) {
  for (const Case& c : cases()) {
    for (const auto& [scheme, rtol, most] :
         {std::tuple{"dopri5", 1e-7, 5e-8}, {"dop853", 1e-9, 1e-8}}) {
      const Result r = c.make().scheme(scheme).tolerance({.relative = rtol}).until(c.until).run();
      EXPECT_LT(r.trajectory.rows(), 150U) << c.name << ", " << scheme;
      EXPECT_LT(r.energy_balance_error_max, most) << c.name << ", " << scheme;
    }
  }
}

// A step that an event cuts is as long as others: the power is asked for within it, up to the
// event.
TEST(EnergyBalance, OfTheStepThatAnEventCuts) {
  const auto run = [] {
    return skate().scheme("dop853").tolerance({.relative = 1e-9}).every(1000);
  };
  for (int i = 1; i <= 9; ++i) {
    const std::string place = "x=" + std::to_string(0.07 * i);
    const Result stopped = run().stop_at({place}).until(30).run();
    ASSERT_TRUE(stopped.stopped_by_event) << place;
    EXPECT_LT(stopped.energy_balance_error_max, 1e-8) << place;
    const Result ended = run().until(stopped.last.time).run();
    EXPECT_NEAR(stopped.work, ended.work, 2e-8 * std::abs(ended.work)) << place;
  }
}

}  // namespace
}  // namespace hamel
