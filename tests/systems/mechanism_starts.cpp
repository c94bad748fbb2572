// The start of a mechanism: joints are at rest unless the rows require their motion, which a note
// names; what cannot move is said.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <Eigen/SVD>

#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

SystemModel model_of(const std::string& text) {
  return data_system_maker(registry(), "parts.toml", text)({});
}
size_t rate(const SystemModel& system, const std::string& name) {
  const std::vector<Component> components = components_of(system);
  for (size_t i = 0; i < components.size(); ++i)
    if (components[i].name == name) return i;
  ADD_FAILURE() << "no velocity " << name;
  return 0;
}

// A cart on two wheels that carries a free arm.
constexpr const char* kArmOnBase = R"(
redundant = "drop"
body = [ { name = "cart", mass = 10, at = [0, 0, 0.1], box = [0.5, 0.3, 0.1] }, { name = "arm", mass = 3, at = [0, 0.25, 0.3], box = [0.04, 0.5, 0.04] },
 { name = "left", mass = 0.3, at = [0, 0.15, 0.05], cylinder = [0.05, 0.02], axis = [0, 1, 0] }, { name = "right", mass = 0.3, at = [0, -0.15, 0.05], cylinder = [0.05, 0.02], axis = [0, 1, 0] } ]
joint = [ { name = "floor", kind = "planar", child = "cart" }, { name = "shoulder", kind = "hinge", parent = "cart", child = "arm", at = [0, 0, 0.3] },
 { name = "left", kind = "hinge", parent = "cart", child = "left", at = [0, 0.15, 0.05], axis = [0, 1, 0] }, { name = "right", kind = "hinge", parent = "cart", child = "right", at = [0, -0.15, 0.05], axis = [0, 1, 0] } ]
wheel = [ { body = "left", at = [0, 0.15, 0.05], radius = 0.05 }, { body = "right", at = [0, -0.15, 0.05], radius = 0.05 } ]
)";

TEST(Starts, AtASpeedSetNoLimbSwinging) {
  const SystemModel arm = model_of(kArmOnBase);
  const SystemStart start = arm.start_at_speed(1, 0);
  EXPECT_NEAR(start.velocity[rate(arm, "shoulder.rate")], 0, 1e-12);
  EXPECT_NEAR(start.velocity[rate(arm, "left.rate")], 20, 1e-9);
  EXPECT_THAT(start.notes, IsEmpty());
  for (const auto& [name, joint] :
       {std::pair{"kick_scooter", "steer.rate"}, {"tricycle", "steer.rate"}}) {
    const SystemModel system = registry().system(name)->make({});
    EXPECT_NEAR(system.start.velocity[rate(system, joint)], 0, 1e-12) << name;
  }
}

/// With the steering at rest a scooter follows its front wheel: heading v tan(0.3) t / wheelbase to
/// first order, before its trail straightens it.
TEST(Starts, OfAScooterTurnTheWayItIsSteered) {
  const Result r = simulate("kick_scooter").until(0.6).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  EXPECT_NEAR(r.last.coordinates[0], 0.262, 5e-4);
}

/// Level by level what moves is the least that the rows allow, in whatever units: against a
/// pseudo-inverse of the rows, at random angles of the joints and speeds, of all mechanisms.
TEST(Starts, MoveJointsAsLittleAsTheRowsAllow) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> in(-0.4, 0.4);
  int compared = 0;
  for (const std::string name : {"bicycle", "car", "kick_scooter", "skateboard", "tricycle",
                                 "two_trailer_truck", "unicycle_rider"}) {
    const SystemModel system = registry().system(name)->make({});
    ASSERT_TRUE(system.start_at_speed) << name;
    const std::vector<Component> components = components_of(system);
    std::vector<Eigen::Index> joints;  // whose rates are those of no wheel
    for (size_t i = 0; i < components.size(); ++i)
      if (components[i].name == "steer.rate" || components[i].name == "hitch.rate" ||
          components[i].name == "lean.rate" || components[i].name == "second hitch.rate")
        joints.push_back(static_cast<Eigen::Index>(i));
    if (joints.empty()) continue;
    for (int trial = 0; trial < 5; ++trial) {
      const double speed = 1 + in(random);
      const SystemStart start = system.start_at_speed(speed, 0);
      const auto n = static_cast<Eigen::Index>(start.velocity.size());
      const auto geometry = registry().geometry(system.group.name, "exp");
      Eigen::VectorXd g(geometry->size());
      geometry->from_coordinates(start.configuration, g.data());
      const int k = system.mechanics->constraint_count();
      Eigen::MatrixXd a(k, n), inertia(n, n);
      Eigen::VectorXd b(k);
      system.mechanics->constraints(0, g.data(), a, b);
      system.mechanics->inertia(g.data(), inertia);
      const Eigen::VectorXd xi = Eigen::Map<const Eigen::VectorXd>(start.velocity.data(), n);
      EXPECT_LT((a * xi - b).norm(), 1e-10) << name;
      // The least sum of I_ii rate^2 over these joints with A xi = b and this speed.
      const size_t ahead = rate(system, "v1");
      EXPECT_NEAR(xi[static_cast<Eigen::Index>(ahead)], speed, 1e-10) << name;
      Eigen::MatrixXd whole(k + 1, n);
      whole << a, Eigen::RowVectorXd::Unit(n, static_cast<Eigen::Index>(ahead));
      Eigen::VectorXd right(k + 1);
      right << b, speed;
      const Eigen::JacobiSVD<Eigen::MatrixXd> svd(whole, Eigen::ComputeFullU | Eigen::ComputeFullV);
      const Eigen::VectorXd some = svd.solve(right);
      const Eigen::MatrixXd free = svd.matrixV().rightCols(n - svd.rank());
      Eigen::MatrixXd rows(joints.size(), free.cols());
      Eigen::VectorXd values(joints.size());
      for (size_t j = 0; j < joints.size(); ++j) {
        const double weight = std::sqrt(inertia(joints[j], joints[j]));
        rows.row(static_cast<Eigen::Index>(j)) = weight * free.row(joints[j]);
        values[static_cast<Eigen::Index>(j)] = weight * some[joints[j]];
      }
      const Eigen::VectorXd z =
          rows.jacobiSvd(Eigen::ComputeThinU | Eigen::ComputeThinV).solve(-values);
      double found = 0;
      for (const Eigen::Index j : joints) found += inertia(j, j) * xi[j] * xi[j];
      EXPECT_NEAR(std::sqrt(found), (values + rows * z).norm(), 1e-9) << name;
      ++compared;
    }
  }
  EXPECT_GE(compared, 20);
}

/// A hitch at an angle turns, since both axles roll; the note says so, and not of what was given.
TEST(Starts, NameTheJointsThatMoveUnasked) {
  const char* train = R"(
body = [ { name = "cart", mass = 10, at = [0, 0, 0.1], box = [0.5, 0.3, 0.1] }, { name = "trailer", mass = 5, at = [-1.3, 0, 0.1], box = [0.4, 0.3, 0.1] } ]
joint = [ { name = "floor", kind = "planar", child = "cart" }, { name = "hitch", kind = "hinge", parent = "cart", child = "trailer", at = [-0.35, 0, 0.1] } ]
blade = [ { name = "cart axle", body = "cart", at = [0, 0, 0] }, { name = "trailer axle", body = "trailer", at = [-1.3, 0, 0] } ]
[start]
v1 = 1
omega = 0
hitch.angle = 0.8
)";
  const SystemModel system = model_of(train);
  EXPECT_THAT(system.start.notes, Contains(AllOf(HasSubstr("joints whose rates are not given move"),
                                                 HasSubstr("hitch.rate = -0.755"))));
  const OwnSystem own{data_system_maker(registry(), "parts.toml", train)};
  EXPECT_THAT(Simulation(registry(), "parts.toml", own).build().notes(),
              Contains(HasSubstr("hitch.rate = -0.755")));
}

// A frame on two wheels whose hinges lie across their axles.
TEST(Mobility, OfWheelsThatCannotRollIsNoted) {
  std::string across = kArmOnBase;
  for (size_t at = 0; (at = across.find("0.05], axis = [0, 1, 0] }, { name = \"right\", kind",
                                        at)) != std::string::npos;
       ++at)
    across.replace(at, 24, "0.05], axis = [1, 0, 0] ");
  const SystemModel system = model_of(across);
  EXPECT_THAT(system.notes, Contains(HasSubstr("wheel 'left': cannot roll, since no joint turns "
                                               "about the axle")));
  EXPECT_THAT(model_of(kArmOnBase).notes, Not(Contains(HasSubstr("cannot"))));
}

std::string car(const std::string& left, const std::string& right) {
  return R"(
redundant = "drop"
body = [
 { name = "base", mass = 20, at = [0, 0, 0.2], box = [0.8, 0.5, 0.2] },
 { name = "kfl", mass = 0.5, at = [0.4, 0.3, 0.1], box = [0.05, 0.05, 0.1] }, { name = "fl", mass = 1, at = [0.4, 0.3, 0.1], cylinder = [0.1, 0.05], axis = [0, 1, 0] },
 { name = "kfr", mass = 0.5, at = [0.4, -0.3, 0.1], box = [0.05, 0.05, 0.1] }, { name = "fr", mass = 1, at = [0.4, -0.3, 0.1], cylinder = [0.1, 0.05], axis = [0, 1, 0] },
 { name = "rl", mass = 1, at = [-0.4, 0.3, 0.1], cylinder = [0.1, 0.05], axis = [0, 1, 0] }, { name = "rr", mass = 1, at = [-0.4, -0.3, 0.1], cylinder = [0.1, 0.05], axis = [0, 1, 0] },
]
joint = [
 { name = "floor", kind = "planar", child = "base" },
 { name = "sl", kind = "hinge", parent = "base", child = "kfl", at = [0.4, 0.3, 0.1] }, { name = "fl", kind = "hinge", parent = "kfl", child = "fl", at = [0.4, 0.3, 0.1], axis = [0, 1, 0] },
 { name = "sr", kind = "hinge", parent = "base", child = "kfr", at = [0.4, -0.3, 0.1] }, { name = "fr", kind = "hinge", parent = "kfr", child = "fr", at = [0.4, -0.3, 0.1], axis = [0, 1, 0] },
 { name = "rl", kind = "hinge", parent = "base", child = "rl", at = [-0.4, 0.3, 0.1], axis = [0, 1, 0] }, { name = "rr", kind = "hinge", parent = "base", child = "rr", at = [-0.4, -0.3, 0.1], axis = [0, 1, 0] },
]
wheel = [ { body = "fl", at = [0.4, 0.3, 0.1], radius = 0.1 }, { body = "fr", at = [0.4, -0.3, 0.1], radius = 0.1 }, { body = "rl", at = [-0.4, 0.3, 0.1], radius = 0.1 }, { body = "rr", at = [-0.4, -0.3, 0.1], radius = 0.1 } ]
prescribed = [ { joint = "sl", angle = ")" +
         left + R"(" }, { joint = "sr", angle = ")" + right + R"(" } ]
motor = [ { joint = "rl", effort = "5" }, { joint = "rr", effort = "5" } ]
)";
}

/// Parallel front wheels that are held leave no motion, which is an error with the angles that
/// would do; at the angles at which all axles meet in one point the car drives.
TEST(Mobility, OfACarWhoseAxlesDoNotMeetIsRefused) {
  try {
    (void)model_of(car("0.2", "0.2"));
    ADD_FAILURE() << "a car that cannot move is accepted";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("the axles of wheels meet in one point"),
                                    HasSubstr("sl.angle = 0.23465 or sr.angle = 0.174176 would")));
  }
  // The centre of turning lies on the rear axle, R from its middle: tan = 0.8 / (R -+ 0.3).
  const std::string l = "atan(0.8/(4 - 0.3))", r = "atan(0.8/(4 + 0.3))";
  EXPECT_THAT(model_of(car(l, r)).notes, Not(Contains(HasSubstr("cannot"))));
}

TEST(Mobility, OfASkidSteeredCartIsStraightOnly) {
  EXPECT_THAT(model_of(car("0", "0")).notes,
              Contains(AllOf(HasSubstr("joint 'floor' cannot turn"), HasSubstr("wheel 'rl'"),
                             HasSubstr("skidding"))));
  for (const char* name : {"bicycle", "car", "kick_scooter", "tricycle", "skateboard", "ballbot",
                           "omni_robot", "two_trailer_truck", "unicycle_rider"})
    EXPECT_THAT(registry().system(name)->make({}).notes, Not(Contains(HasSubstr("cannot"))))
        << name;
}

}  // namespace
}  // namespace hamel
