// TinySolver's default tolerances are absolute: on an equation scaled by h it stops early.
#include <gtest/gtest.h>

#include <ceres/tiny_solver.h>

#include <hamel/solvers/ceres_tiny.hpp>

#include "made.hpp"

namespace {

using namespace hamel;
using test::Made;
using test::Vector;

struct Raw {
  using Scalar = double;
  enum { NUM_RESIDUALS = 2, NUM_PARAMETERS = 2 };
  const Made& equation;
  bool operator()(const double* x, double* f, double* jacobian) const {
    equation.evaluate({x, 2}, {f, 2}, {jacobian, jacobian == nullptr ? 0u : 4u});
    return true;
  }
};

TEST(CeresTiny, DefaultsStopEarlyAndOursDoNot) {
  const Made equation = test::like_a_step(2, 0.1, 1e-6);  // a small h in front of all terms
  Eigen::Vector2d raw(1, 1);
  ceres::TinySolver<Raw> tiny;
  tiny.Solve(Raw{equation}, &raw);
  EXPECT_GT(equation.residual(raw), 1e-6);  // the trap is there

  Vector x = Vector::Constant(2, 1);
  const SolveReport report = CeresTiny::make()->solve(equation, test::span_of(x), 1e-13);
  EXPECT_TRUE(report.ok());
  EXPECT_LE(equation.residual(x), 1e-13);
}

/// 1/2|F|^2 of a double root: the normal equations are singular there, and the residual left is
/// reported.
TEST(CeresTiny, ADoubleRootIsReportedAsItIs) {
  const Made equation(
      1, [](const Vector& x) { return Vector(Vector::Constant(1, (x[0] - 1) * (x[0] - 1))); },
      [](const Vector& x) { return test::Matrix(test::Matrix::Constant(1, 1, 2 * (x[0] - 1))); });
  Vector x = Vector::Constant(1, 2);
  const SolveReport report = CeresTiny::make()->solve(equation, test::span_of(x), 1e-13);
  EXPECT_EQ(report.ok(), equation.residual(x) <= 1e-13);
  EXPECT_DOUBLE_EQ(report.residual, equation.residual(x));
}

}  // namespace
