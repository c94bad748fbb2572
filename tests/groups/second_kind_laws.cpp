// Coordinates of the second kind obey the laws (framework/check/retraction_laws.hpp).
#include <gtest/gtest.h>

#include <hamel/framework/check/retraction_laws.hpp>
#include <hamel/groups/second_kind.hpp>

namespace {

using namespace hamel;

template <class R>
class SecondKindLaws : public testing::Test {};
using Retractions =
    testing::Types<SecondKind<SO3>, SecondKindSymmetric<SO3>, SecondKind<SE2>,
                   SecondKindSymmetric<SE2>, SecondKind<SE3>, SecondKindSymmetric<SE3>>;
TYPED_TEST_SUITE(SecondKindLaws, Retractions);

TYPED_TEST(SecondKindLaws, Hold) {
  for (const LawResult& law : check_retraction<TypeParam>(1)) {
    EXPECT_TRUE(law.passed()) << TypeParam::Group::name() << " " << TypeParam::name() << ": "
                              << law;
  }
}

}  // namespace
