// Every single group obeys the group axioms (framework/check/group_laws.hpp, where the bounds are).
#include <gtest/gtest.h>

#include <hamel/framework/check/group_laws.hpp>
#include <hamel/groups/exp.hpp>

namespace {

using namespace hamel;

template <class G>
class GroupLaws : public testing::Test {};
using Groups = testing::Types<SO2, Rn<2>, SO3, SE2, SE3>;
TYPED_TEST_SUITE(GroupLaws, Groups);

TYPED_TEST(GroupLaws, Hold) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    for (const LawResult& law : check_group<TypeParam, Exp<TypeParam>>(seed)) {
      EXPECT_TRUE(law.passed()) << TypeParam::name() << ": " << law;
    }
  }
}

}  // namespace
