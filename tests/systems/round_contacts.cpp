// Contacts of round bodies: wheels with a crown, ellipsoids; couples on bodies.
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

// All columns of both that say where a body is and how it moves.
void expect_same_motion(const Result& a, const Result& b, double near) {
  ASSERT_TRUE(a.status.ok) << a.status.reason;
  ASSERT_TRUE(b.status.ok) << b.status.reason;
  ASSERT_EQ(a.trajectory.rows(), b.trajectory.rows());
  const size_t last = a.trajectory.rows() - 1;
  for (size_t i = 0; i < 1 + a.system->group.columns.size() + 6; ++i)
    EXPECT_NEAR(a.trajectory.at(last, i), b.trajectory.at(last, i), near)
        << a.trajectory.columns()[i];
}

Config exactly(double until) {
  Config config;
  config.scheme = "dop853";
  config.rtol = 1e-13;
  config.until = until;
  config.output_times = {0, until};
  return config;
}

// Body of se3, its mass centre the origin of its joint, on one contact.
Mechanism on_ground(const std::string& kind, double height, const std::vector<double>& inertia,
                    const Point& at, const Parameters& values, double mass = 1) {
  Mechanism m("body");
  m.body("body", {.mass = mass, .at = {0, 0, height}, .inertia = inertia});
  m.free("root", "body", {.at = {0, 0, height}});
  m.contact(kind, "contact", "body", {at, values});
  return m;
}

// The default stone, whose axes of inertia are turned by 0.4 rad against its surface.
TEST(Ellipsoid, IsTheRattleback) {
  const double c = std::cos(0.4), s = std::sin(0.4), i1 = 0.012, i2 = 0.036, i3 = 0.040;
  const Mechanism m =
      on_ground("ellipsoid", 0.2 - 0.075,
                {c * c * i1 + s * s * i2, c * s * (i1 - i2), 0, s * s * i1 + c * c * i2, 0, i3},
                {0, 0, 0.2}, {{"semi_axes", {0.4, 0.2, 0.2}}});
  const Config config = exactly(4);
  const Result stone = simulate("rattleback")
                           .config([&] {
                             Config out = config;
                             out.system = "rattleback";
                             return out;
                           }())
                           .run();
  ASSERT_TRUE(stone.status.ok);
  Start start;
  const size_t columns = stone.system->group.columns.size();
  for (size_t i = 0; i < columns; ++i) start.configuration.push_back(stone.trajectory.at(0, 1 + i));
  for (size_t i = 0; i < 6; ++i) start.velocity.push_back(stone.trajectory.at(0, 1 + columns + i));
  const Result parts = simulate(m).config(config).start(start).run();
  expect_same_motion(parts, stone, 1e-10);
}

Mechanism ball_like(const std::string& kind, const Parameters& values) {
  return on_ground(kind, 0.3, {0.05, 0.02, 0.04}, {0, 0, 0.3}, values, 2);
}
const std::map<std::string, double> kTumbling = {{"w1", 0.7}, {"w2", 2.1}, {"w3", -0.4}};

// Of three equal axes, and of a crown as large as the wheel.
TEST(RoundContacts, AreSpheres) {
  const auto run = [](Mechanism m) {
    m.start(kTumbling);
    return simulate(m).config(exactly(2)).run();
  };
  const Result ball = run(ball_like("ball", {{"radius", {0.3}}}));
  expect_same_motion(run(ball_like("ellipsoid", {{"semi_axes", {0.3, 0.3, 0.3}}})), ball, 1e-10);
  expect_same_motion(
      run(ball_like("tube", {{"axle", {0, 1, 0}}, {"radius", {0.3}}, {"crown", {0.3}}})), ball,
      1e-9);
}

TEST(Tube, WithoutCrownIsAWheel) {
  const auto run = [](Mechanism m) {
    m.start({{"w1", 0.1}, {"w2", 4}, {"w3", 0.3}});
    return simulate(m).config(exactly(1)).run();
  };
  expect_same_motion(
      run(ball_like("tube", {{"axle", {0, 1, 0}}, {"radius", {0.3}}, {"crown", {0}}})),
      run(ball_like("wheel", {{"axle", {0, 1, 0}}, {"radius", {0.3}}})), 1e-11);
}

// Leaning by an angle a at a speed v ahead, a torus rolls about a vertical axis with its contact on
// a circle: its centre is at the height rho + (r - rho) cos a, which the start finds, and the point
// of contact lies (r - rho) sin a + 0 aside of the centre. The wheel turns with the rate
// v/(rho + (r - rho) ...) of the contact's circle in the wheel, of radius r - rho + rho cos a.
TEST(Tube, ContactOfATorus) {
  const double r = 0.3, rho = 0.08, lean = 0.35, rate = 5;
  Mechanism m = ball_like("tube", {{"axle", {0, 1, 0}}, {"radius", {r}}, {"crown", {rho}}});
  m.sensor("centre", "body", {0, 0, r});
  const double c = std::cos(lean), s = std::sin(lean);
  Start start;
  start.configuration = {1, 0, 0, 0, c, -s, 0, s, c, 0, 0, rho + (r - rho) * c};
  start.velocity = {0, rate, 0, (r - rho + rho * c) * rate, 0, 0};
  const Result run = simulate(m).config(exactly(0.1)).start(start).run();
  ASSERT_TRUE(run.status.ok) << run.status.reason;
  for (const std::string& note : run.notes) EXPECT_THAT(note, Not(HasSubstr("moved")));
  EXPECT_NEAR(column(run, "centre.z").front(), rho + (r - rho) * c, 1e-14);
  EXPECT_NEAR(column(run, "centre.vx").front(), (r - rho + rho * c) * rate, 1e-12);
  EXPECT_NEAR(column(run, "w2").front(), rate, 1e-12);
}

TEST(RoundContacts, MistakesAreNamed) {
  EXPECT_THAT(
      refusal([] {
        ball_like("tube", {{"axle", {0, 1, 0}}, {"radius", {0.3}}, {"crown", {0.4}}}).model();
      }),
      HasSubstr("tube 'contact': crown: got 0.4, expected at most the radius 0.3"));
  EXPECT_THAT(refusal([] {
                ball_like("ellipsoid", {{"semi_axes", {0.3, -0.2, 0.1}}}).model();
              }),
              HasSubstr("ellipsoid 'contact': semi_axes: got -0.2, expected a positive number"));
  EXPECT_THAT(refusal([] {
                ball_like("ellipsoid", {{"semi_axes", {0.3}}}).model();
              }),
              HasSubstr("got 1 numbers, expected 3"));
}

// A couple (0, 0, T) on a free body of principal moments: I3 w' = T; the same of the body about an
// axis that turns with it. Moving the body changes nothing.
TEST(Torque, IsACouple) {
  for (const bool of_body : {false, true}) {
    Mechanism m("body");
    m.gravity({0, 0, 0});
    m.body("body", {.mass = 3, .at = {0.4, -0.2, 1}, .inertia = {0.2, 0.3, 0.4}});
    m.free("root", "body", {});
    m.torque("spin", "body",
             {.along = {nullptr, nullptr, [](const SignalInput& now) { return 2 + now.t; }},
              .of_body = of_body});
    m.sensor("centre", "body", {0.4, -0.2, 1});
    const Result run = simulate(m).config(exactly(1)).run();
    ASSERT_TRUE(run.status.ok) << run.status.reason;
    EXPECT_NEAR(column(run, "w3").back(), (2 + 0.5) / 0.4, 1e-10);
    EXPECT_NEAR(column(run, "centre.x").back(), 0.4, 1e-11);
    EXPECT_NEAR(column(run, "centre.y").back(), -0.2, 1e-11);
  }
  // About a tilted axis: of the body it turns with it, of the world it does not.
  Mechanism m("arm");
  m.body("arm", {.mass = 1, .at = {1, 0, 0}, .inertia = {0.1, 0.1, 0.1}});
  m.hinge("turn", kWorld, "arm", {.axis = {0, 1, 0}});
  m.gravity({0, 0, 0});
  Mechanism world = m;
  m.torque("a", "arm", {.along = {nullptr, [](const SignalInput&) { return 1.1; }, nullptr}});
  world.torque(
      "a", "arm",
      {.along = {nullptr, [](const SignalInput&) { return 1.1; }, nullptr}, .of_body = true});
  for (const Mechanism& of : {m, world})
    EXPECT_NEAR(column(simulate(of).config(exactly(1)).run(), "turn.rate").back(), 1, 1e-11);
  m.torque("b", "arn", TorqueOptions());
  EXPECT_THAT(refusal([&] { m.model(); }), HasSubstr("torque 'b': "));
}

}  // namespace
}  // namespace hamel
