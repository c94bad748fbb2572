// Members of an ensemble in lanes.
#include <hamel/framework/ensemble/ensemble_plan.hpp>

#include "ensembles.hpp"

namespace {

using namespace hamel;
using namespace hamel::test;
using Law = Variation::Law;

/// Several members at once, where lanes are compiled, and one by one: also where one of them fails,
/// or the last ones do not fill a register.
TEST(LaneMembers, HaveTheBytesOfMembersOneByOne) {
  EnsembleConfig started = body();
  started.keep.push_back({"", "start.energy"});
  EnsembleConfig watched = body();  // energies of all lanes at once
  watched.keep = {{"", "max.energy_error"}, {"", "min.energy"}, {"", "max.omega1"}};
  EnsembleConfig varied = body();
  varied.vary.push_back({"inertia3", Law::uniform, {0.3, 0.6}});
  varied.run.every = 3;
  EnsembleConfig failing = body();
  failing.run.until = 5;
  failing.vary = {{"start.omega1", Law::values, {1, 4000, 2, 1, 3000, 0.5, 1.5}}};
  failing.members = 7;
  EnsembleConfig sleigh = body();
  sleigh.run.system = "chaplygin_sleigh";
  sleigh.run.parameters.clear();
  sleigh.run.scheme = "rkmk4";
  sleigh.vary = {{"offset", Law::uniform, {0.1, 0.4}}, {"start.omega", Law::normal, {0, 2}}};
  sleigh.keep = {{"", "end.theta"}, {"", "max.x"}, {"", "end.constraint"}};
  EnsembleConfig disk = sleigh;
  disk.run.system = "rolling_disk";
  disk.run.scheme = "lift";
  disk.vary = {{"radius", Law::uniform, {0.2, 0.6}}};
  disk.keep = {{"", "end.energy"}, {"", "end.x_1"}, {"", "max.constraint"}};
  EnsembleConfig rolls = disk;
  rolls.keep = {{"", "max.energy_error"}, {"", "max.energy"}};
  for (EnsembleConfig config : {started, watched, varied, failing, sleigh, disk, rolls}) {
    ASSERT_NE(ensemble::Plan(registry(), config).lanes, nullptr);  // they are used
    const Ensemble ensemble(registry(), config);
    const EnsembleResult lanes = Ensemble(ensemble).threads(1).run(),
                         alone = Ensemble(ensemble).threads(1).lanes(false).run();
    expect_same(lanes, alone);
    ASSERT_EQ(lanes.failures.size(), alone.failures.size());
    EXPECT_EQ(lanes.failures.size(), config.members == 7 ? 2 : 0);
    for (size_t i = 0; i < lanes.failures.size(); ++i) {
      EXPECT_EQ(lanes.failures[i].member, alone.failures[i].member);
      EXPECT_EQ(lanes.failures[i].time, alone.failures[i].time);
      EXPECT_EQ(lanes.failures[i].reason, alone.failures[i].reason);
    }
  }
}

/// What lanes do not give is not looked for in them.
TEST(LaneMembers, AreNotOfferedWhereMoreThanNodesIsKept) {
  for (const char* quantity : {"at(0.5).omega1", "end.iterations"}) {
    EnsembleConfig config = body();
    config.keep = {{"", quantity}};
    EXPECT_EQ(ensemble::Plan(registry(), config).lanes, nullptr) << quantity;
  }
}

}  // namespace
