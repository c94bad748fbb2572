// Messages about inconsistent parts of a mechanism, before anything runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include <fmt/format.h>

#include "mechanism_systems.hpp"

namespace hamel {
namespace {

using testing::HasSubstr;

std::string refused(const Mechanism& mechanism) {
  try {
    mechanism.model();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "nothing";
}

TEST(Mechanisms, SayWhatIsWrongWithTheirParts) {
  Mechanism m("cart");
  m.body("cart", {.mass = 1, .inertia = {1, 1, 1}});
  m.body("wheel", {.mass = 1, .at = {0, 0, 0.3}, .inertia = {1, 1, 1}});
  m.planar("floor", "cart");
  m.hinge("axle", "cart", "wheeel", {.axis = {0, 1, 0}});
  EXPECT_THAT(refused(m), HasSubstr("joint 'axle': unknown child 'wheeel': expected one of cart, "
                                    "wheel; did you mean 'wheel'?"));
  Mechanism loose("loose");
  loose.body("a", {.mass = 1, .inertia = {1, 1, 1}});
  EXPECT_THAT(refused(loose), HasSubstr("body 'a': hangs on no joint"));
  Mechanism circle("circle");
  circle.body("a", {.mass = 1, .inertia = {1, 1, 1}});
  circle.body("b", {.mass = 1, .inertia = {1, 1, 1}});
  circle.hinge("ab", "a", "b", {});
  circle.hinge("ba", "b", "a", {});
  EXPECT_THAT(refused(circle), HasSubstr("'ab', 'ba' go round in a circle"));
  Mechanism high("high");
  high.body("wheel", {.mass = 1, .at = {0, 0, 0.3}, .inertia = {1, 1, 1}});
  high.free("space", "wheel", {.at = {0, 0, 0.3}});
  high.wheel("wheel", "wheel", {.at = {0, 0, 0.32}, .radius = 0.3});
  EXPECT_THAT(refused(high),
              HasSubstr("does not touch the ground z = 0 as drawn: its lowest point is at 0.02 m"));
  Mechanism flat("flat");
  flat.body("wheel", {.mass = 1, .at = {0, 0, 0.3}, .inertia = {1, 1, 1}});
  flat.free("space", "wheel");
  flat.wheel("wheel", "wheel", {.at = {0, 0, 0.3}, .axle = {0, 0, 1}, .radius = 0.3});
  EXPECT_THAT(refused(flat), HasSubstr("wheel 'wheel': axle: is vertical"));
  Mechanism light("light");
  light.body("a", {.mass = 1, .inertia = {1, 1, 1}});
  light.body("tip", {.mass = 0});
  light.planar("floor", "a");
  light.hinge("end", "a", "tip", {.at = {1, 0, 0}});
  EXPECT_THAT(refused(light), HasSubstr("body 'tip' and all that it carries have no inertia"));
  Mechanism without("without");
  without.body("a", {.inertia = {1, 1, 1}});
  without.planar("floor", "a");
  EXPECT_THAT(refused(without), HasSubstr("body 'a': mass: not given"));
  Mechanism twice = by_parts::racer({});
  twice.motor("steer");
  twice.motor("steer");
  EXPECT_THAT(refused(twice), HasSubstr("motor 'steer': this joint is driven by an input already"));
  Mechanism bar("bar");
  bar.body("a", {.mass = 1, .inertia = {1, 1, 3}});
  bar.planar("floor", "a");
  EXPECT_THAT(bar.model().notes,
              testing::Contains(HasSubstr("no rigid body has the principal moments 1,1,3")));
}

TEST(Mechanisms, FindRowsThatSayNothingNew) {
  const Mechanism dropping = by_parts::drive({});
  EXPECT_EQ(dropping.model().mechanics->constraint_count(), 3);
  EXPECT_THAT(dropping.model().notes,
              testing::Contains(HasSubstr(
                  "row dropped: wheel 'left' (does not slip sideways) is implied by wheel 'right' "
                  "(does not slip sideways); the reactions there include that of wheel 'left'")));
  Mechanism refusing = dropping;
  refusing.redundant("refuse");
  EXPECT_THAT(refused(refusing), HasSubstr("redundant row: wheel 'left' (does not slip sideways)"));
  // Four balls under a stiff table in space: three contacts hold it, and what turns on it moves.
  Mechanism table("table");
  table.body("top", {.mass = 1, .at = {0, 0, 0.5}, .inertia = {1, 1, 1}});
  table.free("space", "top", {.at = {0, 0, 0.5}});
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      table.ball(fmt::format("leg {} {}", x, y), "top", {.at = {x, y, 0.1}, .radius = 0.1});
    }
  }
  EXPECT_THAT(refused(table), HasSubstr("redundant row"));
  table.redundant("drop");
  EXPECT_THAT(refused(table), HasSubstr("the parts leave no motion, 6 independent rows"));
  table.body("lamp", {.mass = 1, .at = {0, 0, 0.6}, .inertia = {1, 1, 1}});
  table.hinge("turn", "top", "lamp", {});
  EXPECT_EQ(table.model().mechanics->holonomic_rows(), 3);
}

// A user's program may state what no file can.
TEST(Mechanisms, RefuseNumbersThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto with = [](auto change) {
    Mechanism m("cart");
    m.body("a", {.mass = 1, .sphere = 1});
    m.body("b", {.mass = 1, .at = {1, 0, 0}, .sphere = 1});
    m.planar("floor", "a");
    change(m);
    return refused(m);
  };
  EXPECT_THAT(with([&](Mechanism& m) { m.hinge("h", "a", "b", {.damping = nan}); }),
              HasSubstr("joint 'h': damping: got nan, expected finite numbers"));
  const auto fault = [&](auto change) {
    return with([&](Mechanism& m) {
      m.hinge("h", "a", "b", {});
      change(m);
    });
  };
  EXPECT_EQ(fault([](Mechanism&) {}), "nothing");
  EXPECT_THAT(fault([&](Mechanism& m) { m.spring("s", "a", "b", {.stiffness = nan}); }),
              HasSubstr("spring 's': stiffness: got nan"));
  EXPECT_THAT(fault([&](Mechanism& m) {
                m.gravity({0, nan, 0});
              }),
              HasSubstr("cart: gravity: got 0,nan,0"));
  EXPECT_THAT(fault([&](Mechanism& m) { m.ground(nan); }),
              HasSubstr("cart: ground's rate: got nan"));
  EXPECT_THAT(fault([&](Mechanism& m) {
                m.start({{"v1", nan}});
              }),
              HasSubstr("start 'v1': value: got nan"));
  EXPECT_THAT(fault([&](Mechanism& m) {
                m.blade("k", "a", {.at = {0, nan, 0}});
              }),
              HasSubstr("blade 'k': at: got 0,nan,0"));
  const auto contact = [&](const std::string& kind, const Parameters& values) {
    return fault([&](Mechanism& m) { m.contact(kind, "c", "b", {.values = values}); });
  };
  EXPECT_THAT(
      contact("weel", {}),
      HasSubstr("contact 'c': unknown kind 'weel': expected one of ball, blade, ellipsoid, point, "
                "roller, tube, wheel; did you mean 'wheel'?"));
  EXPECT_THAT(contact("wheel", {}),
              HasSubstr("wheel 'c': radius: got 0, expected a positive number"));
  EXPECT_THAT(contact("roller", {{"radius", {1}}, {"angle", {nan}}}),
              HasSubstr("roller 'c': angle: got nan, expected a finite number"));
  EXPECT_THAT(contact("ball", {{"radius", {1}}, {"axle", {0, 1, 0}}}),
              HasSubstr("ball 'c': unknown value 'axle': expected one of radius"));
  EXPECT_THAT(contact("blade", {{"along", {1, 0}}}),
              HasSubstr("blade 'c': along: got 2 numbers, expected 3"));
  EXPECT_THAT(contact("blade", {{"along", {0, 0, 0}}}),
              HasSubstr("blade 'c': along: got (0,0,0), expected a direction"));
  EXPECT_THAT(with([&](Mechanism& m) {
                m.joint("hinge", "h", "a", "b", {.values = {{"pitch", {0.1}}}});
              }),
              HasSubstr("joint 'h': unknown value 'pitch': there are none"));
}

}  // namespace
}  // namespace hamel
