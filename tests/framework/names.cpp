// Names: what the registry makes when it is asked for, and which kinds of files it holds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include <hamel/framework/run/names/registry.hpp>
#include <hamel/simulate.hpp>

namespace hamel {
namespace {

// A deferred system is described once, when its name is first asked for, whoever asks.
TEST(Registry, DescribesDeferredSystemsWhenAsked) {
  Registry mine;
  std::atomic<int> made = 0;
  mine.add_deferred("late", [&made] {
    ++made;
    SystemInfo info;
    info.name = "late";
    return info;
  });
  EXPECT_THAT(mine.systems_and_files(), testing::ElementsAre("late"));
  EXPECT_EQ(mine.system("later"), nullptr);
  EXPECT_EQ(made, 0);
  std::vector<std::jthread> asking;
  for (int k = 0; k < 4; ++k) asking.emplace_back([&mine] { (void)mine.system("late"); });
  asking.clear();
  ASSERT_NE(mine.system("late"), nullptr);
  EXPECT_EQ(mine.system("late")->name, "late");
  EXPECT_EQ(made, 1);
}

// Kinds of files are the registry's, not the process's.
TEST(Registry, HoldsItsKindsOfFiles) {
  EXPECT_TRUE(Registry().file_kinds().empty());
  ASSERT_EQ(registry().file_kinds().size(), 1u);
  EXPECT_EQ(registry().file_kinds().front().keys.front(), "body");
}

TEST(ByName, ListsAndDescribes) {
  EXPECT_THAT(systems(), testing::IsSupersetOf({"suslov", "bicycle", "n_trailer"}));
  EXPECT_THAT(schemes(), testing::IsSupersetOf({"lift", "dop853"}));
  EXPECT_THAT(retractions("so3"), testing::IsSupersetOf({"cayley", "exp"}));
  EXPECT_THAT(retractions("se2*so2^5"), testing::Contains("cayley"));
  const SystemDescription segway = describe_system("segway");
  EXPECT_EQ(segway.velocities.size(), 6u);
  EXPECT_EQ(segway.inputs.size(), 2u);
  for (const std::string& name : systems()) {
    const SystemDescription d = describe_system(name);
    EXPECT_EQ(d.name, name);
    EXPECT_FALSE(d.coordinates.empty()) << name;
    EXPECT_FALSE(d.velocities.empty()) << name;
  }
  EXPECT_THROW(describe_system("suslof"), ConfigError);
}

}  // namespace
}  // namespace hamel
