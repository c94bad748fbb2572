// Sine and cosine of programs against those of long doubles.
//
// Bounds: the polynomials of fdlibm are exact to 0.5 units in the last place on |r| <= pi/4; the
// reduced angle r is a double, whose rounding adds up to one unit more. Near a zero of the function
// r is small, and what the three parts of pi/2 leave out, 67,000 x 8e-32 at most, and the last
// subtraction's rounding are absolute.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include <hamel/framework/graph/code.hpp>

namespace hamel::graph {
namespace {

class Sine : public testing::Test {
 protected:
  static Code make(int width) {
    Recording recording;
    const Number x = recording.input("x");
    return Code(
        std::make_shared<const Program>(recording, Program::Outputs{{"s", sin(x)}, {"c", cos(x)}}),
        width);
  }
  struct Pair {
    double s, c;
  };
  Pair at(double x) {
    double y[2];
    code_(&x, y, work_.data());
    return {y[0], y[1]};
  }
  const Code code_ = make(1);
  std::vector<double> work_ = std::vector<double>(code_.work_size());
};

// Error in units in the last place of the exact value.
double units(double found, long double exact) {
  const double e = static_cast<double>(exact);
  const double unit = std::nextafter(std::abs(e), HUGE_VAL) - std::abs(e);
  return static_cast<double>(std::abs(static_cast<long double>(found) - exact)) / unit;
}

TEST_F(Sine, IsAccurateToUnitsInTheLastPlace) {
  std::mt19937 random(1);
  for (const double range : {0.8, 10.0, 1e3, 1e5}) {
    double worst = 0, near_zeros = 0;
    std::uniform_real_distribution<double> inside(-range, range);
    for (int i = 0; i < 200000; ++i) {
      const double x = inside(random);
      const Pair y = at(x);
      const long double s = std::sin(static_cast<long double>(x)),
                        c = std::cos(static_cast<long double>(x));
      for (const auto& [found, exact] : {std::pair{y.s, s}, std::pair{y.c, c}}) {
        if (std::abs(exact) > 1e-3L) worst = std::max(worst, units(found, exact));
        else
          near_zeros = std::max(
              near_zeros, static_cast<double>(std::abs(static_cast<long double>(found) - exact)));
      }
    }
    std::printf("|x| <= %g: %.2f units in the last place, %.1e near zeros\n", range, worst,
                near_zeros);
    EXPECT_LT(worst, range <= 1e3 ? 1.5 : 2.5);
    EXPECT_LT(near_zeros, 4e-19);
  }
}

TEST_F(Sine, IsThatOfTheLibraryBeyondTheRange) {
  for (const double x : {100000.00000000001, -3e5, 1e22, 1.7e308, -1e6}) {
    EXPECT_EQ(at(x).s, std::sin(x)) << x;
    EXPECT_EQ(at(x).c, std::cos(x)) << x;
  }
  for (const double x : {HUGE_VAL, -HUGE_VAL, std::nan("")}) {
    EXPECT_TRUE(std::isnan(at(x).s) && std::isnan(at(x).c));
  }
  EXPECT_NEAR(at(kLargestAngle).s, std::sin(kLargestAngle), 2e-16);
}

/// Lanes with a large angle do not change the others.
TEST_F(Sine, IsTheSameInEachLane) {
  const Code lanes = make(8);
  std::vector<double> work(lanes.work_size());
  const double x[8] = {0.3, -2, 1e7, 4, 1e5, -1e6, 7e4, 0};
  double y[16];
  lanes(x, y, work.data());
  for (int j = 0; j < 8; ++j) {
    EXPECT_EQ(y[j], at(x[j]).s);
    EXPECT_EQ(y[8 + j], at(x[j]).c);
  }
}

TEST_F(Sine, HasExactValues) {
  EXPECT_EQ(at(0).s, 0);
  EXPECT_EQ(at(0).c, 1);
  EXPECT_EQ(at(1e-300).s, 1e-300);
  for (const double x : {0.1, 1.0, 2.0, 100.0}) {  // odd and even
    EXPECT_EQ(at(-x).s, -at(x).s);
    EXPECT_EQ(at(-x).c, at(x).c);
  }
}

}  // namespace
}  // namespace hamel::graph
