// Every retraction of the single groups obeys the laws (framework/check/retraction_laws.hpp).
#include <gtest/gtest.h>

#include <hamel/framework/check/retraction_laws.hpp>
#include <hamel/groups/cayley.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/radial.hpp>

namespace {

using namespace hamel;

template <class R>
class RetractionLaws : public testing::Test {};
using Retractions = testing::Types<Exp<SO2>, Exp<Rn<2>>, Exp<SO3>, Exp<SE2>, Exp<SE3>, Cayley<SO2>,
                                   Cayley<Rn<3>>, Cayley<SO3>, Cayley<SE2>, Cayley<SE3>, Polar<SO3>>;
TYPED_TEST_SUITE(RetractionLaws, Retractions);

TYPED_TEST(RetractionLaws, Hold) {
  for (const LawResult& law : check_retraction<TypeParam>(1)) {
    EXPECT_TRUE(law.passed()) << TypeParam::Group::name() << " " << TypeParam::name() << ": " << law;
  }
}

}  // namespace
