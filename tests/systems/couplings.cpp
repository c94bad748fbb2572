// Couplings of joints: gears, racks, linkages, differentials, against equations by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/mechanisms/mechanism_file.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

// Wheels a, b, c that turn about vertical axes with these moments.
Mechanism rotors(const std::vector<double>& moments) {
  Mechanism m("rotors");
  const std::vector<std::string> names = {"a", "b", "c"};
  for (size_t i = 0; i < moments.size(); ++i) {
    const double j = moments[i];
    const Point at = {static_cast<double>(i), 0, 0};
    m.body(names[i], {.mass = 1, .at = at, .inertia = {j, j, j}});
    m.hinge(names[i], kWorld, names[i], {.at = at});
  }
  return m;
}

// A line through the joints on the body that carries them.
TEST(Couplings, AreDrawn) {
  Mechanism m("cart");
  m.body("cart", {.mass = 2, .at = {0, 0, 0.5}, .inertia = {1, 1, 1}});
  m.planar("road", "cart");
  for (const double x : {0.3, -0.4}) {
    const std::string name = x > 0 ? "front" : "rear";
    m.body(name, {.mass = 1, .at = {x, 0, 0.5}, .inertia = {0.1, 0.1, 0.1}});
    m.hinge(name, "cart", name, {.at = {x, 0, 0.5}});
  }
  m.coupling("belt", {.joint = "front", .to = "rear"});
  const SystemModel model = m.model();
  const auto belt = std::ranges::find(model.drawing.bodies, "belt", &DrawnBody::name);
  ASSERT_NE(belt, model.drawing.bodies.end());
  const Placement turned = belt->place(std::vector<double>{std::acos(-1) / 2, 5, 7, 0, 0});
  EXPECT_NEAR(turned.position[0], 5, 1e-12);
  EXPECT_NEAR(turned.position[1], 7, 1e-12);
  EXPECT_NEAR(turned.rotation(1, 0), 1, 1e-12);
}

double column(const Result& result, const std::string& name) {
  return result.trajectory.column(name).back();
}

// b = r a + c: (J_a + r^2 J_b) a'' = torque on a, the gear's torque on b is J_b b''.
TEST(Couplings, GearAcceleratesAsOneBody) {
  const double r = -2.5, ja = 0.3, jb = 0.05, torque = 1.2, until = 2;
  Mechanism m = rotors({ja, jb});
  m.coupling("gear", {.joint = "b", .to = "a", .ratio = r, .offset = 0.1});
  m.motor(
      "a", [=](const SignalInput&) { return torque; }, false);
  m.start("a.angle", 0.2);
  const double acceleration = torque / (ja + r * r * jb);
  const double angle = 0.2 + 0.5 * acceleration * until * until;
  for (const char* scheme : {"dop853", "lift", "balance", "rkmk4"}) {
    SCOPED_TRACE(scheme);
    const Result out = simulate(m).scheme(scheme).step(0.01).until(until).run();
    ASSERT_TRUE(out.status.ok) << out.status.reason;
    EXPECT_NEAR(column(out, "a.angle"), angle, 1e-11);
    EXPECT_NEAR(column(out, "b.angle"), r * angle + 0.1, 1e-11);  // many turns behind the start
    EXPECT_NEAR(column(out, "a.rate"), acceleration * until, 1e-11);
    EXPECT_NEAR(column(out, "gear.reaction1"), jb * r * acceleration, 1e-10);
    EXPECT_LE(out.holonomic_max, 1e-13);
  }
}

// Coordinates that are not given follow; both given, they have to fit.
TEST(Couplings, StartFits) {
  Mechanism m = rotors({1, 1});
  m.coupling("gear", {.joint = "b", .to = "a", .ratio = 3, .offset = 1});
  m.start({{"b.angle", 7}, {"a.rate", 2}});
  const SystemModel model = m.model();
  EXPECT_NEAR(model.start.configuration[0], 2, 1e-12);
  EXPECT_NEAR(model.start.velocity[1], 6, 1e-12);
  m.start({{"b.angle", 7}, {"a.angle", 2.5}});
  try {
    m.model();
    FAIL() << "two coordinates that do not fit";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("coupling 'gear' (couples joints) with a.angle = "
                                   "2.5, b.angle = 7 cannot be reached, 1.5 is left"));
  }
}

// x = R theta, x along the gravity of a slope: (m + J/R^2) x'' = m g, as of a body that rolls.
TEST(Couplings, RackAndPinion) {
  const double mass = 2, moment = 0.04, radius = 0.1, g = 3, until = 1.5;
  Mechanism m("rack");
  m.gravity({g, 0, 0});
  m.body("rack", {.mass = mass, .inertia = {1, 1, 1}});
  m.slider("rack", kWorld, "rack", {.axis = {1, 0, 0}});
  m.body("pinion", {.mass = 1, .inertia = {moment, moment, moment}});
  m.hinge("pinion", kWorld, "pinion", {.axis = {0, 1, 0}});
  m.coupling("mesh", {.joint = "rack", .to = "pinion", .ratio = radius});
  const Result out = simulate(m).step(0.01).until(until).run();
  ASSERT_TRUE(out.status.ok) << out.status.reason;
  const double x = 0.5 * mass * g / (mass + moment / (radius * radius)) * until * until;
  EXPECT_NEAR(column(out, "rack.position"), x, 1e-12);
  EXPECT_NEAR(column(out, "pinion.angle"), x / radius, 1e-11);
}

// Crank a, slider x = r cos a + sqrt(l^2 - r^2 sin^2 a): one freedom, (J + m x_a^2) a'' + m x_a
// x_aa a'^2 = 0, whose energy is 1/2 (J + m x_a^2) a'^2. The time of a turn is its quadrature.
struct SliderCrank {
  double moment = 0.5, mass = 0.8, r = 0.3, l = 1;

  Mechanism by_parts() const {
    Mechanism m("slider-crank");
    m.body("crank", {.mass = 1, .inertia = {moment, moment, moment}});
    m.hinge("crank", kWorld, "crank", {});
    m.body("slide", {.mass = mass, .at = {r + l, 0, 0}, .inertia = {1, 1, 1}});
    m.slider("slide", kWorld, "slide", {.axis = {1, 0, 0}});
    m.coupling("rod", {.formula = "slide.position + r + l - r*cos(crank.angle) - sqrt(l^2 - "
                                  "(r*sin(crank.angle))^2)",
                       .constants = {{"r", {r}}, {"l", {l}}}});
    m.start({{"crank.angle", 0.4}, {"crank.rate", 3}});
    return m;
  }
  double slope(double a) const {  // x_a
    const double s = r * std::sin(a), c = r * std::cos(a);
    return -s - s * c / std::sqrt(l * l - s * s);
  }
  double inertia(double a) const { return moment + mass * slope(a) * slope(a); }
  // The time from one angle to another, Simpson's rule.
  double time(double from, double to) const {
    const double momentum = std::sqrt(inertia(from)) * 3;
    const int n = 4000;
    const double h = (to - from) / n;
    double out = 0;
    for (int i = 0; i <= n; ++i)
      out += (i == 0 || i == n ? 1 : i % 2 == 1 ? 4 : 2) * std::sqrt(inertia(from + i * h));
    return out * h / 3 / momentum;
  }
};

TEST(Couplings, LinkageByFormula) {
  const SliderCrank crank;
  const double to = 0.4 + 9, until = crank.time(0.4, to);
  const Mechanism m = crank.by_parts();
  const Result out = simulate(m).tolerance({.relative = 1e-12}).until(until).run();
  ASSERT_TRUE(out.status.ok) << out.status.reason;
  EXPECT_NEAR(column(out, "crank.angle"), to, 1e-9);
  EXPECT_LE(out.holonomic_max, 1e-13);
  // Order 2 of the discrete scheme, on the same motion.
  std::array<double, 2> errors{};
  for (const int k : {0, 1}) {
    const double steps = k == 0 ? 400 : 800;
    const Result lift = simulate(m).scheme("lift").step(until / steps).until(until).run();
    ASSERT_TRUE(lift.status.ok) << lift.status.reason;
    EXPECT_LE(lift.holonomic_max, 1e-13);
    errors[static_cast<size_t>(k)] = column(lift, "crank.angle") - to;
  }
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.1);
}

// a' + b' = 2 c' of a differential: with the multiplier l, J_a a'' = l, J_b b'' = l, J_c c'' =
// torque - 2 l; so l (1/J_a + 1/J_b + 4/J_c) = 2 torque/J_c.
TEST(Couplings, DifferentialByRates) {
  const double ja = 0.2, jb = 0.7, jc = 0.1, torque = 0.4, until = 3;
  Mechanism m = rotors({ja, jb, jc});
  m.coupling("differential", {.rates = "a.rate + b.rate - 2*c.rate"});
  m.motor(
      "c", [=](const SignalInput&) { return torque; }, false);
  const double l = 2 * torque / jc / (1 / ja + 1 / jb + 4 / jc);
  const Result out = simulate(m).step(0.01).until(until).run();
  ASSERT_TRUE(out.status.ok) << out.status.reason;
  EXPECT_NEAR(column(out, "a.rate"), l / ja * until, 1e-12);
  EXPECT_NEAR(column(out, "b.rate"), l / jb * until, 1e-12);
  EXPECT_NEAR(column(out, "c.rate"), (torque - 2 * l) / jc * until, 1e-12);
  EXPECT_NEAR(column(out, "differential.reaction1"), l, 1e-12);
}

// Rates with coefficients of coordinates are nonholonomic: y' = tan(theta) x' of a blade, on two
// sliders and a hinge, moves as the sleigh with its mass centre at the blade.
TEST(Couplings, RatesWithCoefficientsSteer) {
  const double mass = 2, moment = 0.3, v = 1.5, omega = 0.8, until = 1.2;
  Mechanism m("sleigh of sliders");
  m.body("cart", {.mass = 0, .inertia = {0, 0, 0}});
  m.body("body", {.mass = mass, .inertia = {1, 1, moment}});
  m.body("middle", {.mass = 0, .inertia = {0, 0, 0}});
  m.slider("x", kWorld, "cart", {.axis = {1, 0, 0}});
  m.slider("y", "cart", "middle", {.axis = {0, 1, 0}});
  m.hinge("turn", "middle", "body", {});
  m.coupling("blade", {.rates = "cos(turn.angle)*y.rate - sin(turn.angle)*x.rate"});
  m.start({{"turn.rate", omega}, {"x.rate", v}});
  const Result out = simulate(m).tolerance({.relative = 1e-12}).until(until).run();
  ASSERT_TRUE(out.status.ok) << out.status.reason;
  const double angle = omega * until;
  EXPECT_NEAR(column(out, "turn.angle"), angle, 1e-10);
  EXPECT_NEAR(column(out, "x.position"), v / omega * std::sin(angle), 1e-9);
  EXPECT_NEAR(column(out, "y.position"), v / omega * (1 - std::cos(angle)), 1e-9);
}

TEST(Couplings, HeldJointStays) {
  Mechanism m = rotors({1, 1});
  m.motor(
      "a", [](const SignalInput&) { return 1.0; }, false);
  m.hold("a");
  m.hold("b", 0.75);
  m.start("a.angle", 0.25);
  m.body("c", {.mass = 1, .inertia = {1, 1, 1}});
  m.hinge("c", kWorld, "c", {});
  m.start("c.rate", 1);
  const Result out = simulate(m).step(0.1).until(2).run();
  ASSERT_TRUE(out.status.ok) << out.status.reason;
  EXPECT_EQ(column(out, "a.angle"), 0.25);
  EXPECT_NEAR(column(out, "b.angle"), 0.75, 1e-14);
  EXPECT_NEAR(column(out, "c.angle"), 2, 1e-13);
  EXPECT_NEAR(column(out, "a.reaction1"), -1, 1e-13);  // holds against the motor
}

TEST(Couplings, MistakesAreNamed) {
  const auto mistakes = [](const CouplingOptions& o) {
    Mechanism m = rotors({1, 1});
    m.coupling("gear", o);
    try {
      m.model();
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  using testing::HasSubstr;
  EXPECT_THAT(mistakes({.joint = "a", .to = "bb"}), HasSubstr("did you mean 'b'"));
  EXPECT_THAT(mistakes({.joint = "a", .to = "a"}), HasSubstr("expected two joints"));
  EXPECT_THAT(mistakes({.joint = "a"}), HasSubstr("to (hinge or slider): missing"));
  EXPECT_THAT(mistakes({}), HasSubstr("expected one of"));
  EXPECT_THAT(mistakes({.joint = "a", .to = "b", .rates = "a.rate"}), HasSubstr("expected one of"));
  EXPECT_THAT(mistakes({.offset = 1, .formula = "a.angle"}), HasSubstr("ratio and offset"));
  EXPECT_THAT(mistakes({.formula = "a.angle - b.rate"}), HasSubstr("'b.rate' is a velocity"));
  EXPECT_THAT(mistakes({.formula = "a.angel"}), HasSubstr("did you mean 'a.angle'"));
  EXPECT_THAT(mistakes({.formula = "1 + 1"}), HasSubstr("a formula of coordinates of joints"));
  EXPECT_THAT(mistakes({.formula = "abs(a.angle) > 1 ? a.angle : b.angle"}),
              HasSubstr("without comparisons"));
  EXPECT_THAT(mistakes({.rates = "a.rate*b.rate"}), HasSubstr("is not linear in the rates"));
  EXPECT_THAT(mistakes({.rates = "a.rate + 1"}), HasSubstr("has a term without a rate"));
  EXPECT_THAT(mistakes({.rates = "a.angle"}), HasSubstr("a formula of rates"));
  EXPECT_EQ(mistakes({.rates = "sin(a.angle)*a.rate - b.rate"}), "none");
}

// Two that contradict each other, two that are one.
TEST(Couplings, ContradictAndRepeat) {
  Mechanism m = rotors({1, 1});
  m.coupling("gear", {.joint = "a", .to = "b", .ratio = 2});
  m.coupling("belt", {.joint = "b", .to = "a", .ratio = 0.5});
  const auto mistakes = [&] {
    try {
      m.model();
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_THAT(mistakes(), testing::HasSubstr("coupling 'belt' (couples joints) is implied by "
                                             "coupling 'gear' (couples joints)"));
  m.redundant("drop");
  EXPECT_EQ(mistakes(), "none");
  m.coupling("chain", {.joint = "b", .to = "a", .ratio = 0.5, .offset = 0.2});
  EXPECT_THAT(mistakes(), testing::AllOf(testing::HasSubstr("coupling 'gear'"),
                                         testing::HasSubstr("coupling 'chain'"),
                                         testing::HasSubstr("cannot be reached")));
}

}  // namespace
}  // namespace hamel
