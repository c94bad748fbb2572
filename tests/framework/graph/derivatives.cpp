// Derivatives of recorded formulas: against differences of long doubles, forwards against
// backwards, at branches.
#include <hamel/framework/graph/derivatives.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <hamel/framework/graph/code.hpp>

#include "random_formula.hpp"

namespace hamel::graph {
namespace {

constexpr double kInf = HUGE_VAL;

std::vector<double> evaluated(const Recording& recording, const std::vector<Number>& y,
                              const std::vector<double>& x) {
  Program::Outputs outputs;
  for (const Number& v : y) outputs.push_back({"y", v});
  const Code code(std::make_shared<const Program>(recording, outputs));
  std::vector<double> work(code.work_size()), out(y.size());
  code(x.data(), out.data(), work.data());
  return out;
}

std::vector<Number> inputs_of(Recording& recording, size_t n) {
  std::vector<Number> x;
  for (size_t i = 0; i < n; ++i) x.push_back(recording.input("x" + std::to_string(i)));
  return x;
}

constexpr int kOperations = 14;

std::vector<long double> smooth(const std::vector<double>& x, const std::vector<double>& r,
                                long double e, unsigned seed) {
  std::vector<long double> moved;
  for (size_t i = 0; i < x.size(); ++i) {
    moved.push_back(static_cast<long double>(x[i]) + e * static_cast<long double>(r[i]));
  }
  return test::RandomFormula<long double>(moved, seed, test::Kind::smooth, kOperations).numbers();
}

// Derivative along r by central differences of order 6.
std::vector<long double> difference(const std::vector<double>& x, const std::vector<double>& r,
                                    unsigned seed) {
  constexpr long double h = 1e-3L;
  std::vector<long double> sum(smooth(x, r, 0, seed).size(), 0);
  const std::pair<int, long double> weights[] = {{1, 0.75L}, {2, -0.15L}, {3, 1 / 60.0L}};
  for (const auto& [k, w] : weights) {
    const auto after = smooth(x, r, h * k, seed), before = smooth(x, r, -h * k, seed);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += w * (after[i] - before[i]) / h;
  }
  return sum;
}

/// Bound: differences of order 6 and a step of 1e-3 are exact to 1e-18 f'''''''/140 and 1e-16 f.
TEST(Derivatives, AreThoseOfDifferences) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed + 1000);
    std::uniform_real_distribution<double> number(-1, 1);
    std::vector<double> x(4), r(4), both;
    for (double& v : x) v = number(random);
    for (double& v : r) v = number(random);
    both = x;
    both.insert(both.end(), r.begin(), r.end());

    Recording recording;
    const auto in = inputs_of(recording, 4);
    std::vector<Number> rates;
    for (size_t i = 0; i < 4; ++i) rates.push_back(recording.input("r" + std::to_string(i)));
    const auto y = test::RandomFormula<Number>(in, seed, test::Kind::smooth, kOperations).numbers();
    const auto found = evaluated(recording, along(y, in, rates), both);
    const auto expected = difference(x, r, seed);
    for (size_t k = 0; k < y.size(); ++k) {
      const double e = static_cast<double>(expected[k]);
      if (std::abs(e) > 1e4) continue;
      EXPECT_NEAR(found[k], e, 1e-8 * (1 + std::abs(e))) << seed << ' ' << k;
    }
  }
}

/// w . (J r) = (J^T w) . r, of all operations: where J r is finite, so is J^T w. At zeros, too,
/// where slopes are infinite.
TEST(Derivatives, BackwardsAreThoseForwards) {
  size_t compared = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    const auto kind = seed % 2 ? test::Kind::every : test::Kind::smooth;
    Recording recording;
    const auto x = inputs_of(recording, 3);
    const auto numbers = test::RandomFormula<Number>(x, seed, kind, 20).numbers();
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(-1, 1);
    std::vector<double> at = {number(random), number(random), number(random)};
    if (seed % 5 == 0) at[seed % 3] = 0;
    for (const Number& y : numbers) {
      std::vector<Number> results = gradient({y}, {1}, x);
      for (size_t i = 0; i < x.size(); ++i) {
        std::vector<Number> unit(x.size());
        unit[i] = 1;
        results.push_back(along({y}, x, unit)[0]);
      }
      const std::vector<double> found = evaluated(recording, results, at);
      for (size_t i = 0; i < 3; ++i) {
        if (!(std::abs(found[3 + i]) < 1e6)) continue;
        ++compared;
        EXPECT_NEAR(found[i], found[3 + i], 1e-10 * (1 + std::abs(found[3 + i])))
            << seed << ' ' << i;
      }
    }
  }
  EXPECT_GT(compared, 10000u);
}

TEST(Derivatives, OfWhatIsNotSelectedCountNothing) {
  Recording recording;
  const Number x = recording.input("x");
  const struct {
    Number y;
    double at, slope;
  } cases[] = {
      {select(x > 0, sqrt(x) / x, 2 * x), 0, 2},
      {select(x > 0, sqrt(x) / x, 2 * x), -1, 2},
      {select(x > 0, sqrt(x) / x, 2 * x), 4, -0.0625},
      {select(x > 0, log(x), x * x), 0, 0},
      {select(x > 0, sin(sqrt(x)) * x, 3 * x), 0, 3},
      {min(2 * x, sqrt(x) + 1), 0, 2},
      {max(2 * x, sqrt(x) - 1), 0, 2},
      {select(x == 0, 1, sin(x) / x), 0, 0},
      {abs(x), 0, 0},
      {abs(x), -3, -1},
      {rint(x) * x, 2.2, 2},
      {pow(x, 2.5), 0, 0},
      {pow(2, x), 3, 8 * std::log(2)},
      {sqrt(x), 0, kInf},
  };
  for (const auto& c : cases) {
    const auto found =
        evaluated(recording, {along({c.y}, {x}, {1})[0], gradient({c.y}, {1}, {x})[0]}, {c.at});
    EXPECT_THAT(found, testing::Each(testing::DoubleEq(c.slope))) << &c - cases;
  }
}

TEST(Derivatives, OfConstantsVanish) {
  Recording recording;
  const Number x = recording.input("x"), y = recording.input("y");
  EXPECT_TRUE(along({x * x}, {y}, {1})[0].is(0));
  EXPECT_TRUE(gradient({x * x, 3}, {1, 1}, {y})[0].is(0));
  EXPECT_TRUE(along({5}, {y}, {1})[0].is(0));
  EXPECT_EQ(along({x + y}, {y}, {1})[0].value(), 1);
  EXPECT_THROW(along({x}, {y}, {}), std::invalid_argument);
  EXPECT_THROW(gradient({x}, {}, {y}), std::invalid_argument);
}

/// By an intermediate value, held to be independent.
TEST(Derivatives, MayBeByIntermediateValues) {
  Recording recording;
  const Number x = recording.input("x"), s = sin(x), y = s * s * x;
  const auto found =
      evaluated(recording, {along({y}, {s}, {1})[0], gradient({y}, {1}, {s})[0]}, {0.7});
  EXPECT_THAT(found, testing::Each(testing::DoubleNear(2 * std::sin(0.7) * 0.7, 1e-15)));
}

/// Hessian: symmetric, and the derivative of the gradient; exact of a polynomial.
TEST(Derivatives, OfSecondOrder) {
  Recording recording;
  const auto x = inputs_of(recording, 3);
  const Number w = recording.input("w");
  const std::vector<Number> y = {x[0] * x[0] * x[1], x[1] * sin(x[2]), exp(x[0] * x[2])};
  const auto h = hessian(y, {w, 1, 2}, x);
  std::vector<Number> all;
  for (const auto& row : h) all.insert(all.end(), row.begin(), row.end());
  const double a = 0.3, b = -1.2, c = 0.8, v = 1.7, e = std::exp(a * c);
  const auto found = evaluated(recording, all, {a, b, c, v});
  const double expected[] = {2 * v * b + 2 * c * c * e,
                             2 * v * a,
                             2 * (1 + a * c) * e,
                             2 * v * a,
                             0,
                             std::cos(c),
                             2 * (1 + a * c) * e,
                             std::cos(c),
                             -b * std::sin(c) + 2 * a * a * e};
  for (size_t i = 0; i < 9; ++i) EXPECT_NEAR(found[i], expected[i], 1e-14) << i;
}

/// Of random formulas: symmetric.
TEST(Derivatives, OfSecondOrderAreSymmetric) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    Recording recording;
    const auto x = inputs_of(recording, 3);
    const auto y = test::RandomFormula<Number>(x, seed, test::Kind::smooth, kOperations).numbers();
    const auto h = hessian({y.back()}, {1}, x);
    const auto v = evaluated(recording, {h[0][1], h[1][0], h[0][2], h[2][0], h[1][2], h[2][1]},
                             {0.3, -0.6, 0.9});
    for (size_t i = 0; i < 6; i += 2)
      EXPECT_NEAR(v[i], v[i + 1], 1e-10 * (1 + std::abs(v[i]))) << seed;
  }
}

}  // namespace
}  // namespace hamel::graph
