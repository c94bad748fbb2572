// Runs with contacts: what is refused, the start, events and records, runs by hand and resumed.
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/run/run.hpp>
#include <hamel/systems/by_name.hpp>

#include "refusal.hpp"

namespace hamel {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Simulation ball() { return simulate("rolling_ball").set("friction", 0.2).set("restitution", 0.5); }
Start thrown(double z) {
  return {.configuration = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, z}, .velocity = {0, 6, 0, 2, 0, -1}};
}

TEST(BadContacts, ParametersOutOfRange) {
  const auto refused = [](const char* name, double value) {
    return refusal([&] { (void)ball().set(name, value).run(); });
  };
  EXPECT_THAT(refused("friction", -0.1),
              AllOf(HasSubstr("parameter 'friction' of rolling_ball: got -0.1"),
                    HasSubstr("expected at least 0")));
  EXPECT_THAT(refused("restitution", 1.5),
              AllOf(HasSubstr("parameter 'restitution' of rolling_ball: got 1.5"),
                    HasSubstr("expected in [0, 1]")));
  EXPECT_THAT(refusal([] { (void)simulate("falling_disk").set("restitution", 0.5).run(); }),
              HasSubstr("'restitution': set friction too"));
  EXPECT_THAT(refusal([] { (void)simulate("falling_disk").set("frction", 0.5).run(); }),
              HasSubstr("friction"));
}

TEST(BadContacts, SchemesWithoutDenseOutput) {
  EXPECT_THAT(refusal([] { (void)ball().scheme("lift").run(); }),
              AllOf(HasSubstr("scheme: lift has no dense output"), HasSubstr("dop853")));
  EXPECT_THAT(refusal([] { (void)ball().scheme("dop853").step(0.01).run(); }),
              HasSubstr("step: got 0.01, expected rtol"));
  EXPECT_THAT(refusal([] { (void)ball().until(-1).run(); }), HasSubstr("until: got -1"));
}

TEST(BadContacts, Starts) {
  EXPECT_THAT(refusal([] { (void)ball().start(thrown(0.4)).run(); }),
              AllOf(HasSubstr("contact 'contact' of rolling_ball is 0.1 m below its ground")));
  EXPECT_THAT(refusal([] { (void)simulate("suslov").slip().run(); }),
              HasSubstr("slip: no contact of suslov may slide"));
  EXPECT_THAT(refusal([] { (void)ball().events({"contact.slide"}).run(); }),
              HasSubstr("contact.slides"));
}

TEST(Contacts, TheStartIsProjectedWithoutSlip) {
  Start start = thrown(0.5);
  const Result projected = ball().start(start).until(0.1).run();
  EXPECT_THAT(projected.notes, testing::Contains(HasSubstr("projected")));
  EXPECT_TRUE(projected.events.empty());  // it rolls
  const Result slips = ball().start(start).slip().until(0.1).run();
  ASSERT_FALSE(slips.events.empty());
  EXPECT_EQ(slips.events[0].name, "contact.strikes");
  EXPECT_EQ(slips.events[0].time, 0);
  // Above its ground nothing is projected.
  const Result falls = ball().start(thrown(1)).until(0.01).run();
  EXPECT_EQ(falls.config.start.velocity, thrown(1).velocity);
}

// Not set, the system is the same as ever.
TEST(Contacts, WithoutFrictionNothingChanges) {
  const Result r = simulate("rolling_ball").until(1).run();
  EXPECT_EQ(r.system->group.name, "so3*r2");
  EXPECT_EQ(r.record().find("contact.mode"), std::string::npos);
  EXPECT_TRUE(r.system->contact_laws.empty());
  EXPECT_EQ(r.config.parameters.count("friction"), 0U);
}

TEST(Contacts, RunsEndAtASwitch) {
  const Result r = ball().start(thrown(1)).stop_at({"contact.strikes"}).until(5).run();
  EXPECT_TRUE(r.stopped_by_event);
  EXPECT_EQ(r.status.reason, "stopped at contact.strikes");
  ASSERT_EQ(r.events.size(), 1U);
  EXPECT_EQ(r.last.time, r.events[0].time);
  EXPECT_EQ(r.last.velocity, r.events[0].velocity_after);
  EXPECT_NEAR(r.events[0].velocity_after[5], -0.5 * r.events[0].velocity[5], 1e-12);
  EXPECT_THAT(r.record(), HasSubstr("velocity_after"));
}

// Events of the user beside switches: the height of a bounce, and no crossing by an impact.
TEST(Contacts, EventsBesideSwitches) {
  const Result r =
      ball().set("restitution", 1).start(thrown(1)).slip().events({"z'<0"}).until(1.3).run();
  std::vector<std::string> names;
  for (const EventMet& e : r.events) names.push_back(e.name);
  EXPECT_THAT(names, testing::ElementsAre("contact.strikes", "z'<0", "contact.strikes", "z'<0"));
}

TEST(Contacts, ByHand) {
  hamel::Run run = ball().start(thrown(1)).tolerance({.relative = 1e-10}).build();
  const Result whole = ball().start(thrown(1)).tolerance({.relative = 1e-10}).until(2).run();
  EXPECT_TRUE(run.advance_to(0.7).ok);
  EXPECT_TRUE(run.advance_to(2).ok);
  EXPECT_EQ(run.events().size(), whole.events.size());
  for (size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(run.state({}).velocity[i], whole.last.velocity[i], 1e-8);
  run.restart(thrown(1));
  EXPECT_TRUE(run.advance_to(2).ok);
  EXPECT_EQ(run.events().size(), whole.events.size());
  EXPECT_THAT(refusal([&] { run.turn_back(); }), HasSubstr("turn_back: "));
}

TEST(Contacts, TheErrorIsEstimated) {
  const Result r = ball().start(thrown(1)).with(&Config::check, true).until(2).run();
  EXPECT_TRUE(std::isfinite(r.estimated_error));
  EXPECT_LT(r.estimated_error, 1e-5);
}

}  // namespace
}  // namespace hamel
