// A user's solver crosses framework/loop/solver.hpp and gives the same trajectory: one function, a
// class with a report of its own, and one that fails.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include <hamel/systems/simulate_typed.hpp>

namespace {

using namespace hamel;
using Vector = Eigen::VectorXd;

std::span<double> write(Vector& v) { return {v.data(), static_cast<size_t>(v.size())}; }

class PlainNewton final : public Solver {
 public:
  SolveReport solve(const Equation& equation, std::span<double> x, double tolerance) override {
    const int n = equation.size();
    Vector f(n);
    Eigen::MatrixXd j(n, n);
    SolveReport report;
    for (int k = 0; k < 30; ++k) {
      equation.evaluate(x, write(f), {j.data(), static_cast<size_t>(j.size())});
      report.residual = f.norm() / equation.scale();
      report.iterations = k;
      report.evaluations = k + 1;
      if (k > 0 && report.residual <= tolerance) return report;
      Eigen::Map<Vector>(x.data(), n) -= j.partialPivLu().solve(f);
    }
    report.reason = Reason::max_iterations;
    return report;
  }
};

class Hopeless final : public Solver {
 public:
  SolveReport solve(const Equation&, std::span<double>, double) override {
    return {Reason::stagnated, 0.5, 1, 1};
  }
};

Registry with_user_solvers() {
  Registry mine = registry();
  mine.add_solver("chord", "the Jacobian once",
                  [](const Equation& equation, std::span<double> x, double tolerance) {
                    const int n = equation.size();
                    Vector f(n);
                    Eigen::MatrixXd j(n, n);
                    equation.evaluate(x, write(f), {j.data(), static_cast<size_t>(j.size())});
                    for (int k = 0; k < 40 && (k == 0 || f.norm() > tolerance); ++k) {
                      Eigen::Map<Vector>(x.data(), n) -= j.partialPivLu().solve(f);
                      equation.evaluate(x, write(f), {});
                    }
                  });
  mine.add(SolverInfo{"plain", "Newton", "", [] { return std::make_shared<PlainNewton>(); }});
  mine.add(SolverInfo{"hopeless", "", "", [] { return std::make_shared<Hopeless>(); }});
  return mine;
}

TEST(UserSolver, GivesTheSameTrajectory) {
  const Registry mine = with_user_solvers();
  for (const char* system : {"suslov", "chaplygin_sleigh", "rolling_disk"}) {
    for (const std::string& scheme : mine.schemes()) {
      if (scheme == "boxed_literal") continue;  // O(1) steps: its equation has several roots
      if (mine.scheme(scheme)->explicit_step) continue;
      for (const char* retraction : {"exp", "cayley", "second_kind"}) {
        const auto run = [&](const char* solver) {
          return Simulation(mine, system)
              .scheme(scheme)
              .s(0.3)
              .retraction(retraction)
              .solver(solver)
              .step(0.02)
              .until(2)
              .run();
        };
        const Result reference = run("newton");
        for (const char* solver : {"chord", "plain"}) {
          const Result other = run(solver);
          ASSERT_TRUE(other.status.ok) << solver << " " << system << " " << scheme << ": "
                                       << other.status.reason << " " << other.status.residual;
          // 100 steps, each solve good to 1e-13 of the momentum, which the velocity multiplies by
          // the inverse of the inertia (up to 20 for the disk).
          for (size_t i = 0; i < other.last.coordinates.size(); ++i) {
            EXPECT_NEAR(other.last.coordinates[i], reference.last.coordinates[i], 1e-9)
                << solver << " " << system << " " << scheme << " " << retraction;
          }
          EXPECT_GT(other.stats.evaluations, other.steps);
        }
      }
    }
  }
}

TEST(UserSolver, ItsFailureIsTheRunsStatus) {
  const Registry mine = with_user_solvers();
  const Result r = Simulation(mine, "suslov").solver("hopeless").step(0.01).run();
  EXPECT_FALSE(r.status.ok);
  EXPECT_EQ(r.steps, 0);
  EXPECT_EQ(r.status.step, 1);
  EXPECT_EQ(r.status.residual, 0.5);
  EXPECT_EQ(r.status.reason, to_string(Reason::stagnated));
  EXPECT_EQ(r.trajectory.rows(), 1u);
}

}  // namespace
