// The law of every kind of joint: its motion is a homomorphism, and S its derivative at rest;
// frames of joints.
#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/LU>

#include <hamel/framework/check/laws.hpp>
#include <hamel/systems/mechanisms/joint.hpp>

namespace hamel::mechanisms {
namespace {

using Eigen::VectorXd;

// (rotation, position), row after row.
Vec<12> numbers(const Rigid& x) {
  Vec<12> out;
  out << x.rotation.reshaped(), x.position;
  return out;
}

TEST(MechanismJoints, ObeyTheLawOfTheirKind) {
  for (const JointKind& kind : joint_kinds()) {
    SCOPED_TRACE(kind.name);
    const auto joints = kind.make({});
    EXPECT_EQ(static_cast<int>(joints.size()), kind.joints);
    for (const auto& joint : joints) {
      const Geometry& geometry = *joint->geometry();
      const int n = joint->dim();
      EXPECT_EQ(n, geometry.dim());
      EXPECT_EQ(static_cast<int>(joint->rates().size()), n);
      EXPECT_EQ(static_cast<int>(joint->columns().size()), geometry.columns());
      const auto element = [&](const VectorXd& xi) {
        VectorXd out(geometry.size());
        geometry.tau(xi.data(), out.data());
        return out;
      };
      VectorXd some(n), more(n), product(geometry.size());
      for (int i = 0; i < n; ++i) {
        some[i] = std::sin(3.0 * i + 1);
        more[i] = std::cos(2.0 * i);
      }
      const VectorXd g = element(some), h = element(more);
      geometry.compose(g.data(), h.data(), product.data());
      const Rigid one_by_one = joint->motion(g.data()) * joint->motion(h.data());
      EXPECT_LT((numbers(joint->motion(product.data())) - numbers(one_by_one)).norm(), 1e-14);
      for (int i = 0; i < n; ++i) {
        const auto moved = [&](double e) {
          return numbers(joint->motion(element(e * VectorXd::Unit(n, i)).data()));
        };
        const Twist s = joint->directions().col(i);
        const Rigid twist{Mat<3, 3>{{0, -s[2], s[1]}, {s[2], 0, -s[0]}, {-s[1], s[0], 0}},
                          lower(s)};
        EXPECT_LT((check::derivative(moved) - numbers(twist)).norm(), 1e-10) << i;
      }
      if (n == 1) {  // the coordinate of springs, motors and prescribed motions
        EXPECT_NEAR(joint->coordinate(g.data()), some[0], 1e-15);
      }
    }
  }
}

TEST(MechanismJoints, HaveTheirAxisAsThirdAxisOfTheirFrame) {
  for (const double tilt : {0.0, 1e-9, 1e-5, 0.3, 2.0, 3.1, 3.1415926, 3.14159265358979323846}) {
    for (const double heading : {0.0, 0.4, 2.5}) {
      const double across = tilt > 3.14159265 ? 0 : std::sin(tilt);  // straight down

      const Vec3 axis =
          Vec3(across * std::cos(heading), across * std::sin(heading), std::cos(tilt)).normalized();
      const Mat<3, 3> frame = frame_along(axis);
      EXPECT_LT((frame.col(2) - axis).norm(), 1e-16);
      EXPECT_LT((frame * frame.transpose() - Mat<3, 3>::Identity()).norm(), 1e-15) << axis;
      EXPECT_NEAR(frame.determinant(), 1, 1e-15) << axis;
    }
  }
}

}  // namespace
}  // namespace hamel::mechanisms
