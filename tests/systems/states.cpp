// Scalar states of mechanisms: lags, integrals, relaxation lengths; they act on nothing by
// themselves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <hamel/hamel.hpp>

#include "../framework/run/refusal.hpp"

namespace hamel {
namespace {

using testing::HasSubstr;

std::vector<double> column(const Result& run, const std::string& name) {
  return run.trajectory.column(name);
}

// A hinge that turns at a constant rate.
Mechanism arm(double rate) {
  Mechanism m("arm");
  m.body("arm", {.mass = 2, .at = {0.3, 0, 0.5}, .inertia = {1, 1, 1}});
  m.hinge("turn", kWorld, "arm", {});
  m.start("turn.rate", rate);
  return m;
}

// z' = (w t - z)/T: z = w (t - T) + w T exp(-t/T). A second one follows the first, along the angle:
// y' = (z - y) angle'/L, y = exp(-a/L) int z exp(a/L) da/L.
TEST(States, LagsFollowClosedForms) {
  const double w = 1.3, lag = 0.4;
  for (const char* scheme :
       {"lift", "balance", "rk4_projected", "rkmk4", "dopri5", "tsit5", "dop853"}) {
    SCOPED_TRACE(scheme);
    Mechanism m = arm(w);
    m.state("z", {.rate = "(turn.angle - z)/T", .unit = "rad", .constants = {{"T", {lag}}}});
    m.state("turned", {.rate = "2*turn.rate"});
    m.state("relaxed", {.rate = "(1 - relaxed)*turn.rate/0.5"});
    const Result run = simulate(m).scheme(scheme).step(1e-3).until(2).run();
    ASSERT_TRUE(run.status.ok) << run.status.reason;
    // Of order 2: h^2/12 of third derivatives, 1/T^2.
    for (size_t i = 0; i < run.trajectory.rows(); i += 100) {
      const double t = column(run, "t")[i];
      EXPECT_NEAR(column(run, "turn.angle")[i], w * t, 1e-11);
      EXPECT_NEAR(column(run, "z")[i], w * (t - lag) + w * lag * std::exp(-t / lag), 1e-6);
      EXPECT_NEAR(column(run, "turned")[i], 2 * w * t, 1e-10);
      EXPECT_NEAR(column(run, "relaxed")[i], 1 - std::exp(-w * t / 0.5), 1e-6);
      EXPECT_NEAR(column(run, "z.reaction1")[i], 0, 1e-10);
    }
  }
}

// The torque of a motor that lags behind its law: I w' = m, m' = (u - m)/T.
TEST(States, ActInForces) {
  const double lag = 0.3, u = 0.7, inertia = 1 + 2 * 0.09;
  Mechanism m = arm(0);
  m.gravity({0, 0, 0});
  m.state("m", {.rate = "(0.7 - m)/0.3", .unit = "N m"});
  m.motor(
      "turn", [](const SignalInput& now) { return now.coordinates[1]; }, false);
  const Result run = simulate(m).scheme("lift").step(1e-3).until(1).run();
  ASSERT_TRUE(run.status.ok) << run.status.reason;
  EXPECT_NEAR(column(run, "turn.rate").back(), u / inertia * (1 - lag * (1 - std::exp(-1 / lag))),
              1e-6);
  EXPECT_LT(run.energy_error_max, 1e-5);  // of the balance
}

// Beside a state that acts on nothing a vehicle moves as without it.
TEST(States, ChangeNoOtherMotion) {
  const auto scooter = [](bool with, const char* scheme) {
    Mechanism m("scooter");
    m.body("deck", {.mass = 5, .at = {0.3, 0, 0.1}, .inertia = {0.3, 0.4, 0.5}});
    m.body("fork", {.mass = 2, .at = {0.7, 0, 0.4}, .inertia = {0.1, 0.1, 0.01}});
    m.planar("road", "deck");
    m.hinge("steer", "deck", "fork", {.at = {0.7, 0, 0}});
    m.blade("rear", "deck", {.at = {0, 0, 0}});
    m.blade("front", "fork", {.at = {0.7, 0, 0}});
    if (with) m.state("s", {.rate = "v1*cos(steer.angle) + 0.3 - s"});
    m.start({{"v1", 2}, {"steer.angle", 0.3}, {"steer.rate", -0.2}});
    return simulate(m).scheme(scheme).step(1e-3).until(2).run();
  };
  for (const char* scheme : {"lift", "dop853", "rkmk4"}) {
    const Result with = scooter(true, scheme), without = scooter(false, scheme);
    ASSERT_TRUE(with.status.ok) << with.status.reason;
    for (const char* name : {"x", "y", "theta", "steer.angle", "v1", "rear.reaction1"})
      EXPECT_NEAR(column(with, name).back(), column(without, name).back(), 1e-9) << name;
    for (const std::string& note : with.notes) EXPECT_THAT(note, Not(HasSubstr("s.rate")));
  }
}

// A single-track car on tyres with a relaxation length: the rate of a steady turn is that without
// one, v delta/(L + v^2 m/L (b/Cf - a/Cr)), to the square of the angles. Source: Pacejka, Tire and
// Vehicle Dynamics (2006), ch. 1.
TEST(States, TyresWithARelaxationLength) {
  const double a = 1.2, b = 1.4, cf = 8e4, cr = 9e4, mass = 1200, v = 15, delta = 0.002;
  Mechanism m("car");
  m.body("car", {.mass = mass, .inertia = {300, 1500, 1600}});
  m.planar("road", "car");
  const Parameters constants = {{"a", {a}}, {"b", {b}}, {"delta", {delta}}, {"sigma", {0.4}}};
  m.state("front", {.rate = "(v2 + a*omega - delta*v1 - front*v1)/sigma", .constants = constants});
  m.state("rear", {.rate = "(v2 - b*omega - rear*v1)/sigma", .constants = constants});
  const auto side = [&](double x, double stiffness, size_t slip) {
    return ForceOptions{
        .at = {x, 0, 0},
        .along = {nullptr,
                  [=](const SignalInput& now) { return -stiffness * now.coordinates[slip]; },
                  nullptr},
        .of_body = true,
        .time_dependent = false};
  };
  m.force("front tyre", "car", side(a, cf, 3));
  m.force("rear tyre", "car", side(-b, cr, 4));
  m.start("v1", v);
  const Result run = simulate(m).scheme("lift").step(2e-3).until(6).run();
  ASSERT_TRUE(run.status.ok) << run.status.reason;
  const double speed = column(run, "v1").back(), length = a + b,
               rate = speed * delta / (length + speed * speed * mass / length * (b / cf - a / cr));
  EXPECT_NEAR(column(run, "omega").back(), rate, 1e-4 * rate);
  EXPECT_NEAR(column(run, "front").back(), (column(run, "v2").back() + a * rate) / speed - delta,
              1e-7);
}

TEST(States, MistakesAreNamed) {
  const auto refused = [](const std::string& name, const std::string& rate) {
    return refusal([&] {
      Mechanism m = arm(1);
      m.state(name, {.rate = rate});
      m.model();
    });
  };
  EXPECT_THAT(refused("z", "turn.rate^2"),
              HasSubstr("state 'z': rate: is not linear in the rates"));
  EXPECT_THAT(refused("z", "turn.rat"), HasSubstr("did you mean 'turn.rate'"));
  EXPECT_THAT(refused("z", "z > 0 ? 1 : 0"),
              HasSubstr("state 'z': rate: expected a formula without"));
  EXPECT_THAT(refused("z", ""), HasSubstr("state 'z': rate: not given"));
  EXPECT_THAT(refused("turn", "1"), HasSubstr("state 'turn': this name is taken"));
  EXPECT_THAT(refused("a b", "1"), HasSubstr("allowed in a formula"));
}

}  // namespace
}  // namespace hamel
