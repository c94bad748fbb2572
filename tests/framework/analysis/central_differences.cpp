// Derivatives by differences: within their errors, errors near round-off, at every scale.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <hamel/framework/analysis/central_differences.hpp>

namespace hamel {
namespace {

using Function = std::function<double(double)>;

Derivative derivative(const Function& f, int order = 1,
                      const StepRange& steps = steps_of_any_scale()) {
  return CentralDifferences([&](double x) { return Eigen::VectorXd::Constant(1, f(x)); }, steps)
      .derivative(order);
}

// A derivative equal to a value within its error, and the error below a bound.
void expect(const Derivative& d, double value, double bound, const char* what) {
  EXPECT_LE(std::abs(d.value[0] - value), d.error[0]) << what;
  EXPECT_LE(d.error[0], bound) << what;
}

TEST(CentralDifferences, WhatIsSmallSteepOrNarrow) {
  expect(derivative([](double x) { return std::tanh(x / 0.01); }), 100, 1e-11, "steep");
  expect(derivative([](double x) { return std::tanh(x / 1e-8); }), 1e8, 1e-5, "steeper");
  // Beside the narrow part two steps agree on -1 to the last digit.
  expect(derivative([](double x) { return -x - 2e3 * x * std::exp(-x * x / 1e-8); }), -2001, 1e-9,
         "narrow");
  const auto spring = [](double x) {
    const double l = std::hypot(0.005, x);
    return -100 * (l - 0.006) * x / l;
  };
  expect(derivative(spring), 20, 1e-12, "over-centre spring");
  expect(derivative(spring, 3), -1.44e7, 1, "over-centre spring");
}

TEST(CentralDifferences, RoundOffThatNoValueShows) {
  // f(0) = 0 without an error, beside it values have that of 1 or of 0.7.
  expect(derivative([](double x) { return 1 - std::cos(x + 1e-9); }), 1e-9, 1e-12, "cancellation");
  expect(derivative([](double x) { return 1 - std::cos(x); }, 2), 1, 1e-9, "cancellation");
  const auto apart = [](double x) {
    volatile const double there = 3 * x + 0.7;  // rounded
    return there - 0.7;
  };
  expect(derivative(apart), 3, 1e-10, "offset");
  std::mt19937 random(1);
  const auto noisy = [&](double x) {
    return std::sin(x + 1) + 1e-10 * (static_cast<double>(random()) / 4294967295.0 - 0.5);
  };
  expect(derivative(noisy, 1, steps_of_scale(1)), std::cos(1.0), 1e-7, "noise");
}

TEST(CentralDifferences, WhatHasNoDerivative) {
  // The slopes on both sides differ by 2.
  EXPECT_GE(derivative([](double x) { return std::abs(x); }).error[0], 1);
  EXPECT_FALSE(std::isfinite(derivative([](double x) {
                               return x > 0 ? 1.0 : x < 0 ? -1.0 : 0;
                             }).error[0]));
  EXPECT_FALSE(
      std::isfinite(derivative([](double x) { return x < 0 ? std::nan("") : x; }).error[0]));
  const auto backlash = [](double x) { return x > 0.01 ? x - 0.01 : x < -0.01 ? x + 0.01 : 0; };
  expect(derivative(backlash), 0, 1e-12, "backlash");
  expect(derivative([](double) { return 9.81; }), 0, 1e-15, "constant");
}

// sin, tanh, Gauss, atan or a square root, and their derivatives.
struct Shape {
  int kind;
  double at;
  long double d[4] = {};

  Shape(int k, double x) : kind(k), at(x) {
    const auto u = static_cast<long double>(x);
    if (k == 0) set(std::cos(u), -std::sin(u), -std::cos(u));
    if (k == 1) {
      const long double t = std::tanh(u), q = 1 - t * t;
      set(q, -2 * t * q, q * (6 * t * t - 2));
    }
    if (k == 2) {
      const long double e = std::exp(-u * u);
      set(e * (1 - 2 * u * u), e * u * (4 * u * u - 6), e * (-6 + 24 * u * u - 8 * u * u * u * u));
    }
    const long double q = 1 + u * u;
    if (k == 3) set(1 / q, -2 * u / (q * q), (6 * u * u - 2) / (q * q * q));
    if (k == 4) {
      const long double s = std::sqrt(q);
      set(1 / (q * s), -3 * u / (q * q * s), (12 * u * u - 3) / (q * q * q * s));
    }
  }
  void set(long double first, long double second, long double third) {
    d[1] = first, d[2] = second, d[3] = third;
  }
  double operator()(double x) const {
    switch (kind) {
      case 0: return std::sin(x);
      case 1: return std::tanh(x);
      case 2: return x * std::exp(-x * x);
      case 3: return std::atan(x);
      default: return x / std::sqrt(1 + x * x);
    }
  }
};

// Sums of a wide and a narrow shape of random sizes, over eight decades of width, at their centre
// or beside it. Nearly all are within the error, none is far outside; errors are small beside the
// sizes of the terms.
TEST(CentralDifferences, RandomWidths) {
  std::mt19937 random(7);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  constexpr int count = 4000;
  int outside[4] = {};
  for (int i = 0; i < count; ++i) {
    const double wide = std::pow(10, 8 * uniform() - 4),
                 narrow = wide * std::pow(10, -4 * uniform()), a = std::pow(10, 12 * uniform() - 6),
                 b = a * std::pow(10, 4 * uniform() - 2),
                 x = (i % 3 == 0   ? 0
                      : i % 3 == 1 ? wide
                                   : narrow) *
                     (4 * uniform() - 2);
    const Shape one(static_cast<int>(random() % 5), x / wide),
        other(static_cast<int>(random() % 5), x / narrow);
    CentralDifferences differences(
        [&](double h) {
          return Eigen::VectorXd::Constant(1,
                                           a * one((x + h) / wide) + b * other((x + h) / narrow));
        },
        steps_of_any_scale(2.3e-16 * std::abs(x)));
    for (int order = 1; order <= 3; ++order) {
      const Derivative d = differences.derivative(order);
      const auto first = static_cast<long double>(a), second = static_cast<long double>(b);
      const long double size = first / std::pow(static_cast<long double>(wide), order) +
                               second / std::pow(static_cast<long double>(narrow), order),
                        value =
                            first * one.d[order] / std::pow(static_cast<long double>(wide), order) +
                            second * other.d[order] /
                                std::pow(static_cast<long double>(narrow), order);
      const double apart =
          static_cast<double>(std::abs(value - static_cast<long double>(d.value[0])));
      outside[order] += apart > d.error[0];
      EXPECT_LE(apart, 3 * d.error[0]) << i << " order " << order;
      const double known[] = {0, 1e-6, 1e-3, 1e-1};
      EXPECT_LE(d.error[0], known[order] * static_cast<double>(size)) << i << " order " << order;
    }
  }
  for (int order = 1; order <= 3; ++order) EXPECT_LE(outside[order], count / 500) << order;
}

}  // namespace
}  // namespace hamel
