// Mechanisms by name that are made again: what was assembled before is used again by one run at a
// time, and no run sees what another left behind.
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include <hamel/hamel.hpp>

namespace hamel {
namespace {

std::vector<double> numbers_of(const Result& result) {
  const std::span<const double> rows = result.trajectory.values();
  return {rows.begin(), rows.end()};
}

Result run_of(const std::string& name, const std::string& scheme, double faster = 1) {
  Simulation simulation = simulate(name);
  simulation.scheme(scheme).step(0.005).until(0.1);
  Start start = simulation.build().config().start;
  for (double& x : start.velocity) x *= faster;
  return simulation.start(start).run();
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

// The mechanics of one user, and of the next.
TEST(AssembledModels, AreUsedAgainByOneAtATime) {
  const Parameters wide = {{"wheelbase", {1.2}}};
  const SystemInfo& bicycle = *registry().system("bicycle");
  const Mechanics* first = nullptr;
  {
    const SystemModel model = bicycle.make(wide), other = bicycle.make(wide);
    first = model.mechanics.get();
    EXPECT_NE(first, other.mechanics.get());
    EXPECT_NE(first, bicycle.make({}).mechanics.get());
  }
  const SystemModel again = bicycle.make(wide);
  const std::shared_ptr<const Mechanics> held = bicycle.make(wide).mechanics;
  EXPECT_TRUE(again.mechanics.get() == first || held.get() == first);
  EXPECT_NE(bicycle.make(wide).mechanics, held) << "its user has the mechanics alone";
}

TEST(AssembledModels, RunsAreTheSameBehindOthers) {
  for (const char* name : {"bicycle", "car", "segway", "kick_scooter", "ballbot"}) {
    for (const char* scheme : {"lift", "dop853"}) {
      const std::vector<double> first = numbers_of(run_of(name, scheme));
      const std::vector<double> other = numbers_of(run_of(name, scheme, 1.5));
      EXPECT_FALSE(same_bits(first, other)) << name;
      EXPECT_TRUE(same_bits(first, numbers_of(run_of(name, scheme)))) << name << " " << scheme;
    }
  }
}

TEST(AssembledModels, ThreadsHaveTheirOwn) {
  const std::vector<double> alone = numbers_of(run_of("bicycle", "dop853"));
  std::vector<std::vector<double>> found(8);
  {
    std::vector<std::jthread> threads;
    for (std::vector<double>& out : found)
      threads.emplace_back([&out] {
        for (int i = 0; i < 5; ++i) out = numbers_of(run_of("bicycle", "dop853"));
      });
  }
  for (const std::vector<double>& out : found) EXPECT_TRUE(same_bits(alone, out));
}

}  // namespace
}  // namespace hamel
