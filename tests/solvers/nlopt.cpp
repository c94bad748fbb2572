// NLopt's return value is ignored: ROUNDOFF_LIMITED at the solution counts as solved, a stall does
// not.
#include <gtest/gtest.h>

#include <nlopt.h>

#include <hamel/solvers/nlopt.hpp>

#include "made.hpp"

namespace {

using namespace hamel;
using test::Made;
using test::Vector;

double nothing(unsigned n, const double*, double* gradient, void*) {
  if (gradient != nullptr) std::fill(gradient, gradient + n, 0.0);
  return 0;
}
void equations(unsigned, double* result, unsigned n, const double* x, double* gradient,
               void* data) {
  const auto& equation = *static_cast<const Made*>(data);
  test::Matrix j(n, n);
  equation.evaluate({x, n}, {result, n}, {j.data(), gradient == nullptr ? 0u : n * n});
  if (gradient != nullptr) Eigen::Map<test::Matrix>(gradient, n, n) = j.transpose();
}
double half_square(unsigned n, const double* x, double* gradient, void* data) {
  const auto& equation = *static_cast<const Made*>(data);
  const Vector at = Eigen::Map<const Vector>(x, n), f = equation.f(at);
  if (gradient != nullptr) Eigen::Map<Vector>(gradient, n) = equation.j(at).transpose() * f;
  return 0.5 * f.squaredNorm();
}

/// Called by hand without a tolerance SLSQP ends "round-off limited" or after all its evaluations,
/// and is at the solution.
TEST(Nlopt, RoundOffLimitedAtTheSolutionIsSolved) {
  Made equation = test::like_a_step(2, 0.1);
  nlopt_opt raw = nlopt_create(NLOPT_LD_SLSQP, 2);
  const double exactly[] = {0, 0};
  nlopt_set_min_objective(raw, nothing, nullptr);
  nlopt_add_equality_mconstraint(raw, 2, equations, &equation, exactly);
  nlopt_set_maxeval(raw, 1000);
  Vector x = Vector::Constant(2, 1);
  double value = 0;
  const nlopt_result word = nlopt_optimize(raw, x.data(), &value);
  nlopt_destroy(raw);
  EXPECT_TRUE(word == NLOPT_ROUNDOFF_LIMITED || word == NLOPT_MAXEVAL_REACHED)
      << nlopt_result_to_string(word);
  EXPECT_LE(equation.residual(x), 1e-14);

  equation.evaluations = 0;
  x.setConstant(1);
  const SolveReport report = kNlopt[0].make()->solve(equation, test::span_of(x), 1e-13);
  EXPECT_EQ(report.reason, Reason::converged);
  EXPECT_LE(equation.residual(x), 1e-13);
  EXPECT_LE(equation.evaluations, 20);  // stopped at the residual
}

/// On 1/2|F|^2 the gradient methods stall far above the floor; begun again where they stall, in
/// coordinates of that size, they reach it.
TEST(Nlopt, TheRestartReachesTheFloor) {
  Made equation = test::like_a_step(3, 0.3);
  for (const Nlopt& algorithm : kNlopt) {
    if (!algorithm.derivatives || std::string(algorithm.algorithm) == "LD_SLSQP") continue;
    nlopt_opt raw = nlopt_create(nlopt_algorithm_from_string(algorithm.algorithm), 3);
    nlopt_set_min_objective(raw, half_square, &equation);
    nlopt_set_maxeval(raw, 2000);
    Vector x = Vector::Constant(3, 1);
    double value = 0;
    (void)nlopt_optimize(raw, x.data(), &value);
    nlopt_destroy(raw);
    const double by_hand = equation.residual(x);
    x.setConstant(1);
    const SolveReport report = algorithm.make()->solve(equation, test::span_of(x), 1e-13);
    EXPECT_TRUE(report.ok()) << algorithm.label << ": " << to_string(report.reason) << " "
                             << report.residual;
    EXPECT_LE(equation.residual(x), 1e-13) << algorithm.label << ", by hand " << by_hand;
    if (std::string(algorithm.label) == "nlopt:lbfgs") {
      EXPECT_GT(by_hand, 1e-11);
    }
  }
}

TEST(Nlopt, EveryAlgorithmIsOneOfThisNlopt) {
  for (const Nlopt& algorithm : kNlopt) {
    EXPECT_GE(static_cast<int>(nlopt_algorithm_from_string(algorithm.algorithm)), 0)
        << algorithm.algorithm;
  }
}

}  // namespace
