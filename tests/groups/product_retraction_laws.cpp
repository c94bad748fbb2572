// Retractions of products, factor by factor, obey the laws; also when the factors differ.
#include <gtest/gtest.h>

#include <hamel/framework/check/retraction_laws.hpp>
#include <hamel/groups/cayley.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/product_retraction.hpp>
#include <hamel/groups/radial.hpp>
#include <hamel/groups/second_kind.hpp>

namespace {

using namespace hamel;

template <class R>
class ProductRetractionLaws : public testing::Test {};
using Retractions = testing::Types<Exp<Product<SE2, SO2>>, Cayley<Product<SO3, Rn<2>>>,
                                   ProductRetraction<Exp<SE2>, Cayley<SO2>>>;
TYPED_TEST_SUITE(ProductRetractionLaws, Retractions);

TYPED_TEST(ProductRetractionLaws, Hold) {
  for (const LawResult& law : check_retraction<TypeParam>(1)) {
    EXPECT_TRUE(law.passed()) << TypeParam::Group::name() << " " << TypeParam::name() << ": "
                              << law;
  }
}

TEST(ProductRetractions, AreThoseOfAllFactors) {
  using Disk = Product<SE2, SO2>;
  static_assert(has_retraction<Disk, Exp<Disk>> && has_retraction<Disk, Cayley<Disk>>);
  static_assert(has_retraction<Disk, SecondKind<Disk>> && !has_retraction<Disk, Polar<Disk>>);
  using Pair = Product<SO3, SO3>;
  static_assert(has_retraction<Pair, Polar<Pair>>);
  EXPECT_EQ(Exp<Disk>::name(), "exp");
  EXPECT_EQ((ProductRetraction<Exp<SE2>, Cayley<SO2>>::name()), "exp*cayley");
  EXPECT_EQ(Exp<Disk>::domain(), "1: |omega| < pi; 2: |omega| < pi");
}

}  // namespace
