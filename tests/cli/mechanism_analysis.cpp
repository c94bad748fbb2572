// describe --analyse of mechanisms.
#include <cmath>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::HasSubstr;

using MechanismAnalysis = CommandLine;

/// What brackets span does not depend on the unit of lengths: the kick scooter of the library, in
/// mm.
TEST_F(MechanismAnalysis, GrowsAlikeInAnyUnit) {
  const std::string millimetres = R"toml(name = "kick_scooter_mm"
gravity = 9810
body = [
  { name = "deck", mass = 5, at = [300, 0, 100], box = [600, 150, 50] },
  { name = "fork", mass = 1.5, at = [750, 0, 500], box = [50, 60, 800] },
  { name = "handlebar", mass = 0.5, at = [750, 0, 900], box = [40, 450, 40] },
  { name = "rear wheel", mass = 0.5, at = [0, 0, 100], cylinder = [100, 30], axis = [0, 1, 0] },
  { name = "front wheel", mass = 0.5, at = [720, 0, 100], cylinder = [100, 30], axis = [0, 1, 0] },
]
joint = [
  { name = "road", kind = "planar", child = "deck" },
  {name="steer", kind="hinge", parent="deck", child="fork", at=[750, 0, 0], damping=2e4},
  { name = "stem", kind = "weld", parent = "fork", child = "handlebar" },
  {name="rear", kind="hinge", parent="deck", child="rear wheel", at=[0, 0, 100], axis=[0, 1, 0]},
  {name="front",kind="hinge",parent="fork",child="front wheel",at=[720,0,100],axis=[0,1,0]},
]
wheel = [
  { name = "rear", body = "rear wheel", at = [0, 0, 100], radius = 100 },
  { name = "front", body = "front wheel", at = [720, 0, 100], radius = 100 },
]
motor = [{ joint = "steer" }]
[start]
speed = 2000
steer.angle = 0.3
)toml";
  const json expected = {2, 3, 5, 6};
  EXPECT_EQ(answer({"describe", "--analyse", "kick_scooter"})["growth"], expected);
  EXPECT_EQ(answer({"describe", "--analyse", write(millimetres)})["growth"], expected);
}

/// Energy, and nothing beside it: of wild motions, and of a wheel with a pendulum at its axle.
TEST_F(MechanismAnalysis, EnergyAloneIsKept) {
  const std::string pendulum = R"toml(body = [
  { name = "wheel", mass = 1, at = [0, 0, 0.3], cylinder = [0.3, 0.02], axis = [0, 1, 0] },
  { name = "bob", mass = 2, at = [0, 0, 0.1], box = [0.05, 0.05, 0.05] },
]
joint = [
  { name = "space", kind = "free", child = "wheel", at = [0, 0, 0.3] },
  {name="axle", kind="hinge", parent="wheel", child="bob", at=[0, 0, 0.3], axis=[0, 1, 0]},
]
wheel = [{ body = "wheel", at = [0, 0, 0.3], radius = 0.3 }]
[start]
speed = 1
)toml";
  for (const std::string& system :
       {std::string("bicycle"), std::string("ballbot"), write(pendulum)}) {
    const json kept = answer({"describe", "--analyse", system})["conserved"];
    ASSERT_EQ(kept.size(), 1u) << system << kept;
    EXPECT_EQ(kept[0]["expression"], "E") << system;
  }
}

}  // namespace
