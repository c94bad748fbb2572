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
  return {x[0] * x[1] / (1 + x[2] * x[2]), sqrt(1 + x[0] * x[0]) * sin(x[1]) - cos(x[2] * x[0]),
          exp(x[0] * x[1]) / log(3 + x[2] * x[2]),
          select(x[0] < x[1], abs(x[0] * x[2]), min(x[0], x[1]) * x[2]) - max(x[1], x[2]) * x[0],
          rint(x[0]) * x[1]};
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
    ASSERT_TRUE(evaluation.possible());
    const std::vector<double> found = evaluation(kUnits, units);
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

TEST(Nilpotent, SaysWhatItDoesNotKnow) {
  Recording recording;
  const Number x = recording.input("x");
  const Numbers known = {x * x}, unknown = {atan(x)};
  EXPECT_TRUE(NilpotentEvaluation(recording, known).possible());
  EXPECT_FALSE(NilpotentEvaluation(recording, unknown).possible());
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
