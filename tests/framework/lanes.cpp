// Bodies in lanes: the bits of the scalar kernel, for every scheme and system that has them.
#include <hamel/systems/lanes.hpp>

#include <gtest/gtest.h>

#include <hamel/hamel.hpp>
#include <hamel/systems/differential_drive.hpp>
#include <hamel/systems/heisenberg_particle.hpp>
#include <hamel/systems/rolling_disk.hpp>

namespace {

using hamel::KernelSetup;
using hamel::Snapshot;

// Setups of bodies that differ in all numbers.
template <class S>
std::vector<KernelSetup> setups_of(int count, const std::function<void(S&, int)>& vary) {
  std::vector<KernelSetup> out;
  for (int i = 0; i < count; ++i) {
    S body;
    vary(body, i);
    KernelSetup setup;
    setup.mechanics = hamel::erase(body).mechanics;
    setup.step = 0.05;
    setup.from = 1;
    setup.velocity = {1 - 0.05 * i, 0.5 + 0.1 * i, 0};
    setup.configuration = {0.1, 0.2 * i, -0.3};
    for (int k = 3; k < S::Group::dim; ++k) {  // wheels
      setup.velocity.push_back(20 * k);
      setup.configuration.push_back(4 * i);
    }
    if constexpr (std::is_same_v<typename S::Group, hamel::SO3>)
      setup.configuration = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    out.push_back(setup);
  }
  return out;
}

template <class S>
void expect_the_bits_of_the_scalar_kernel(const std::string& scheme,
                                          const std::function<void(S&, int)>& vary, double s,
                                          double h) {
  const hamel::Registry& registry = hamel::registry();
  const std::string group = S::Group::name();
  const auto mechanics = hamel::erase(S()).mechanics;
  const hamel::LaneInfo* lanes = registry.lanes(group, *mechanics, "cayley", scheme);
  const hamel::KernelFactory* scalar = registry.kernel(group, *mechanics, "cayley", scheme);
  ASSERT_NE(lanes, nullptr);
  ASSERT_NE(scalar, nullptr);
  std::vector<KernelSetup> setups = setups_of<S>(lanes->lanes, vary);
  for (KernelSetup& setup : setups) {
    setup.s = s;
    setup.step = h;
  }
  const auto all = lanes->make(setups);
  ASSERT_NE(all, nullptr);
  for (int round = 0; round < 2; ++round) {  // and after a restart
    std::vector<std::unique_ptr<hamel::Kernel>> alone;
    for (const KernelSetup& setup : setups) alone.push_back((*scalar)(setup));
    for (const long count : {0, 1, 2, 7, 390, 2000}) {
      all->advance(count);
      for (size_t i = 0; i < setups.size(); ++i) {
        alone[i]->advance(count);
        Snapshot one, lane;
        alone[i]->measure(one);
        all->state(static_cast<int>(i), lane, {});
        ASSERT_FALSE(all->failed(static_cast<int>(i)));
        EXPECT_EQ(lane.time, one.time);
        EXPECT_EQ(lane.step, one.step);
        EXPECT_EQ(lane.coordinates, one.coordinates) << scheme << " lane " << i;
        EXPECT_EQ(lane.velocity, one.velocity) << scheme << " lane " << i;
        EXPECT_EQ(lane.energy, one.energy);
        EXPECT_EQ(lane.constraint, one.constraint);
        EXPECT_EQ(lane.group_defect, one.group_defect);
        EXPECT_EQ(std::to_string(lane.rotation), std::to_string(one.rotation));  // NaN: none
        EXPECT_EQ(lane.time_offset, one.time_offset);
      }
    }
    for (KernelSetup& setup : setups) setup.velocity[0] += 0.25;
    all->restart(setups);
  }
}

void vary_body(hamel::Suslov& body, int i) {
  body.moments = {2, 0.3 + 0.01 * i, 0.5, 3 - 0.02 * i, 0.4, 4};
}
// No number of xi is zero: a sum of three has one order.
void vary_oblique(hamel::Suslov& body, int i) {
  vary_body(body, i);
  body.normal = {0.3, -0.2 - 0.01 * i, 0.9};
}
void vary_sleigh(hamel::ChaplyginSleigh& sleigh, int i) { sleigh.offset = 0.2 + 0.05 * i; }
void vary_disk(hamel::RollingDisk& disk, int i) { disk.radius = 0.3 + 0.05 * i; }
void vary_drive(hamel::DifferentialDrive& drive, int i) { drive.offset = 0.1 + 0.02 * i; }
void vary_particle(hamel::HeisenbergParticle& particle, int i) { particle.mass = 1 + i; }

TEST(Lanes, SuslovHasTheBitsOfTheScalarKernel) {
  for (const double s : {0.0, 0.5, 1.0})
    for (const double h : {0.05, 0.3})  // a new Jacobian in most steps before the attractor
      expect_the_bits_of_the_scalar_kernel<hamel::Suslov>("lift", vary_body, s, h);
  expect_the_bits_of_the_scalar_kernel<hamel::Suslov>("rkmk4", vary_body, 0.5, 0.05);
  for (const double s : {0.0, 0.5, 1.0})
    expect_the_bits_of_the_scalar_kernel<hamel::Suslov>("lift", vary_oblique, s, 0.01);
  expect_the_bits_of_the_scalar_kernel<hamel::Suslov>("rkmk4", vary_oblique, 0.5, 0.01);
}
TEST(Lanes, ASleighThatTurnsBackwardsHasThem) {
  for (const double h : {0.05, -0.05})
    expect_the_bits_of_the_scalar_kernel<hamel::ChaplyginSleigh>("lift", vary_sleigh, 0.5, h);
  expect_the_bits_of_the_scalar_kernel<hamel::ChaplyginSleigh>("rkmk4", vary_sleigh, 0.5, 0.05);
}
// Wheels turn by less than a right angle in a step, and by several.
TEST(Lanes, WheelsHaveThem) {
  for (const double h : {0.01, 0.05, 0.3}) {
    for (const char* scheme : {"lift", "rkmk4"}) {
      expect_the_bits_of_the_scalar_kernel<hamel::RollingDisk>(scheme, vary_disk, 0.5, h);
      expect_the_bits_of_the_scalar_kernel<hamel::DifferentialDrive>(scheme, vary_drive, 0.5, h);
    }
  }
}
TEST(Lanes, AParticleWithoutAHamelFormHasThem) {
  for (const char* scheme : {"lift", "rkmk4"})
    expect_the_bits_of_the_scalar_kernel<hamel::HeisenbergParticle>(scheme, vary_particle, 0.5,
                                                                    0.05);
}

// Between 0, 1/2 and 1 Cayley has no contracted form.
TEST(Lanes, AreNotOfferedWhereTheStepHasNoForm) {
  const auto mechanics = hamel::erase(hamel::Suslov()).mechanics;
  const hamel::LaneInfo* lanes = hamel::registry().lanes("so3", *mechanics, "cayley", "lift");
  ASSERT_NE(lanes, nullptr);
  auto setups = setups_of<hamel::Suslov>(lanes->lanes, vary_body);
  for (KernelSetup& setup : setups) setup.s = 0.25;
  EXPECT_EQ(lanes->make(setups), nullptr);
  EXPECT_EQ(hamel::registry().lanes("so3", *mechanics, "exp", "lift"), nullptr);
}

// A step far beyond the principal root, or one that overflows, fails in its lane alone.
TEST(Lanes, OneThatFailsLeavesTheOthersAlone) {
  const auto mechanics = hamel::erase(hamel::Suslov()).mechanics;
  for (const char* scheme : {"lift", "rkmk4"}) {
    const hamel::LaneInfo* lanes = hamel::registry().lanes("so3", *mechanics, "cayley", scheme);
    const hamel::KernelFactory* scalar =
        hamel::registry().kernel("so3", *mechanics, "cayley", scheme);
    auto setups = setups_of<hamel::Suslov>(lanes->lanes, vary_body);
    const size_t wild = 1;
    setups[wild].velocity = {4000, 3000, 0};
    ASSERT_FALSE((*scalar)(setups[wild])->advance(50).ok);
    const auto all = lanes->make(setups);
    all->advance(50);
    for (size_t i = 0; i < setups.size(); ++i) {
      ASSERT_EQ(all->failed(static_cast<int>(i)), i == wild) << scheme;
      if (i == wild) continue;
      const auto alone = (*scalar)(setups[i]);
      alone->advance(50);
      Snapshot one, lane;
      alone->measure(one);
      all->state(static_cast<int>(i), lane, {});
      EXPECT_EQ(lane.coordinates, one.coordinates) << scheme << " lane " << i;
      EXPECT_EQ(lane.velocity, one.velocity) << scheme << " lane " << i;
    }
    setups[wild].velocity = setups[0].velocity;  // after a restart it is one of them again
    all->restart(setups);
    all->advance(50);
    EXPECT_FALSE(all->failed(static_cast<int>(wild)));
  }
}

// A system of one's own, in the instruction set of this program.
struct Skate {
  using Group = hamel::SE2;
  double mass = 3;
  hamel::Mat<3, 3> inertia() const { return hamel::Vec<3>(0.4, mass, mass).asDiagonal(); }
  hamel::Mat<1, 3> constraints() const { return hamel::Mat<1, 3>{0.1, 0, 1}; }
};
TEST(Lanes, ASystemOfOnesOwnIsAdded) {
  hamel::Registry registry;
  hamel::add_lanes<Skate>(registry);
  const auto mechanics = hamel::erase(Skate()).mechanics;
  const hamel::LaneInfo* lanes = registry.lanes("se2", *mechanics, "cayley", "lift");
  ASSERT_NE(lanes, nullptr);
  const auto setups =
      setups_of<Skate>(lanes->lanes, [](Skate& skate, int i) { skate.mass = 3 + i; });
  const auto all = lanes->make(setups);
  all->advance(200);
  const auto alone =
      (*hamel::registry().kernel("se2", *mechanics, "cayley", "lift"))(setups.front());
  alone->advance(200);
  Snapshot one, lane;
  alone->measure(one);
  all->state(0, lane, {});
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(lane.velocity[i], one.velocity[i], 200 * 1e-14);
    EXPECT_NEAR(lane.coordinates[i], one.coordinates[i], 200 * 1e-14);
  }
}

}  // namespace
