// The Cayley map on every single group obeys the laws (framework/check/retraction_laws.hpp).
#include <gtest/gtest.h>

#include <hamel/framework/check/retraction_laws.hpp>
#include <hamel/groups/cayley.hpp>

namespace {

using namespace hamel;

template <class R>
class CayleyLaws : public testing::Test {};
using Retractions =
    testing::Types<Cayley<SO2>, Cayley<Rn<3>>, Cayley<SO3>, Cayley<SE2>, Cayley<SE3>>;
TYPED_TEST_SUITE(CayleyLaws, Retractions);

TYPED_TEST(CayleyLaws, Hold) {
  for (const LawResult& law : check_retraction<TypeParam>(1)) {
    EXPECT_TRUE(law.passed()) << TypeParam::Group::name() << " " << TypeParam::name() << ": "
                              << law;
  }
}

}  // namespace
