// A million compositions with renormalisation stay on the group; angles stay unwrapped.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include <hamel/framework/check/group_laws.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/product_retraction.hpp>

namespace {

using namespace hamel;
constexpr double pi = std::numbers::pi;

/// Without normalise the defect grows as sqrt(steps) u, about 3e-13 after 1e6 steps. With it each
/// step starts from a defect of a few u, and 1e-14 is 45 u.
template <class G>
void expect_no_drift(const Vec<G::dim>& xi) {
  const auto step = Exp<G>::tau(xi);
  auto g = Exp<G>::tau(Vec<G::dim>(0.7 * xi.reverse()));
  double worst = 0;
  for (int i = 0; i < 1000000; ++i) {
    g = G::normalise(G::compose(g, step));
    if (i % 100 == 0) worst = std::max(worst, G::defect(g));
  }
  EXPECT_LE(worst, 1e-14) << G::name();
  EXPECT_LE(G::defect(g), 1e-14) << G::name();
}
TEST(Drift, SO2) { expect_no_drift<SO2>(Vec<1>(0.0137)); }
TEST(Drift, SO3) { expect_no_drift<SO3>(Vec<3>(0.01, -0.02, 0.013)); }
TEST(Drift, SE2) { expect_no_drift<SE2>(Vec<3>(0.01, 0.02, 0.003)); }
TEST(Drift, SE3) {
  Vec<6> xi;
  xi << 0.01, -0.02, 0.013, 0.001, 0.002, -0.003;
  expect_no_drift<SE3>(xi);
}

/// One Newton step squares a defect: 1e-5 becomes 1e-10, then round-off.
TEST(Drift, NormaliseIsQuadratic) {
  std::mt19937_64 random(2);
  Mat<3, 3> g = check::random_element<Exp<SO3>>(random);
  g += 1e-5 * Mat<3, 3>::Random();
  g = SO3::normalise(g);
  EXPECT_LT(SO3::defect(g), 1e-8);
  EXPECT_LT(SO3::defect(SO3::normalise(g)), 2e-15);
}

/// theta after k steps of w is k w: many turns, both ways, for steps up to nearly a half turn.
/// Round-off per step: u.
TEST(Unwrapped, AngleCountsTurns) {
  for (const double w : {0.01, 0.3, 1.0, 2.0, 3.0, 3.14, -0.01, -0.7, -1.6, -3.0, -3.14159}) {
    const auto step = Exp<SO2>::tau(Vec<1>(w));
    auto g = SO2::identity();
    for (int k = 1; k <= 5000; ++k) {
      g = SO2::normalise(SO2::compose(g, step));
      ASSERT_NEAR(g.angle(), k * w, 1e-11) << w << " step " << k;
    }
    EXPECT_NEAR(SO2::inverse(g).angle(), -g.angle(), 1e-11);
    EXPECT_NEAR(SO2::compose(SO2::inverse(g), g).angle(), 0, 1e-11);
  }
}
/// Exact multiples of a quarter turn sit on the branch cut, where signs of zero decide.
TEST(Unwrapped, QuarterTurnsAreExact) {
  const SO2Element<double> left{0, 1, 0}, half{-1, 0, 0};
  for (int k = 1; k <= 20; ++k) {
    auto g = SO2::identity(), h = g, m = g;
    for (int i = 0; i < k; ++i) {
      g = SO2::compose(g, left);
      h = SO2::compose(h, SO2::inverse(left));
      m = SO2::compose(half, m);
    }
    EXPECT_DOUBLE_EQ(g.angle(), k * pi / 2) << k;
    EXPECT_DOUBLE_EQ(h.angle(), -k * pi / 2) << k;
    EXPECT_DOUBLE_EQ(m.angle(), k * pi) << k;
    EXPECT_DOUBLE_EQ(SO2::inverse(g).angle(), -g.angle()) << k;
    EXPECT_DOUBLE_EQ(SO2::inverse(m).angle(), -m.angle()) << k;
    EXPECT_DOUBLE_EQ(SO2::compose(SO2::inverse(h), h).angle(), 0) << k;
  }
}
TEST(Unwrapped, RandomAnglesAdd) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> uniform(-40, 40);
  for (int i = 0; i < 100000; ++i) {
    const double a = uniform(random), b = uniform(random);
    const auto g = SO2::from_angle(a), h = SO2::from_angle(b);
    ASSERT_NEAR(g.angle(), a, 1e-13);
    ASSERT_NEAR(SO2::compose(g, h).angle(), a + b, 1e-13);
    ASSERT_NEAR(SO2::inverse(g).angle(), -a, 1e-13);
  }
}
TEST(Unwrapped, SE2AndProductsUseIt) {
  using Disk = Product<SE2, SO2>;
  Vec<4> xi(-2.0, 0.1, 0.2, 3.0);
  auto g = Disk::identity();
  for (int i = 0; i < 1000; ++i) g = Disk::normalise(Disk::compose(g, Exp<Disk>::tau(xi)));
  EXPECT_NEAR(g.part<0>().angle(), -2000, 1e-10);
  EXPECT_NEAR(g.part<1>().angle(), 3000, 1e-10);
  const auto values = Disk::coordinates(g);
  EXPECT_NEAR(values[0], -2000, 1e-10);
  const auto again = Disk::from_coordinates(values);
  EXPECT_NEAR(again.part<0>().angle(), g.part<0>().angle(), 1e-12);
}

}  // namespace
