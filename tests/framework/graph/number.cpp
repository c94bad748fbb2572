// Recorded formulas: their values are those of doubles, constants fold, equal operations are one
// node.
#include <hamel/framework/graph/number.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

#include <Eigen/Dense>

#include <hamel/framework/graph/code.hpp>

#include "random_formula.hpp"

namespace hamel::graph {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInf = HUGE_VAL;

// Instructions that a formula of inputs takes.
size_t instructions(const Recording& recording, const Number& y) {
  return Program(recording, {{"y", y}}).instructions().size();
}

double value(const Recording& recording, const Number& y, std::vector<double> x) {
  const Code code(std::make_shared<const Program>(recording, Program::Outputs{{"y", y}}));
  std::vector<double> work(code.work_size());
  double out;
  x.resize(recording.inputs().size() + 1);
  code(x.data(), &out, work.data());
  return out;
}

/// Exact: additions, selections and halves of small integers do not round, in whatever order.
TEST(Number, HasTheValuesOfDoubles) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    std::vector<double> x;
    for (int i = 0; i < 5; ++i) x.push_back(std::uniform_int_distribution(-9, 9)(random));
    const test::RandomFormula<double> expected(x, seed, test::Kind::arithmetic, 30);
    const auto program = test::random_program(seed, 5, 30, true, test::Kind::arithmetic);
    const Code code(program);
    std::vector<double> work(code.work_size()), y(program->outputs().size());
    code(x.data(), y.data(), work.data());
    EXPECT_EQ(y, expected.numbers()) << seed;
  }
}

TEST(Number, FoldsConstantsAsDoublesDo) {
  Recording recording;
  const Number zero = 0, x = recording.input("x");
  EXPECT_TRUE(std::isnan((zero * Number(kNaN)).value()));
  EXPECT_TRUE(std::isnan((Number(kNaN) * zero).value()));
  EXPECT_TRUE(std::isnan((zero * Number(kInf)).value()));
  EXPECT_TRUE(std::isnan((zero / zero).value()));
  EXPECT_EQ((Number(1) / zero).value(), kInf);
  EXPECT_TRUE(std::isnan(sqrt(Number(-1)).value()));
  EXPECT_EQ((Number(0.1) + 0.2).value(), 0.1 + 0.2);
  EXPECT_EQ(sin(Number(0.3)).value(), std::sin(0.3));
  EXPECT_EQ(pow(Number(2), 0.5).value(), std::pow(2, 0.5));
  EXPECT_EQ(select(Number(1) < 2, Number(3), Number(4)).value(), 3);
  EXPECT_FALSE((Number(kNaN) == kNaN).value());
  EXPECT_TRUE((Number(kNaN) != kNaN).value());
  EXPECT_TRUE(std::isnan(value(recording, x * kNaN, {2})));
  EXPECT_TRUE(std::isnan(value(recording, Number(kNaN) + zero * x, {2})));
}

TEST(Number, FoldsZerosOnesAndSigns) {
  Recording recording;
  const Number x = recording.input("x"), y = recording.input("y");
  for (const Number& same :
       {x + 0, 0 + x, x - 0, 1 * x, x * 1, x / 1, -(-x), pow(x, 1), -1 * -x, x / -1 * -1,
        2 * (0.5 * x), x + 0 * y, select(x < x, y, y) * 0 + x, 3 * x - 2 * x}) {
    EXPECT_EQ(same.node(), x.node());
  }
  for (const Number& zero : {0 * x, x * 0, x - x, 0 / x, x + -x, 2 * x - 2 * x, -x + x})
    EXPECT_TRUE(zero.is(0));
  EXPECT_EQ((x + x).node(), (2 * x).node());
  EXPECT_EQ((x - -y).node(), (x + y).node());
  EXPECT_EQ((-x * y).node(), (-(x * y)).node());
  EXPECT_EQ((x + -2 * y).node(), (x - 2 * y).node());
  EXPECT_EQ((x / 4).node(), (0.25 * x).node());
  EXPECT_NE((x / 3).node(), (x * (1.0 / 3)).node());  // rounds otherwise
  EXPECT_EQ(abs(-x).node(), abs(x).node());
  EXPECT_EQ(cos(-x).node(), cos(x).node());
  EXPECT_EQ(pow(x, 2).node(), (x * x).node());
  EXPECT_TRUE(pow(x, 0).is(1));
}

/// Products of constants that would leave the range of doubles are not combined.
TEST(Number, CombinesConstantsWithinRange) {
  Recording recording;
  const Number x = recording.input("x");
  EXPECT_EQ(value(recording, 1e-200 * (1e-200 * x), {1e200}), 1e-200 * (1e-200 * 1e200));
  EXPECT_EQ(value(recording, 1e200 * (1e200 * x), {1e-300}), 1e200 * (1e200 * 1e-300));
  EXPECT_EQ(value(recording, 1e308 * x + 1e308 * x, {1e-5}), 1e308 * 1e-5 + 1e308 * 1e-5);
}

TEST(Number, SharesEqualOperations) {
  Recording recording;
  const Number x = recording.input("x"), y = recording.input("y");
  EXPECT_EQ((x * y).node(), (y * x).node());
  EXPECT_EQ((x + y).node(), (y + x).node());
  EXPECT_NE((x - y).node(), (y - x).node());
  EXPECT_EQ(sqrt(x * y + 1).node(), sqrt(1 + y * x).node());
  EXPECT_EQ(instructions(recording, (x * y + 1) * (x * y + 1)), 3u);
  for (int i = 0; i < 5000; ++i) (void)(x + i);  // the table grows
  const size_t nodes = recording.nodes().size();
  for (int i = 0; i < 5000; ++i) (void)(x + i);
  EXPECT_EQ(recording.nodes().size(), nodes);
}

TEST(Number, IsAScalarOfEigen) {
  Recording recording;
  Eigen::Matrix<Number, 3, 3> m;
  std::vector<double> x;
  Eigen::Matrix3d expected;
  for (int i = 0; i < 9; ++i) {
    m(i) = recording.input("m" + std::to_string(i));
    x.push_back(0.3 * i * i - i + (i % 4 == 0 ? 5 : 0));
    expected(i) = x.back();
  }
  const Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity() * 2;
  const Eigen::Matrix<Number, 3, 3> product = m.transpose() * m + rotation * m - m.inverse();
  const Eigen::Matrix3d wanted =
      expected.transpose() * expected + rotation * expected - expected.inverse();
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(value(recording, product(i), x), wanted(i), 1e-12);
  EXPECT_NEAR(value(recording, m.determinant(), x), expected.determinant(), 1e-11);
  EXPECT_NEAR(value(recording, m.col(0).cross(m.col(1)).norm(), x),
              expected.col(0).cross(expected.col(1)).norm(), 1e-12);
  // Zeros and ones of a matrix are constants: nothing is computed with them.
  const Eigen::Matrix<Number, 3, 3> same = m * Eigen::Matrix<Number, 3, 3>::Identity();
  EXPECT_EQ(same(1, 2).node(), m(1, 2).node());
}

TEST(Number, NeedsARecording) {
  EXPECT_EQ((Number(2) + 3).value(), 5);
  Number x;
  {
    Recording outer;
    x = outer.input("x");
    {
      const Recording inner;
      EXPECT_EQ(&Recording::current(), &inner);
    }
    EXPECT_EQ(&Recording::current(), &outer);
    std::thread([&] { EXPECT_THROW((void)Recording::current(), std::logic_error); }).join();
  }
  EXPECT_THROW((void)(x + 1), std::logic_error);
}

TEST(Program, HasNamedInputsAndOutputs) {
  Recording recording;
  const Number x = recording.input("x"), y = recording.input("steer.angle");
  const Program program(recording, {{"sum", x + y}, {"two", 2}, {"x", x}, {"sum again", y + x}});
  EXPECT_THAT(program.inputs(), testing::ElementsAre("x", "steer.angle"));
  EXPECT_THAT(program.outputs(), testing::ElementsAre("sum", "two", "x", "sum again"));
  EXPECT_EQ(program.output("two"), 1u);
  EXPECT_THROW((void)program.output("three"), std::out_of_range);
  EXPECT_EQ(program.instructions().size(), 1u);
  EXPECT_THROW(Code(nullptr), std::invalid_argument);
  EXPECT_THROW(Code(std::make_shared<const Program>(program), 2), std::invalid_argument);
}

}  // namespace
}  // namespace hamel::graph
