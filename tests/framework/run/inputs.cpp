// The inputs of a run: what they do to a motion that is known in closed form, on which side of a
// jump a step lies, their work in the energy balance, and what bad ones get.
//
// The cart of differential_drive runs straight under equal torques u on both wheels: M v' = 2 u /
// R, M = m + 2 J_w / R^2. In a step with a constant torque lift, balance, their compositions and
// rkmk4 are exact in v, so the bound is round-off: 1e-12 over 200 steps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

#include <hamel/groups/product_retraction.hpp>
#include <hamel/hamel.hpp>
#include <hamel/systems/segway.hpp>

#include "refusal.hpp"

namespace hamel {
namespace {

using testing::HasSubstr;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kSeen = 1e-12;

// v of the cart per impulse of a torque on both wheels.
constexpr double kGain = 2 / 0.1 / (5.0 + 2 * 0.01 / 0.01);

Simulation cart(const InputSignal& torque) {
  return simulate("differential_drive")
      .start({.velocity = {0, 0.5, 0, 5, 5}})
      .input("right_torque", torque)
      .input("left_torque", torque)
      .step(0.01)
      .until(2);
}

// Jumps at multiples of the step that are no sums of it in floating point.
const InputTable kHeld = {{0, 0.3, 0.7, 1.1, 2}, {0.2, -0.1, 0.4, 0, 0}, true};
constexpr double kHeldImpulse = 0.3 * 0.2 - 0.4 * 0.1 + 0.4 * 0.4;
const InputTable kLinear = {{0, 0.3, 0.7, 2}, {0, 0.6, 0.2, 0.2}, false};
constexpr double kLinearImpulse = 0.5 * 0.3 * 0.6 + 0.4 * 0.4 + 1.3 * 0.2;

struct Method {
  const char *scheme, *compose;
};
constexpr Method kMethods[] = {{"lift", "none"},    {"lift", "suzuki4"}, {"lift", "kahan_li6"},
                               {"balance", "none"}, {"rkmk4", "none"},   {"dopri5", "none"}};

TEST(InputsOfARun, DriveTheCartExactly) {
  for (const Method& method : kMethods) {
    const auto speed = [&](const InputSignal& torque) {
      Simulation run = cart(torque);
      const Result result = run.scheme(method.scheme).compose(method.compose).run();
      EXPECT_TRUE(result.status.ok) << result.status.reason;
      return result.last.velocity[1];
    };
    SCOPED_TRACE(std::string(method.scheme) + ", " + method.compose);
    EXPECT_NEAR(speed(0.3), 0.5 + kGain * 0.6, kSeen);
    EXPECT_NEAR(speed(kHeld), 0.5 + kGain * kHeldImpulse, kSeen);
    if (std::string(method.scheme) == "lift") {  // the trapezoidal rule
      EXPECT_NEAR(speed(kLinear), 0.5 + kGain * kLinearImpulse, kSeen);
    }
  }
}

// Steps chosen by the error end where a held input jumps: a step across would not be exact,
// whatever its tolerance.
TEST(InputsOfARun, EndChosenStepsAtTheirJumps) {
  for (const char* scheme : {"dopri5", "dop853", "lift"}) {
    Simulation run = cart(kHeld);
    const Result r = run.scheme(scheme).tolerance({.relative = 1e-3}).run();
    ASSERT_TRUE(r.status.ok) << scheme << ": " << r.status.reason;
    EXPECT_NEAR(r.last.velocity[1], 0.5 + kGain * kHeldImpulse, kSeen) << scheme;
    EXPECT_LT(r.energy_balance_error_max, 1e-10) << scheme;
    const std::vector<double> t = r.trajectory.column("t");
    for (const double jump : {0.3, 0.7, 1.1})
      EXPECT_NE(std::find(t.begin(), t.end(), jump), t.end()) << scheme << ", " << jump;
  }
}

// And where a line bends: the power has a kink there, and a quadrature across would be far off.
TEST(InputsOfARun, EndChosenStepsAtTheirKinks) {
  const InputTable bent = {{0, 0.3, 0.7, 1}, {0, 0.6, 0.2, 0.5}, false};
  Simulation run = simulate("snakeboard");
  run.scheme("dopri5").input("rotor_rate", bent).input("front_rate", bent).until(1);
  const Result r = run.tolerance({.relative = 1e-8}).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  EXPECT_LT(r.energy_balance_error_max, 1e-7);
  const std::vector<double> t = r.trajectory.column("t");
  for (const double kink : {0.3, 0.7}) EXPECT_NE(std::find(t.begin(), t.end(), kink), t.end());
}

// The same run backwards: a step that ends at a jump sees the value before it, in its own
// direction.
TEST(InputsOfARun, RunBackwards) {
  for (const InputSignal& torque : {InputSignal(kHeld), InputSignal(kLinear)}) {
    const Result there = cart(torque).run();
    Simulation run = cart(torque);
    const Result back =
        run.start({.configuration = there.last.coordinates, .velocity = there.last.velocity})
            .from(2)
            .step(-0.01)
            .until(0)
            .run();
    ASSERT_TRUE(back.status.ok) << back.status.reason;
    EXPECT_NEAR(back.last.velocity[1], 0.5, kSeen);
    EXPECT_NEAR(back.last.coordinates[1], 0, kSeen);
  }
}

// Rates that are given by lines: their b(t) is differentiated by differences, which must not see
// the kinks at the nodes nor the end of the table, which is that of the run.
TEST(InputsOfARun, KeepTheOrderWhereTheirLinesMeetAtNodes) {
  const auto end = [](double h) {
    const InputTable bent = {{0, 0.3, 0.7, 1}, {0, 0.6, 0.2, 0.5}, false};
    const Result r = simulate("snakeboard")
                         .scheme("rkmk4")
                         .input("rotor_rate", bent)
                         .input("front_rate", bent)
                         .step(h)
                         .until(1)
                         .run();
    EXPECT_TRUE(r.status.ok) << r.status.reason;
    return Eigen::Map<const Eigen::VectorXd>(r.last.velocity.data(), 6).eval();
  };
  const Eigen::VectorXd fine = end(0.0025);
  const double coarse = (end(0.02) - fine).norm(), half = (end(0.01) - fine).norm();
  EXPECT_NEAR(std::log2(coarse / half), 4, 0.2);
}

// The work of the torques is that of a quadrature which begins anew where the power jumps. rkmk4 is
// exact in x too.
TEST(InputsOfARun, DoWorkThatTheEnergyBalanceCounts) {
  for (const long every : {1L, 7L, 50L}) {
    const Result r = cart(kHeld).scheme("rkmk4").every(every).run();
    const double v = r.last.velocity[1];
    EXPECT_NEAR(r.work, 0.5 * 7 * (v * v - 0.25), kSeen) << every;
    EXPECT_LT(r.energy_balance_error_max, kSeen) << every;
    const Result kinked = cart(kLinear).scheme("rkmk4").every(every).run();
    EXPECT_LT(kinked.energy_balance_error_max, 1e-10)
        << every;  // v of degree 3 in a step of order 4
  }
}

TEST(InputsOfARun, AreThoseOfTypedAndErasedProblems) {
  const InputTable table = {{0, 0.5, 1}, {1, -2, 0.5}, false};
  const auto end = [&](Simulation run) {
    run.input("right_torque", 0.7).input("left_torque", table);
    return run.step(0.01).until(1).run().last;
  };
  const Snapshot named = end(simulate("segway"));
  const Snapshot typed = end(simulate<Lift, Cayley>(Segway{}));
  const Snapshot erased = end(simulate("segway").retraction("second_kind_symmetric"));
  for (size_t i = 0; i < named.velocity.size(); ++i) {
    EXPECT_NEAR(named.velocity[i], typed.velocity[i], 1e-11);
    EXPECT_NEAR(named.velocity[i], erased.velocity[i], 2e-3);  // another tau, order 2
  }
  EXPECT_GT(std::abs(end(simulate("segway")).velocity[0] -
                     simulate("segway").step(0.01).until(1).run().last.velocity[0]),
            0.01);
}

// Inputs that are zero leave the motion alone, though the problem is another.
TEST(InputsOfARun, OfZeroChangeNothing) {
  for (const std::string name : {"differential_drive", "roller_racer", "segway", "snakeboard"}) {
    const SystemInfo& system = *registry().system(name);
    ASSERT_FALSE(system.inputs.empty()) << name;
    Simulation driven = simulate(name).step(0.01);
    for (const InputField& input : system.inputs) driven.input(input.name, 0);
    const Result with = driven.until(1).run(), without = simulate(name).step(0.01).until(1).run();
    ASSERT_TRUE(with.status.ok) << name;
    for (size_t i = 0; i < with.last.velocity.size(); ++i)
      EXPECT_NEAR(with.last.velocity[i], without.last.velocity[i], 1e-11) << name;
    for (const InputField& input : system.inputs) {
      Simulation pushed = simulate(name).step(0.01);
      EXPECT_GT(euclidean_distance(pushed.input(input.name, 1).until(1).run().last.velocity,
                                   without.last.velocity),
                1e-3)
          << name << ", " << input.name << " does nothing";
    }
  }
}

// What is known of the motion without inputs is not compared with.
TEST(InputsOfARun, AreNotComparedWithTheMotionWithoutThem) {
  const Result r = cart(0.1).run();
  EXPECT_FALSE(r.system->exact);
  EXPECT_TRUE(r.invariants.empty());
  EXPECT_TRUE(std::isnan(r.exact_error_max));
}

std::string refused(const InputSignal& signal) {
  return refusal([&] { (void)cart(signal).build(); });
}

TEST(InputsOfARun, AreCheckedBeforeAnythingRuns) {
  const auto given = [](const char* system, const char* name) {
    return refusal([&] { (void)simulate(system).input(name, 1).build(); });
  };
  EXPECT_THAT(given("segway", "rigth_torque"), HasSubstr("did you mean 'right_torque'?"));
  EXPECT_THAT(given("suslov", "torque"), HasSubstr("input 'torque': suslov has no inputs"));
  EXPECT_THAT(refused(std::nan("")),
              HasSubstr("input 'left_torque' of differential_drive: got nan"));
  EXPECT_THAT(refused(InputTable{{0, 1, 1, 2}, {0, 0, 0, 0}}),
              HasSubstr("row 3: the time 1 comes after 1, expected increasing times"));
  EXPECT_THAT(refused(InputTable{{0, 1, 2}, {0, kInfinite, 0}}), HasSubstr("row 2: got inf"));
  EXPECT_THAT(refused(InputTable{{0, std::nan(""), 2}, {0, 0, 0}}),
              HasSubstr("row 2: the time is nan"));
  EXPECT_THAT(refused(InputTable{{0, 1.9}, {0, 0}}),
              HasSubstr("the table covers t = 0 to 1.9, expected the whole run, 0 to 2"));
  EXPECT_THAT(refused(InputTable{{0.1, 2}, {0, 0}}), HasSubstr("covers t = 0.1 to 2"));
  EXPECT_THAT(refused(InputTable{{0, 2}, {0}}), HasSubstr("2 times and 1 values"));
  EXPECT_THAT(refused(InputTable{}), HasSubstr("the table is empty"));
  EXPECT_THAT(refused(InputFile{"no_such_file.csv"}), HasSubstr("no_such_file.csv"));
  EXPECT_EQ(refused(InputTable{{-1, 3}, {0, 0}}), "accepted");
}

TEST(InputsOfARun, FilesAreReadWithTheirPlace) {
  const std::string path = testing::TempDir() + "hamel_input.csv";
  const auto read = [&](const std::string& text) {
    std::ofstream(path) << text;
    return refused(InputFile{path});
  };
  EXPECT_EQ(read("t,value\n0, 0.5\r\n# a remark\n2,0.25\n"), "accepted");
  EXPECT_THAT(read("time,value\n0,1\n"),
              HasSubstr(path + ":1: got 'time,value', expected the columns t,value"));
  EXPECT_THAT(read("t,value\n0,1\n1,\n2,1\n"),
              HasSubstr(path + ":3: got '1,', expected two numbers"));
  EXPECT_THAT(read("t,value\n0,1\n\n2,1\n"), HasSubstr(path + ":3: got ''"));
  EXPECT_THAT(read("t,value\n0,much\n"), HasSubstr(path + ":2: got '0,much'"));
  EXPECT_THAT(read("t,value\n0,1,2\n"), HasSubstr(path + ":2"));
  EXPECT_THAT(read("t,value\n0,1\n2,nan\n"), HasSubstr("row 2: got nan"));
  EXPECT_THAT(read("t,value\n0,1\n-1,1\n"), HasSubstr("row 2: the time -1 comes after 0"));
  EXPECT_THAT(read("t,value\n"), HasSubstr("the table is empty"));
  EXPECT_THAT(read(""), HasSubstr("the table is empty"));
  std::remove(path.c_str());
}

TEST(InputsOfARun, ReadAndWriteTheSame) {
  Config config;
  config.system = "segway";
  config.inputs = {{"right_torque", 2.5}, {"left_torque", kHeld}, {"x", InputFile{"a.csv", true}}};
  EXPECT_EQ(Config::from_toml(config.to_toml()).inputs, config.inputs);
  EXPECT_EQ(input_signal("-1e3"), InputSignal(-1e3));
  EXPECT_EQ(input_signal("gait.csv"), InputSignal(InputFile{"gait.csv"}));
  EXPECT_EQ(input_signal("gait.csv:hold"), InputSignal(InputFile{"gait.csv", true}));
  EXPECT_THAT(
      refusal([] { (void)Config::from_toml("system = 'segway'\n[inputs]\na = true\n", "f"); }),
      HasSubstr("f:3:5: inputs.a: expected a number"));
  EXPECT_THAT(
      refusal([] { (void)Config::from_toml("[inputs]\na = {t = [0], values = [1]}\n", "f"); }),
      HasSubstr("did you mean 'value'?"));
  const Result r = cart(kHeld).until(1).run();
  const Config on = Config::continued(r.record());
  EXPECT_EQ(on.inputs, r.config.inputs);
  EXPECT_EQ(on.until, 2);
}

TEST(Inputs, LieOnTheRightSideOfAJump) {
  Inputs inputs({{"held", "", "", {}}, {"linear", "", "", {}}}, {kHeld, kLinear});
  EXPECT_EQ(inputs.at(0)[0], 0.2);
  inputs.enter(0.29, 0.01);
  const long before = inputs.changes();
  EXPECT_EQ(inputs.at(0.30000000000000004)[0], 0.2);  // the end of the step before the jump
  inputs.enter(0.29999999999999999, 0.01);
  EXPECT_EQ(inputs.at(0.3)[0], -0.1);
  EXPECT_EQ(inputs.changes(), before + 2);
  EXPECT_NEAR(inputs.at(0.5)[1], 0.4, 1e-15);
  EXPECT_EQ(kLinear.at(7), 0.2);
  EXPECT_EQ(kHeld.at(0.3), -0.1);
  EXPECT_EQ(inputs.next_break(0, 1), 0.3);
  EXPECT_EQ(inputs.next_break(0.3, 1), 0.7);
  EXPECT_EQ(inputs.next_break(0.1 + 0.2, 1), 0.7);  // 0.30000000000000004
  EXPECT_EQ(inputs.next_break(0.7, -1), 0.3);
  EXPECT_EQ(inputs.next_break(0, -1), -kInfinite);
  EXPECT_EQ(inputs.next_break(2, 1), kInfinite);
  EXPECT_TRUE(inputs.covers(2));
  EXPECT_FALSE(inputs.covers(2.1));
  inputs.set(0, 3);
  EXPECT_EQ(inputs.at(1)[0], 3);
  EXPECT_EQ(inputs.next_break(0, 1), 0.3);  // of the lines
  EXPECT_EQ(inputs.next_break(0.7, 1), kInfinite);
}

}  // namespace
}  // namespace hamel
