// The analytic Jacobian of every scheme's equation, for every registered retraction, against
// differences, at points of large xi. It is read through framework/loop/solver.hpp by a user's
// solver, so that the test covers the interface too: F, dF/dx, size and scale.
#include <gtest/gtest.h>

#include <memory>

#include <Eigen/LU>

#include <hamel/framework/check/group_laws.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/groups/se3.hpp>
#include <hamel/groups/so2.hpp>
#include <hamel/groups/so3.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "bodies.hpp"

namespace {

using namespace hamel;
using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

Vector value(const Equation& equation, const Vector& x) {
  Vector f(x.size());
  equation.evaluate({x.data(), static_cast<size_t>(x.size())},
                    {f.data(), static_cast<size_t>(f.size())}, {});
  return f;
}

/// Compares the Jacobian with differences at random points, then reports the step as solved.
class Inspector final : public Solver {
 public:
  explicit Inspector(double& worst, int& points) : worst_(worst), points_(points) {}
  SolveReport solve(const Equation& equation, std::span<double> x, double) override {
    const int n = equation.size();
    EXPECT_EQ(static_cast<size_t>(n), x.size());
    EXPECT_GT(equation.scale(), 0);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 4; ++trial) {
      Vector at(n);
      for (int i = 0; i < n; ++i) at[i] = normal(random_);
      at *= 0.8;
      Vector f(n);
      Matrix j(n, n);
      equation.evaluate({at.data(), x.size()}, {f.data(), x.size()},
                        {j.data(), x.size() * x.size()});
      EXPECT_LE((f - value(equation, at)).norm(), 1e-13 * (1 + f.norm()))
          << "F differs with and without the Jacobian";
      Matrix differences(n, n);
      for (int i = 0; i < n; ++i) {
        differences.col(i) = check::derivative(
            [&](double t) -> Vector { return value(equation, at + t * Vector::Unit(n, i)); }, 2e-3);
      }
      const double error = (j - differences).norm() / (1 + j.norm());
      if (!(error <= worst_)) worst_ = error;
      ++points_;
    }
    return {};
  }

 private:
  double& worst_;
  int& points_;
  std::mt19937_64 random_{5};
};

/// Differences of order 6 with step 2e-3: round-off 2e-13, truncation (2e-3)^6/140 times the
/// seventh derivative, which for |xi| up to 2 stays below 1e5: 1e-13 to 1e-10. The Newton
/// derivative of differentiated maps is itself accurate to 1e-12. A missing term is of order |xi|.
constexpr double bound = 1e-8;

template <class S>
void expect_jacobians(const S& system) {
  using G = typename S::Group;
  for (const std::string& scheme : registry().schemes()) {
    if (registry().scheme(scheme)->explicit_step) continue;
    for (const std::string& retraction : registry().retractions(G::name())) {
      for (const double s : {0.0, 0.3, 0.5, 1.0}) {
        for (const double h : {0.05, 0.7}) {
          double worst = 0;
          int points = 0;
          Registry mine = registry();
          mine.add(SolverInfo{"inspector", "", "",
                              [&] { return std::make_shared<Inspector>(worst, points); }});
          Simulation simulation(mine, "body", OwnSystem{maker(system)});
          hamel::Run run = simulation.scheme(scheme)
                               .s(s)
                               .retraction(retraction)
                               .solver("inspector")
                               .step(h)
                               .build();
          (void)run.step();  // with the guess for the solution, perhaps outside the domain
          EXPECT_EQ(points, 4);
          EXPECT_LE(worst, bound) << G::name() << " " << scheme << " " << retraction << " s = " << s
                                  << " h = " << h;
        }
      }
    }
  }
}

TEST(Jacobians, SO3) { expect_jacobians(test::Body<SO3, 1>{}); }
TEST(Jacobians, SO3WithTwoRows) { expect_jacobians(test::Body<SO3, 2>{}); }
TEST(Jacobians, SO3Free) { expect_jacobians(test::FreeBody<SO3>{}); }
TEST(Jacobians, SE2) { expect_jacobians(test::Body<SE2, 1>{}); }
TEST(Jacobians, SE3) { expect_jacobians(test::Body<SE3, 2>{}); }
TEST(Jacobians, Product) { expect_jacobians(test::Body<Product<SE2, SO2>, 2>{}); }

}  // namespace
