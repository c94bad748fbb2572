// Formulas of files recorded as programs: their values and derivatives are those of the formula up
// to round-off.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include <hamel/framework/graph/code.hpp>
#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/framework/io/expression.hpp>

namespace hamel {
namespace {

const std::vector<std::string> kNames = {"x", "y", "z"};

std::vector<std::string> texts() {
  std::vector<std::string> out = {"2",
                                  "y",
                                  "m*x - -y",
                                  "-x^2",
                                  "2^3^2*x",
                                  "x/y/m",
                                  "x^y",
                                  "x^2.5",
                                  "2^x",
                                  "-(x - y)^4",
                                  "x^-1",
                                  "x^3 + x^2",
                                  "x > y ? x*y : y",
                                  "x < y ? x : y > 0 ? 1 : z",
                                  "(x > 0 && y > 0) + 2*(x > 0 || y > 0)",
                                  "x >= y ? 1 : x <= z",
                                  "x == y ? 3 : x != z ? 4*x : 5",
                                  "(x && y) ? x : z",
                                  "x ? y : z",
                                  "(x > y) ? 1/x : y^2",
                                  "(x > y)*z + (y > x)*x",
                                  "sin(x)*sin(x) + cos(sin(x)*y)",
                                  "atan2(y, x*z)",
                                  "min(x, y)*max(x, z)",
                                  "m*9.81*sin(0.1)*x",
                                  "y > 0 ? sqrt(y) : x",
                                  "x < 0 ? sqrt(x) : x^2",
                                  "x^2 + 0*y",
                                  "abs(x)^2",
                                  "sign(x)*rint(y) + x",
                                  "x*pi",
                                  "((x > 0) > (y > 0)) ? x : y",
                                  "exp(-x^2)*(1 + y*z)"};
  for (const std::string& f : Expression::functions()) {
    if (f == "atan2" || f == "min" || f == "max") continue;
    out.push_back(f + "(0.3 + 0.5*x*x)*y");
    out.push_back("x > 0 ? " + f + "(x) : y");
  }
  return out;
}

// Equal up to round-off, both not numbers, or the same infinity.
void expect_equal(double found, double expected, const std::string& what) {
  if (std::isnan(expected)) EXPECT_TRUE(std::isnan(found)) << what;
  else if (std::isinf(expected)) EXPECT_EQ(found, expected) << what;
  else EXPECT_NEAR(found, expected, 1e-14 * (1 + std::abs(expected))) << what;
}

TEST(RecordedExpression, HasTheValueAndTheDerivativesOfItsFormula) {
  for (const std::string& text : texts()) {
    const Expression formula(text, kNames, {{"m", 2}});
    graph::Recording recording;
    std::vector<graph::Number> x;
    for (const std::string& name : kNames) x.push_back(recording.input(name));
    const graph::Number y = formula.record(x);
    graph::Program::Outputs outputs = {{"value", y}};
    for (const graph::Number& slope : graph::gradient({y}, {1}, x))
      outputs.push_back({"slope", slope});
    const std::vector<double> rates = {0.3, -1.1, 0.7};
    outputs.push_back({"rate", graph::along({y}, x, {0.3, -1.1, 0.7})[0]});
    const graph::Code code(std::make_shared<const graph::Program>(recording, outputs));
    std::vector<double> found(outputs.size()), work(code.work_size());

    const std::vector<std::vector<double>> places = {
        {0.7, -0.3, 0.45}, {-0.7, 0.6, 1.9}, {0.2, 0.2, -3}, {0.4, 0.9, 0.4}, {0.99, 0.01, 0.5}};
    for (const std::vector<double>& at : places) {
      const std::string what = text + " at " + std::to_string(at[0]);
      code(at.data(), found.data(), work.data());
      std::vector<double> slopes(3, 0.0);
      expect_equal(found[0], formula.differentiate(at, 1, slopes), what);
      for (size_t i = 0; i < 3; ++i)
        expect_equal(found[1 + i], slopes[i], what + " by " + kNames[i]);
      expect_equal(found[4], formula.rate(at, rates), what + ", rate");
    }
  }
}

/// At zeros, the branch that is not taken leaves no trace, as in the formula.
TEST(RecordedExpression, HasItsDerivativesAtZeros) {
  for (const char* text :
       {"x < 0 ? sqrt(x) : x^2", "x^2 + 0*y", "abs(x)^2", "x > 0 ? sqrt(x)/x : 2*x",
        "x == 0 ? 1 : sin(x)/x", "y > 0 ? ln(y) : x", "max(x, sqrt(y) - 1)"}) {
    const Expression formula(text, {"x", "y"});
    graph::Recording recording;
    const std::vector<graph::Number> x = {recording.input("x"), recording.input("y")};
    const auto slope = graph::gradient({formula.record(x)}, {1}, x);
    const graph::Code code(std::make_shared<const graph::Program>(
        recording, graph::Program::Outputs{{"by x", slope[0]}, {"by y", slope[1]}}));
    std::vector<double> at = {0, 0}, found(2), work(code.work_size()), slopes(2, 0.0);
    code(at.data(), found.data(), work.data());
    formula.differentiate(at, 1, slopes);
    EXPECT_EQ(found, slopes) << text;
  }
}

}  // namespace
}  // namespace hamel
