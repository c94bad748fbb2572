// Formulas at numbers with nilpotent units: mixed derivatives against those recorded one by one.
#include <hamel/framework/graph/nilpotent.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <hamel/framework/graph/code.hpp>
#include <hamel/framework/graph/derivatives.hpp>

namespace hamel::graph {
namespace {

using Numbers = std::vector<Number>;

Numbers formulas(const Numbers& x) {
  return {x[0] * x[1] / (1 + x[2] * x[2]),
          sqrt(1 + x[0] * x[0]) * sin(x[1]) - cos(x[2] * x[0]),
          exp(x[0] * x[1]) / log(3 + x[2] * x[2]),
          select(x[0] < x[1], abs(x[0] * x[2]), min(x[0], x[1]) * x[2]) - max(x[1], x[2]) * x[0],
          rint(x[0]) * x[1],
          asin(0.5 * x[0]) * acos(0.4 * x[1]) - atan(x[2] * x[0]),
          sinh(x[0]) * tanh(x[1] - x[2]) / cosh(x[1]) + tan(x[2]),
          atan2(x[0] - 1.5, x[1] * x[2]),
          pow(x[0], 5) * pow(2 + x[1], 1.7) - pow(3 + x[0], x[1] * x[2])};
}

// Derivatives along all sets of the directions, S at its number of bits.
TEST(Nilpotent, MixedDerivativesAreThoseRecordedOneByOne) {
  constexpr int kUnits = 4;
  constexpr size_t kSize = size_t{1} << kUnits;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<double> x(3);
    for (double& entry : x) entry = number(random);
    std::vector<std::vector<double>> directions(kUnits, std::vector<double>(3));
    for (auto& v : directions)
      for (double& entry : v) entry = number(random);

    Recording recording;
    const Numbers in = {recording.input("a"), recording.input("b"), recording.input("c")};
    const Numbers y = formulas(in);
    std::vector<double> units(3 * kSize);
    for (size_t i = 0; i < 3; ++i) {
      units[i * kSize] = x[i];
      for (size_t u = 0; u < kUnits; ++u) units[i * kSize + (size_t{1} << u)] = directions[u][i];
    }
    NilpotentEvaluation evaluation(recording, y);
    const std::vector<double>& found = evaluation(kUnits, units);
    for (size_t set = 0; set < kSize; ++set) {
      Numbers derivative = y;
      for (size_t u = 0; u < kUnits; ++u)
        if ((set >> u & 1) != 0)
          derivative = along(derivative, in, Numbers(directions[u].begin(), directions[u].end()));
      Program::Outputs outputs;
      for (const Number& v : derivative) outputs.emplace_back("y", v);
      const Code code(std::make_shared<const Program>(recording, outputs));
      std::vector<double> out(y.size()), work(code.work_size());
      code(x.data(), out.data(), work.data());
      for (size_t k = 0; k < y.size(); ++k)
        EXPECT_NEAR(found[k * kSize + set], out[k], 1e-12 * (1 + std::abs(out[k])))
            << "formula " << k << ", set " << set;
    }
  }
}

// x^8 at 0 has one derivative, sqrt(x) none.
TEST(Nilpotent, PowersAtZero) {
  Recording recording;
  const Number x = recording.input("x");
  NilpotentEvaluation evaluation(recording, {pow(x, 8), sqrt(x)});
  constexpr size_t kSize = 1 << 8;
  std::vector<double> in(kSize, 0.0);
  for (size_t unit = 1; unit < kSize; unit *= 2) in[unit] = 1;
  const std::vector<double>& found = evaluation(8, in);
  for (size_t set = 0; set < kSize; ++set) EXPECT_EQ(found[set], set + 1 == kSize ? 40320 : 0);
  EXPECT_FALSE(std::isfinite(found[kSize + 1]));
}

TEST(Nilpotent, TellsWhatItNeeds) {
  Recording recording;
  const Number x = recording.input("x"), y = recording.input("y"), z = recording.input("z");
  const NilpotentEvaluation evaluation(recording, {x * cos(z), x + 1});
  EXPECT_EQ(evaluation.needs(), (std::vector<bool>{true, false, true}));
  EXPECT_FALSE(y.constant());
}

// (1 + x^2) - x^2 keeps 1, with the round-off of x^2 = 1e8.
TEST(Nilpotent, NoiseShowsRoundOff) {
  Recording recording;
  const Number x = recording.input("x");
  const Numbers y = {(1 + x * x) - x * x};
  NilpotentEvaluation evaluation(recording, y);
  const std::vector<double> in = {1e4};
  EXPECT_EQ(evaluation(0, in)[0], 1);
  double moved = 0;
  for (int i = 0; i < 8; ++i) moved = std::max(moved, std::abs(evaluation(0, in, 0x1p-52)[0] - 1));
  EXPECT_GT(moved, 1e-10);
  EXPECT_LT(moved, 1e-6);
}

}  // namespace
}  // namespace hamel::graph
