// exp on every single group obeys the laws (framework/check/retraction_laws.hpp).
#include <gtest/gtest.h>

#include <hamel/framework/check/retraction_laws.hpp>
#include <hamel/groups/exp.hpp>

namespace {

using namespace hamel;

template <class R>
class ExpLaws : public testing::Test {};
using Retractions = testing::Types<Exp<SO2>, Exp<Rn<2>>, Exp<SO3>, Exp<SE2>, Exp<SE3>>;
TYPED_TEST_SUITE(ExpLaws, Retractions);

TYPED_TEST(ExpLaws, Hold) {
  for (const LawResult& law : check_retraction<TypeParam>(1)) {
    EXPECT_TRUE(law.passed()) << TypeParam::Group::name() << " " << TypeParam::name() << ": "
                              << law;
  }
}

}  // namespace
