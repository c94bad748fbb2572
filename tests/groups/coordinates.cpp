// from_coordinates refuses values that are not in the group and names the values given and
// expected.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <hamel/framework/lie/group_operations.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/product_retraction.hpp>

namespace {

using namespace hamel;

template <class G>
std::string refusal(const std::vector<double>& values) {
  try {
    (void)G::from_coordinates(values);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}
bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Coordinates, WrongLength) {
  const std::string text = refusal<SE2>({1, 2});
  EXPECT_TRUE(contains(text, "se2: 2 values, expected 3 (theta, x, y)")) << text;
  EXPECT_TRUE(contains(refusal<SO2>({}), "so2: 0 values, expected 1"));
  EXPECT_TRUE(contains(refusal<Rn<2>>({1, 2, 3}), "r2: 3 values, expected 2 (x1, x2)"));
  EXPECT_TRUE(
      contains(refusal<Product<SE2, SO2>>({1, 2, 3}), "expected 4 (1_theta, x, y, 2_theta)"));
}
TEST(Coordinates, NotFinite) {
  EXPECT_TRUE(contains(refusal<SE2>({1, nan, 0}), "se2: x = "));
  EXPECT_TRUE(contains(refusal<SO2>({std::numeric_limits<double>::infinity()}), "theta = inf"));
  EXPECT_TRUE(contains(refusal<SO2>({1e12}), "theta = 1000000000000"));
  EXPECT_TRUE(contains(refusal<Product<SE2, SO2>>({0, 0, 0, nan}), "2_theta = "));
}
TEST(Coordinates, NotARotation) {
  const std::string scaled = refusal<SO3>({2, 0, 0, 0, 2, 0, 0, 0, 2});
  EXPECT_TRUE(contains(scaled, "so3") && contains(scaled, "expected a rotation matrix")) << scaled;
  EXPECT_TRUE(
      contains(refusal<SO3>({1, 0, 0, 0, 1, 0, 0, 0, -1}), "= 2,"));  // a reflection: det = -1
  EXPECT_TRUE(contains(refusal<SO3>({1, 0, 0, 0, 1, 0, 0, 0, nan}), "R33"));
  EXPECT_TRUE(contains(refusal<SE3>({1, 1e-5, 0, 0, 1, 0, 0, 0, 1, 4, 5, 6}), "se3"));
}
/// Eight printed digits are accepted and repaired to round-off.
TEST(Coordinates, SmallDefectsAreRepaired) {
  const Mat<3, 3> exact = Exp<SO3>::tau(Vec<3>(0.3, -0.5, 0.9));
  std::vector<double> printed = SO3::coordinates(exact);
  for (double& value : printed) value = std::round(value * 1e8) / 1e8;
  const Mat<3, 3> repaired = SO3::from_coordinates(printed);
  EXPECT_GT(SO3::defect(Mat<3, 3>(Eigen::Map<Mat<3, 3>>(printed.data()).transpose())), 1e-10);
  EXPECT_LT(SO3::defect(repaired), 2e-15);
  EXPECT_LT((repaired - exact).norm(), 2e-8);
}
TEST(Coordinates, RoundTripIsExact) {
  const Mat<3, 3> exact = Mat<3, 3>{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
  EXPECT_EQ(SO3::from_coordinates(SO3::coordinates(exact)), exact);
  const auto g = SE2::from_coordinates(std::vector<double>{7.5, -2, 3});
  EXPECT_NEAR(g.angle(), 7.5, 1e-15 * 8);
  EXPECT_EQ(g.translation, Vec<2>(-2, 3));
}
/// Values as after a Runge-Kutta stage: a rotation that is off by 0.1, an angle of many turns.
TEST(Coordinates, NearestTakesWhatIsNoElement) {
  using G = Product<SO3, SE2>;
  const auto g = G::compose(G::identity(), {{Exp<SO3>::tau(Vec<3>(0.3, -0.5, 0.9)), {}}});
  std::vector<double> off = G::coordinates(g);
  off[0] += 0.1;
  off[9] = 2e9;
  off[10] = 7;
  EXPECT_NE(refusal<G>(off), "accepted");
  const auto near = nearest_element<G>(off);
  EXPECT_LT(G::defect(near), 1e-14);
  EXPECT_LT((near.part<0>() - g.part<0>()).norm(), 0.1);
  EXPECT_EQ(near.part<1>().translation[0], 7);
}

/// Elements are the same by their numbers, whatever lies between these in memory.
TEST(Coordinates, SameElements) {
  using G = Product<SE2, SO2>;
  using Operations = GroupOperations<Exp<G>>;
  const auto g = G::from_coordinates(std::vector<double>{7.5, -2, 3, 0.1});
  auto h = g;
  auto* bytes = reinterpret_cast<unsigned char*>(&h.part<0>());
  const auto* behind = reinterpret_cast<unsigned char*>(&h.part<0>().translation);
  for (unsigned char* gap = bytes + sizeof(SO2Element<double>); gap < behind; ++gap) *gap ^= 0xff;
  EXPECT_TRUE(Operations::same(g, h));
  ++h.part<1>().turns;
  EXPECT_FALSE(Operations::same(g, h));
}

}  // namespace
