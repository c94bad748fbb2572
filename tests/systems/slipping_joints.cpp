// Brakes, dry friction, stops and walls, against closed facts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "../framework/run/refusal.hpp"
#include "slipping.hpp"

namespace hamel {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;

Mechanism flywheel(double rate) {
  Mechanism m("flywheel");
  m.body("wheel", {.mass = 1, .at = {0, 0, 1}, .inertia = {1, 1, 2}});
  m.hinge("axle", kWorld, "wheel", {.at = {0, 0, 1}});
  m.motor("axle");
  m.brake("axle");
  m.start("axle.rate", rate);
  return m;
}

// J w' = 0.5 - b(t) until it rests, b = 2 t up to t = 1, then 2, from t = 3 on 5 - t: at rest until
// b = 0.5, at t = 4.5, then J w' = t - 4.5, and 0.5 behind t = 5.
TEST(Brake, IsAnInput) {
  const auto run = [](bool jumps) {
    Simulation out = slipping(flywheel(1));
    out.input("axle.torque", 0.5);
    InputTable b;
    b.times = {0, 1, 3, 5, 8};
    b.values = {0, 2, 2, 0, 0};
    if (jumps) {
      b.times = {0, 2, 8};
      b.values = {2, 0, 0};
      b.hold = true;
    }
    out.input("axle.brake", b);
    return out.until(6).run();
  };
  const double J = 2;
  const Result r = run(false);
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  ASSERT_THAT(names(r), ElementsAre("axle.sticks", "axle.slips"));
  const double at_one = 1 + (0.5 - 1) / J, rests = 1 + at_one * J / 1.5;
  EXPECT_NEAR(time_of(r, "axle.sticks"), rests, 1e-9);
  EXPECT_NEAR(time_of(r, "axle.slips"), 4.5, 1e-9);
  EXPECT_NEAR(last(r, "axle.rate"), (0.125 + 0.5) / J, 1e-9);
  EXPECT_LT(r.energy_error_max, 1e-9);
  const Result step = run(true);
  ASSERT_TRUE(step.status.ok) << step.status.reason;
  EXPECT_NEAR(time_of(step, "axle.sticks"), J / 1.5, 1e-9);
  EXPECT_NEAR(time_of(step, "axle.slips"), 2, 1e-9);
  EXPECT_NEAR(last(step, "axle.rate"), 4 * 0.5 / J, 1e-9);
}

// J w' = 0.5 - b(t), in steps of one size that an input ends where it bends or jumps.
TEST(Brake, IsAnInputOfStepsOfOneSize) {
  const double J = 2;
  for (const bool jumps : {false, true}) {
    InputTable b{.times = {0, 1, 2}, .values = {2, 2, 0.8}};
    if (jumps) b = {.times = {0, 1, 2}, .values = {2, 0.8, 0.8}, .hold = true};
    const Result r = simulate(flywheel(2))
                         .slip()
                         .input("axle.torque", 0.5)
                         .input("axle.brake", b)
                         .scheme("nonsmooth")
                         .step(0.07)
                         .until(1.4)
                         .run();
    ASSERT_TRUE(r.status.ok) << r.status.reason;
    const double lost = jumps ? 0.3 * 0.4 : 1.5 * 0.4 - 1.2 * 0.08;
    EXPECT_NEAR(last(r, "axle.rate"), 2 - (1.5 + lost) / J, 1e-12) << jumps;
    EXPECT_EQ(r.steps, 21);  // 20, and one that ends at t = 1
  }
}

// Beside dry friction of the joint; a brake that nobody sets does nothing.
TEST(Brake, AddsToFriction) {
  Mechanism m("flywheel");
  m.body("wheel", {.mass = 1, .at = {0, 0, 1}, .inertia = {1, 1, 2}});
  m.hinge("axle", kWorld, "wheel", {.at = {0, 0, 1}, .friction = 0.3});
  m.brake("axle", {.least = 0, .most = 5});
  m.start("axle.rate", 1);
  const Result none = slipping(m).until(1).run();
  EXPECT_NEAR(last(none, "axle.rate"), 1 - 0.15, 1e-10);
  EXPECT_NEAR(last(slipping(m).input("axle.brake", 0.7).until(1).run(), "axle.rate"), 0.5, 1e-10);
  EXPECT_THAT(refusal([&] { slipping(m).input("axle.brake", -1).until(1).run(); }),
              HasSubstr("axle.brake"));
  Mechanism wrong("wrong");
  wrong.body("wheel", {.mass = 1, .at = {0, 0, 1}, .inertia = {1, 1, 2}});
  wrong.hinge("axle", kWorld, "wheel", {.at = {0, 0, 1}});
  wrong.brake("axel");
  EXPECT_THAT(refusal([&] { (void)wrong.model(); }), HasSubstr("did you mean 'axle'?"));
  wrong = flywheel(1);
  wrong.brake("axle");
  EXPECT_THAT(refusal([&] { (void)wrong.model(); }), HasSubstr("this joint has a brake already"));
}

Mechanism dry_slider(double friction) {
  Mechanism m("block");
  m.body("block", {.mass = 1, .at = {0, 0, 0.1}, .box = {0.2, 0.2, 0.2}});
  m.slider("way", kWorld, "block", {.axis = {1, 0, 0}, .friction = friction});
  m.start("way.rate", 1);
  return m;
}
TEST(DryFriction, ABlockStopsAndRests) {
  const Result r = slipping(dry_slider(2)).until(1000).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  ASSERT_THAT(names(r), ElementsAre("way.sticks"));
  EXPECT_NEAR(time_of(r, "way.sticks"), 0.5, 1e-13);
  EXPECT_NEAR(last(r, "way.position"), 0.25, 1e-13);
  EXPECT_EQ(last(r, "way.rate"), 0);
  EXPECT_LE(r.steps, 12);
}

TEST(Stops, AJointStrikesItsEnds) {
  Mechanism m("block");
  m.body("block", {.mass = 1, .at = {0, 0, 0.1}, .box = {0.2, 0.2, 0.2}});
  m.slider("way", kWorld, "block", {.axis = {1, 0, 0}, .restitution = 0.5, .stop = {-0.5, 1}});
  m.start("way.rate", 2);
  const Result r = slipping(m).until(3).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  ASSERT_THAT(names(r), ElementsAre("way.high.strikes", "way.low.strikes"));
  EXPECT_NEAR(r.events[0].time, 0.5, 1e-13);
  EXPECT_NEAR(r.events[1].time, 0.5 + 1.5, 1e-13);
  EXPECT_NEAR(last(r, "way.rate"), 0.5, 1e-13);
}

// Two masses on one rail, of which neither passes the other: e = 1 exchanges equal ones' speeds.
TEST(Walls, TwoBlocksOnARail) {
  Mechanism m("rail");
  for (const char* name : {"a", "b"}) {
    m.body(name, {.mass = 1, .at = {0, 0, 0.1}, .box = {0.2, 0.2, 0.2}});
    m.slider(name, kWorld, name, {.axis = {1, 0, 0}});
  }
  m.wall("buffer", {.distance = "b.position - a.position - width",
                    .restitution = 1,
                    .constants = {{"width", {0.2}}}});
  m.start({{"b.position", 1}, {"a.rate", 2}});
  const Result r = slipping(m).until(1).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  ASSERT_THAT(names(r), ElementsAre("buffer.strikes"));
  EXPECT_NEAR(r.events[0].time, 0.4, 1e-13);
  EXPECT_NEAR(last(r, "a.rate"), 0, 1e-13);
  EXPECT_NEAR(last(r, "b.rate"), 2, 1e-13);
}

// A mass on a spring before a wall, x = 1 + (1 + beyond) cos(t + phase).
Result swing(double beyond, double phase, double until, double tolerance) {
  Mechanism m("mass");
  m.body("mass", {.mass = 1, .at = {0, 0, 0}});
  m.slider("way", kWorld, "mass", {.axis = {1, 0, 0}, .stiffness = 1, .rest = 1});
  m.gravity({0, 0, 0});
  m.wall("wall", {.distance = "way.position", .restitution = 1});
  m.start({{"way.position", 1 + (1 + beyond) * std::cos(phase)},
           {"way.rate", -(1 + beyond) * std::sin(phase)}});
  return simulate(m).until(until).tolerance({.relative = tolerance}).slip().run();
}

TEST(Walls, AGrazingIsNoted) {
  const Result grazes = swing(-4e-10, 0, 10, 1e-13);
  EXPECT_TRUE(grazes.events.empty());
  EXPECT_THAT(grazes.notes, testing::Contains(HasSubstr("contact 'wall' comes within 4e-10 at t = "
                                                        "3.14159")));
  EXPECT_THAT(swing(-1e-8, 0, 10, 1e-13).notes,
              testing::Not(testing::Contains(HasSubstr("grazing"))));
}

// A dip of 1e-7, which lasts 1e-3 s, anywhere in a step and at its nodes too, which the phase
// moves.
TEST(Walls, AShortStrikeIsFoundWhereverItIsInAStep) {
  for (int i = 0; i < 200; ++i) {
    const double phase = 0.005 * i;
    const Result r = swing(1e-7, phase, 4 - phase, 1e-11);
    ASSERT_TRUE(r.status.ok) << r.status.reason;
    EXPECT_THAT(names(r), ElementsAre("wall.strikes")) << phase;
  }
}

// A mass on two sliders that is thrown onto a rough wall z = 0 with v along it: its bounces end at
// 2 w/g e/(1 - e) behind the first strike and take mu (1 + e) w/(1 - e) of v, then mu g a second.
Mechanism thrown_onto_a_wall(const WallOptions& wall) {
  Mechanism m("thrown");
  m.body("cart", {.mass = 0.5, .at = {0, 0, 0.02}});
  m.body("stone", {.mass = 2, .at = {0, 0, 0.02}, .sphere = 0.01});
  m.slider("way", kWorld, "cart", {.axis = {1, 0, 0}});
  m.slider("height", "cart", "stone", {.axis = {0, 0, 1}});
  m.wall("table", wall);
  m.start({{"height.position", 0.02}, {"way.rate", 3}, {"height.rate", 0}});
  return m;
}

TEST(SlippingWall, BouncesRubsAndSticks) {
  const double mu = 0.2, e = 0.4, w = std::sqrt(2 * kGravity * 0.02), mass = 2.5, stone = 2;
  const Result r = slipping(thrown_onto_a_wall({.distance = "height.position",
                                                .restitution = e,
                                                .friction = mu,
                                                .slip = "way.rate"}))
                       .until(3)
                       .run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  const double part = stone / mass;  // of the stone's impulses, on both bodies
  const double lands = w / kGravity * (1 + 2 * e / (1 - e)),
               left = 3 - part * mu * (1 + e) * w / (1 - e);
  EXPECT_NEAR(time_of(r, "table.sticks"), lands + left / (part * mu * kGravity), 1e-7);
  EXPECT_NEAR(last(r, "way.rate"), 0, 1e-12);
  EXPECT_LT(last(r, "table.friction_work"), 0);
  EXPECT_LT(r.energy_error_max, 1e-8);
  EXPECT_NEAR(last(r, "table.reaction1"), stone * kGravity, 1e-9);
  // Apart from the wall nothing rubs.
  EXPECT_EQ(r.trajectory.column("way.rate").front(), 3);
}

TEST(SlippingWall, MistakesAreNamed) {
  const auto refused = [](const WallOptions& o) {
    return refusal([&] { (void)thrown_onto_a_wall(o).model(); });
  };
  EXPECT_THAT(refused({.distance = "height.position", .friction = 0.3}),
              HasSubstr("wall 'table': friction: a distance has no point that slips"));
  EXPECT_THAT(refused({.distance = "height.position", .slip = "way.rate"}),
              HasSubstr("slip: expected friction beside it"));
  EXPECT_THAT(refused({.distance = "height.position", .friction = -1, .slip = "way.rate"}),
              HasSubstr("friction: got -1, expected at least 0"));
  EXPECT_THAT(refused({.distance = "height.position", .friction = 0.1, .slip = "way.position"}),
              HasSubstr("slip: expected a formula of rates of joints"));
}

}  // namespace
}  // namespace hamel
