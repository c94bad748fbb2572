// Products of groups obey the group axioms (framework/check/group_laws.hpp, where the bounds are).
#include <gtest/gtest.h>

#include <hamel/framework/check/group_laws.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/product_retraction.hpp>

namespace {

using namespace hamel;

template <class G>
class ProductLaws : public testing::Test {};
using Groups = testing::Types<Product<SE2, SO2>, Product<SO3, Rn<2>>, Product<SE2, SO2, SO2>>;
TYPED_TEST_SUITE(ProductLaws, Groups);

TYPED_TEST(ProductLaws, Hold) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    for (const LawResult& law : check_group<TypeParam, Exp<TypeParam>>(seed)) {
      EXPECT_TRUE(law.passed()) << TypeParam::name() << ": " << law;
    }
  }
}

TEST(GroupNames, AreTheRegistryNames) {
  EXPECT_EQ(SO2::name(), "so2");
  EXPECT_EQ(Rn<2>::name(), "r2");
  EXPECT_EQ(SO3::name(), "so3");
  EXPECT_EQ(SE2::name(), "se2");
  EXPECT_EQ(SE3::name(), "se3");
  EXPECT_EQ((Product<SE2, SO2, Rn<1>>::name()), "se2*so2*r1");
  EXPECT_EQ((Product<SE2, SO2>::columns()),
            (std::vector<std::string>{"1_theta", "1_x", "1_y", "2_theta"}));
}

}  // namespace
