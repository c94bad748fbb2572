// The shorter forms of a system's members are equivalent to the long ones.
#include <gtest/gtest.h>

#include <cmath>

#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/se2.hpp>

namespace {

using namespace hamel;
using Element = SE2::Element<double>;

struct Skate {
  using Group = SE2;
  Mat<3, 3> inertia() const { return Vec<3>(0.1, 1, 1).asDiagonal(); }
  Mat<1, 3> constraints() const { return {0, 0, 1}; }
};
struct Plain : Skate {};
struct ConstantDrift : Skate {
  Vec<1> drift() const { return Vec<1>(0.5); }
};
struct DriftOfPlace : Skate {
  Vec<1> drift(const Element& g) const { return Vec<1>(0.5 * g.translation[0]); }
};
struct DriftOfTime : Skate {
  Vec<1> drift(double t, const auto& g) const { return Vec<1>(0.5 * t * g.translation[0]); }
};
struct Friction : Skate {
  Vec<3> force(const Element& /*g*/, const Vec<3>& xi) const { return -0.2 * xi; }
};
struct Motor : Skate {
  Vec<3> force(double t, const auto& /*g*/, const auto& xi) const { return -t * xi; }
};
struct Data : Skate {  // names of members for data
  double force = 1, drift = 2, start = 3;
};

const Element g{SO2::from_angle(0.3), {0.8, -0.4}};
const double t = 0.7;

template <class S>
double drift_at(const S& system) {
  const auto mechanics = erase(system).mechanics;
  double at[Packing<SE2>::size];
  Packing<SE2>::store(g, at);
  Eigen::MatrixXd a(1, 3);
  Eigen::VectorXd b(1);
  mechanics->constraints(t, at, a, b);
  return b[0];
}
template <class S>
Vec<3> force_at(const S& system) {
  const auto mechanics = erase(system).mechanics;
  double at[Packing<SE2>::size];
  Packing<SE2>::store(g, at);
  Eigen::VectorXd out(3);
  mechanics->force(t, at, Vec<3>(1, 2, 0), out);
  return out;
}

TEST(SystemMembers, NoneIsLeftOut) {
  EXPECT_EQ(drift_at(ConstantDrift{}), 0.5);
  EXPECT_EQ(drift_at(DriftOfPlace{}), 0.4);
  EXPECT_EQ(drift_at(DriftOfTime{}), 0.5 * t * 0.8);
  EXPECT_EQ(force_at(Friction{}), -0.2 * Vec<3>(1, 2, 0));
  EXPECT_EQ(force_at(Motor{}), -t * Vec<3>(1, 2, 0));
}

TEST(SystemMembers, SayWhetherASystemIsLeftInvariant) {
  EXPECT_TRUE(erase(Plain{}).mechanics->left_invariant());
  EXPECT_TRUE(erase(Data{}).mechanics->left_invariant());
  EXPECT_NE(erase(ConstantDrift{}).mechanics, nullptr);
  EXPECT_NE(erase(Friction{}).mechanics, nullptr);
  EXPECT_TRUE(erase(ConstantDrift{}).mechanics->constant_constraints());
  EXPECT_FALSE(erase(DriftOfPlace{}).mechanics->constant_constraints());
}

/// Straight ahead at a speed: as a system states it, whatever it is called.
struct OwnSegway : Skate {
  static std::string name() { return "segway"; }
};
struct StartsAtSpeed : OwnSegway {
  double scale = 2;
  Start at_speed(double v) const { return {.configuration = {}, .velocity = {0, scale * v, 0}}; }
};
struct DrivenAtSpeed : StartsAtSpeed {
  void inputs(auto& u) const { u("push", "N", "ahead"); }
  Vec<3> force(double, const auto&, const auto&, InputValues u) const { return {0, u[0], 0}; }
};
TEST(SystemMembers, AStartAtASpeedIsTheSystemsOwn) {
  EXPECT_FALSE(erase(OwnSegway{}).start_at_speed);
  const SystemModel model = erase(StartsAtSpeed{});
  EXPECT_EQ(model.start_at_speed(1.5, 0).velocity, (std::vector<double>{0, 3, 0}));
  EXPECT_EQ(erase(DrivenAtSpeed{}).start_at_speed(2, 7).velocity, (std::vector<double>{0, 4, 0}));
}

}  // namespace
