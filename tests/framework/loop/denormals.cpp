// A velocity that decays for ever does not end in subnormal numbers, which would slow every step
// twenty times; the caller's own floating-point mode is untouched.
#include <gtest/gtest.h>

#include <cmath>

#include <hamel/hamel.hpp>

namespace {

using namespace hamel;

TEST(Denormals, AreFlushedWithinTheLoopOnly) {
#if !defined(__SSE2__)
  GTEST_SKIP() << "the mode is that of SSE2";
#endif
  const unsigned before = _mm_getcsr();
  // omega of the sleigh decays like e^{-kappa t}: subnormal after about 480 s.
  hamel::Run run = simulate<Lift, Cayley>(ChaplyginSleigh{}).step(0.01).build();
  int subnormal = 0;
  for (int i = 0; i < 700; ++i) {
    ASSERT_TRUE(run.step(100));
    for (const double v : run.state().velocity) subnormal += std::fpclassify(v) == FP_SUBNORMAL;
  }
  EXPECT_EQ(subnormal, 0);
  EXPECT_EQ(_mm_getcsr() & 0xffc0u, before & 0xffc0u);  // but for the flags that say what happened
  volatile double tiny = 1e-310;
  EXPECT_GT(tiny * 0.5, 0);
}

}  // namespace
