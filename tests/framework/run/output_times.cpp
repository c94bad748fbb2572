// Rows at requested times, of every scheme.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <hamel/hamel.hpp>

namespace hamel {
namespace {

TEST(Output, IsAtTheTimesAskedForWithEveryScheme) {
  const std::vector<double> times = {0, 0.013, 0.5, 0.9999, 1};
  for (const std::string& scheme : registry().schemes()) {
    if (scheme == "boxed_literal" || scheme == "unadapted" || scheme == "boxed") continue;
    const auto run = [&](double h) {
      return simulate("suslov")
          .set("inertia", {2, 0.3, 0.5, 3, 0.4, 4})
          .start({.velocity = {1, 0.5, 0}})
          .scheme(scheme)
          .step(h)
          .until(1)
          .output(times)
          .run();
    };
    const Result coarse = run(0.03), fine = run(0.015);  // 0.03: the last node is at 0.99
    ASSERT_TRUE(coarse);
    EXPECT_EQ(coarse.trajectory.column("t"), times) << scheme;
    const double order = std::log2(coarse.exact_error_max / fine.exact_error_max);
    if (coarse.exact_error_max > 1e-11) {
      EXPECT_GT(order, 1.7) << scheme << " " << coarse.exact_error_max;
    }
    EXPECT_LT(coarse.group_defect_max, 1e-14) << scheme;
  }
}

TEST(Output, LeavesTheStepsAlone) {
  const auto run = [] { return simulate("rattleback").step(0.01).until(2); };
  const Result plain = run().run(), dense = run().output(0.037).run();
  EXPECT_EQ(plain.last.coordinates, dense.last.coordinates);
  EXPECT_EQ(dense.trajectory.rows(), 55u);
}

}  // namespace
}  // namespace hamel
