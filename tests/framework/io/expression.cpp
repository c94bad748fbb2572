// Formulas of files: their values, their exact derivatives, and what is wrong with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <hamel/framework/check/system_laws.hpp>
#include <hamel/framework/io/expression.hpp>

namespace hamel {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::vector<std::string> kNames = {"x", "y", "steer.angle", "theta'"};
const std::vector<double> kAt = {0.7, -0.3, 0.45, 1.9};

double value(const std::string& text) { return Expression(text, kNames, {{"m", 2}})(kAt); }

TEST(Expression, HasTheValueOfItsFormula) {
  const double x = kAt[0], y = kAt[1], s = kAt[2], w = kAt[3];
  EXPECT_EQ(value("2"), 2);
  EXPECT_EQ(value("m*x - -y"), 2 * x + y);
  EXPECT_EQ(value("-x^2"), -x * x);
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("x/y/m"), x / y / 2);
  EXPECT_EQ(value("sin(steer.angle)*theta'^2"), std::sin(s) * (w * w));
  EXPECT_EQ(value("atan2(y, x) + max(x, y) + min(x, y)"), std::atan2(y, x) + x + y);
  EXPECT_EQ(value("x > y ? x : y"), x);
  EXPECT_EQ(value("x < y ? x : y > 0 ? 1 : 2"), 2);
  EXPECT_EQ(value("(x > 0 && y > 0) + 2*(x > 0 || y > 0)"), 2);
  EXPECT_EQ(value("pi"), std::acos(-1.0));
  EXPECT_EQ(value("y > 0 ? sqrt(y) : 0"), 0);
  EXPECT_EQ(value("1.5e-3"), 1.5e-3);
}

/// By every variable, of every function and operator, against differences of order 6.
TEST(Expression, HasExactDerivatives) {
  std::vector<std::string> texts = {"x*y + m*x/steer.angle - theta'^3",
                                    "x^y",
                                    "x^2.5",
                                    "2^x",
                                    "-(x - y)^4",
                                    "x > y ? x*y : y",
                                    "x < y ? x : sin(y)*x",
                                    "sin(x)*sin(x) + cos(sin(x)*y)",
                                    "atan2(y, x*steer.angle)",
                                    "min(x, y)*max(x, theta')",
                                    "m*9.81*sin(0.1)*x",
                                    "y > 0 ? sqrt(y) : x"};
  for (const std::string& f : Expression::functions()) {
    if (f != "atan2" && f != "min" && f != "max") texts.push_back(f + "(0.3 + 0.5*x*x)*y");
  }
  for (const std::string& text : texts) {
    const Expression formula(text, kNames, {{"m", 2}});
    std::vector<double> slopes(kNames.size(), 1.0);
    EXPECT_EQ(formula.differentiate(kAt, 3, slopes), formula(kAt)) << text;
    for (size_t i = 0; i < kNames.size(); ++i) {
      const double derivative = check::derivative(
          [&](double e) {
            std::vector<double> moved = kAt;
            moved[i] += e;
            return formula(moved);
          },
          2e-3);
      EXPECT_NEAR(slopes[i], 1 + 3 * derivative, 1e-10) << text << " by " << kNames[i];
    }
    const std::vector<double> rates = {0.3, -1.1, 0.7, 0.2};
    double rate = 0;
    for (size_t i = 0; i < rates.size(); ++i) rate += (slopes[i] - 1) / 3 * rates[i];
    EXPECT_NEAR(formula.rate(kAt, rates), rate, 1e-14 * (1 + std::abs(rate))) << text;
  }
}

/// The branch that is not taken and constants leave no trace, not even where they are infinite.
TEST(Expression, DerivativesOfWhatIsNotTaken) {
  for (const char* text : {"x < 0 ? sqrt(x) : x^2", "x^2 + 0*y", "abs(x)^2"}) {
    std::vector<double> slopes(2, 0.0);
    EXPECT_EQ(Expression(text, {"x", "y"}).differentiate(std::vector<double>{0, 0}, 1, slopes), 0);
    for (const double slope : slopes) EXPECT_EQ(slope, 0) << text;
    const std::vector<double> still = {0, 0}, moves = {0, 1};
    EXPECT_EQ(Expression(text, {"x", "y"}).rate(still, moves), 0) << text;
  }
}

TEST(Expression, KnowsWhatStandsInIt) {
  const std::map<std::string, double> m = {{"m", 2}};
  EXPECT_TRUE(Expression("m*sin(pi/m)", kNames, m).constant());
  EXPECT_EQ(Expression("m*y", kNames, m).used(), std::vector<size_t>{1});
  EXPECT_TRUE(Expression("0*x", kNames, m).constant()) << "an input that is zero";
  for (const char* name : {"x", "steer.angle", "theta'", "I3"})
    EXPECT_TRUE(Expression::allows(name));
  for (const char* name : {"", "1_x", "a b", "sin", "pi", "x-y", "'x"})
    EXPECT_FALSE(Expression::allows(name)) << name;
}

TEST(Expression, MistakesAreNamedWithTheirPlace) {
  struct Mistake {
    std::string text;
    const char* message;
    size_t position;
  };
  const std::vector<Mistake> mistakes = {
      {"2*mas*x", "did you mean 'mass'?", 2},
      {"x + sine(y)", "did you mean 'sin'?", 4},
      {"x + # y", "'#' has no meaning here", 4},
      {"x +", "nexpected end", 3},
      {"(x + y", "arenthes", 6},
      {"x + )", "nexpected", 4},
      {"", "mpty", 0},
      {"x, y", "expected one value", 0},
      {"x = 3", "'=' gives no value", 2},
      {"sin(x, y)", "oo many", 8},
      {"x y", "nexpected", 2},
      {"\"x\"", "Strings", 3},
      {std::string(2001, '('), "2001 characters, more than 2000", 0},
      {std::string(2000, '('), "nexpected end", 2000},
  };
  for (const auto& [text, message, position] : mistakes) {
    try {
      Expression(text, kNames, {{"mass", 2}});
      ADD_FAILURE() << text << " is accepted";
    } catch (const ExpressionError& error) {
      EXPECT_THAT(error.what(), HasSubstr(message)) << text;
      EXPECT_EQ(error.position(), position) << text << ": " << error.what();
    }
  }
}

/// As its form shows: what is neither may be, but is not known to be.
TEST(Expression, KnowsItsForm) {
  for (const char* text : {"3", "2*x - y/m + m^2", "-(x + 1)*sin(m)", "m > 1 ? x : x*y"})
    EXPECT_TRUE(Expression(text, kNames, {{"m", 2}}).linear()) << text;
  for (const char* text : {"x*y", "x^2", "x^1", "m/x", "sin(x)", "abs(x)", "x > 0 ? x : 1"})
    EXPECT_FALSE(Expression(text, kNames, {{"m", 2}}).linear()) << text;
  for (const char* text : {"x > 0 ? x : 1", "x + (y >= 1)", "sign(x)", "2*rint(x/2)", "x && 1"})
    EXPECT_TRUE(Expression(text, kNames, {{"m", 2}}).may_jump()) << text;
  for (const char* text : {"3", "x^2*abs(y)", "min(x, max(y, 0))", "m > 1 ? x : y", "sign(m)*x"})
    EXPECT_FALSE(Expression(text, kNames, {{"m", 2}}).may_jump()) << text;
}

// Variables that no formula can spell are allowed, and left out; that two are one is not.
TEST(Expression, LeavesOutNamesThatCannotStandInIt) {
  const std::vector<std::string> names = {"left arm", "3rd", "дрель", "x"};
  EXPECT_EQ(Expression("2*x", names)(std::vector<double>{0, 0, 0, 3}), 6);
  for (const auto& [text, message] : std::vector<std::pair<std::string, std::string>>{
           {"x + left arm", "'left arm' is not allowed in a formula"},
           {"2*дрель", "'дрель' is not allowed in a formula"},
           {"2*left_arm", "did you mean 'left arm'? 'left arm' is not allowed in a formula"},
           {"2*ж", "'ж' has no meaning here"}}) {
    try {
      Expression(text, names);
      ADD_FAILURE() << text << " is accepted";
    } catch (const ExpressionError& error) {
      EXPECT_THAT(error.what(), HasSubstr(message));
    }
  }
  EXPECT_THROW(Expression("x", names, {{"x", 2}}), ExpressionError);
}

}  // namespace
}  // namespace hamel
