// Every system of the library obeys the laws by type too (framework/check/system_laws.hpp): the
// equations of motion along the exact motion of those that are left-invariant, the differentials of
// the others.
#include <gtest/gtest.h>

#include <set>

#include <hamel/framework/check/system_laws.hpp>
#include <hamel/groups/all.hpp>
#include <hamel/systems/ball_on_turntable.hpp>
#include <hamel/systems/chaplygin_ball.hpp>
#include <hamel/systems/chaplygin_sleigh.hpp>
#include <hamel/systems/contact_oscillator.hpp>
#include <hamel/systems/differential_drive.hpp>
#include <hamel/systems/falling_disk.hpp>
#include <hamel/systems/heisenberg_particle.hpp>
#include <hamel/systems/knife_edge_on_incline.hpp>
#include <hamel/systems/nonholonomic_particle.hpp>
#include <hamel/systems/rattleback.hpp>
#include <hamel/systems/roller_racer.hpp>
#include <hamel/systems/rolling_ball.hpp>
#include <hamel/systems/rolling_disk.hpp>
#include <hamel/systems/routh_sphere.hpp>
#include <hamel/systems/segway.hpp>
#include <hamel/systems/simulate_typed.hpp>
#include <hamel/systems/snakeboard.hpp>
#include <hamel/systems/suslov.hpp>
#include <hamel/systems/suslov_in_potential.hpp>
#include <hamel/systems/unicycle_3d.hpp>
#include <hamel/systems/veselova.hpp>

namespace {

using namespace hamel;

using AllSystems =
    TypeList<BallOnTurntable, ChaplyginBall, ChaplyginSleigh, ContactOscillator, DifferentialDrive,
             FallingDisk, HeisenbergParticle, KnifeEdgeOnIncline, NonholonomicParticle, Rattleback,
             RollerRacer, RollingBall, RollingDisk, RouthSphere, Segway, Snakeboard, Suslov,
             SuslovInPotential, Unicycle3d, Veselova>;

void expect(const LawReport& report, const std::string& what) {
  EXPECT_GE(report.size(), 4u) << what;
  for (const LawResult& law : report) EXPECT_TRUE(law.passed()) << what << ": " << law;
}

TEST(TypedLaws, Hold) {
  AllSystems::for_each(
      []<class S>(std::type_identity<S>) { expect(check_system(S{}), S::name()); });
}

TEST(TypedLaws, HoldForOtherParameters) {
  Suslov full;
  full.moments = {2, .3, .5, 3, .4, 4};
  expect(check_system(full), "suslov, full inertia");
  full.normal = {0.3, -0.5, 0.8};
  expect(check_system(full), "suslov, tilted axis");
}

/// All but those whose dimension is a parameter, which have no type to differentiate.
TEST(TypedLaws, CoverTheRegistry) {
  std::set<std::string> typed = {"n_trailer"};
  AllSystems::for_each([&]<class S>(std::type_identity<S>) { typed.insert(S::name()); });
  for (const std::string& name : registry().systems()) {
    EXPECT_TRUE(typed.contains(name)) << name << ": add its type to tests/systems/typed_laws.cpp";
  }
}

/// Each plant is a system with one wrong differential.
struct WrongSlope : SuslovInPotential {
  Vec<3> potential_differential(const SO3::Element<double>& g) const {
    return 1.001 * TypedMechanics<SuslovInPotential>(*this).potential_differential(g);
  }
};
struct WrongMetric : RouthSphere {
  Vec<5> inertia_differential(const Group::Element<double>& g, const Vec<5>& xi) const {
    return -TypedMechanics<RouthSphere>(*this).inertia_differential(g, xi);
  }
};
struct WrongContact : FallingDisk {
  Mat<1, 6> holonomic_differential(const SE3::Element<double>& g) const {
    return 2 * TypedMechanics<FallingDisk>(*this).holonomic_differential(g);
  }
};
template <class S>
int failures() {
  int out = 0;
  for (const LawResult& law : check_system(S{})) out += law.passed() ? 0 : 1;
  return out;
}
TEST(TypedLaws, SeePlantedMistakes) {
  EXPECT_EQ(failures<WrongSlope>(), 1);
  EXPECT_EQ(failures<WrongMetric>(), 1);
  EXPECT_EQ(failures<WrongContact>(), 1);
}

}  // namespace
