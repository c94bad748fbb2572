// Random linear-quadratic problems over stages against one dense system of their conditions of
// first order.
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <hamel/framework/stages/stage_solver.hpp>

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// z+ = F z + B u + d, cost 1/2 x^T H x + g.x over x = (z, u); sizes differ from stage to stage.
struct LinearProblem : hamel::StageProblem {
  struct Stage {
    MatrixXd F, B, H;
    VectorXd d, g;
  };
  std::vector<Stage> all;
  MatrixXd C, J;
  VectorXd target;

  LinearProblem(int count, int free_start, unsigned seed) : random(seed) {
    std::vector<int> states, inputs;
    for (int k = 0; k <= count; ++k) {
      states.push_back(2 + static_cast<int>(random() % 3));
      inputs.push_back(k == count ? 0 : 1 + static_cast<int>(random() % 2));
    }
    for (int k = 0; k <= count; ++k) {
      const int n = states[size_t(k)], m = inputs[size_t(k)];
      const int next = k == count ? 0 : states[size_t(k + 1)];
      const MatrixXd root = draw(n + m, n + m);
      MatrixXd H = root * root.transpose();
      H += MatrixXd::Identity(n + m, n + m);
      all.push_back({draw(next, n), draw(next, m), H, draw(next, 1), draw(n + m, 1)});
    }
    C = draw(1, states.back());
    target = draw(1, 1);
    J = draw(states.front(), free_start);
  }
  MatrixXd draw(int rows, int columns) {
    std::normal_distribution<double> normal;
    MatrixXd out(rows, columns);
    for (double& x : out.reshaped()) x = normal(random);
    return out;
  }
  int stages() const override { return static_cast<int>(all.size()) - 1; }
  hamel::StageSizes sizes(int k) const override {
    const Stage& s = all[size_t(k)];
    return {static_cast<int>(s.F.cols()), static_cast<int>(s.B.cols()), 0};
  }
  bool values(int k, const VectorXd& z, const VectorXd& u, const VectorXd* next,
              hamel::StageValues& out) override {
    const Stage& s = all[size_t(k)];
    VectorXd x(z.size() + u.size());
    x << z, u;
    out.cost = 0.5 * x.dot(s.H * x) + s.g.dot(x);
    if (next != nullptr) out.defect = s.F * z + s.B * u + s.d - *next;
    return true;
  }
  bool derivatives(int k, const VectorXd& z, const VectorXd& u, const VectorXd*, const VectorXd&,
                   const VectorXd&, hamel::StageDerivatives& out) override {
    const Stage& s = all[size_t(k)];
    VectorXd x(z.size() + u.size());
    x << z, u;
    out.F = s.F;
    out.B = s.B;
    out.hessian = s.H;
    out.cost_gradient = s.H * x + s.g;
    return true;
  }
  int goals() const override { return 1; }
  void goal(const VectorXd& last, VectorXd& value) override { value = C * last - target; }
  void goal_derivatives(const VectorXd&, const VectorXd&, MatrixXd& jacobian, MatrixXd&) override {
    jacobian = C;
  }
  MatrixXd start_directions() const override { return J; }
  std::mt19937 random;
};

// All unknowns in one system: x = (w, u_0, z_1, u_1, ... z_N), multipliers of dynamics and goal.
struct Dense {
  VectorXd x, multipliers;
  MatrixXd matrix;
  Dense(const LinearProblem& p, const VectorXd& start) {
    const int count = p.stages();
    std::vector<int> at_z, at_u;
    int size = static_cast<int>(p.J.cols()), rows = 1;
    for (int k = 0; k <= count; ++k) {
      at_z.push_back(k == 0 ? 0 : size);
      if (k > 0) size += p.sizes(k).state, rows += p.sizes(k).state;
      at_u.push_back(size);
      size += p.sizes(k).inputs;
    }
    MatrixXd H = MatrixXd::Zero(size, size), A = MatrixXd::Zero(rows, size);
    VectorXd g = VectorXd::Zero(size), b = VectorXd::Zero(rows);
    int row = 0;
    for (int k = 0; k <= count; ++k) {
      const auto& s = p.all[size_t(k)];
      const int n = p.sizes(k).state, m = p.sizes(k).inputs;
      MatrixXd T = MatrixXd::Zero(n + m, size);  // (z, u) = T x + c
      VectorXd c = VectorXd::Zero(n + m);
      if (k == 0) T.topLeftCorner(n, p.J.cols()) = p.J, c.head(n) = start;
      else T.block(0, at_z[size_t(k)], n, n).setIdentity();
      T.block(n, at_u[size_t(k)], m, m).setIdentity();
      H += T.transpose() * s.H * T;
      g += T.transpose() * (s.H * c + s.g);
      if (k == count) {
        A.row(row) = p.C * T;
        b.segment(row, 1) = p.target - p.C * c;
        continue;
      }
      const int next = p.sizes(k + 1).state;
      MatrixXd FB(next, n + m);
      FB << s.F, s.B;
      A.middleRows(row, next) = FB * T;
      A.block(row, at_z[size_t(k + 1)], next, next) -= MatrixXd::Identity(next, next);
      b.segment(row, next) = -(s.d + FB * c);
      row += next;
    }
    matrix.setZero(size + rows, size + rows);
    matrix.topLeftCorner(size, size) = H;
    matrix.topRightCorner(size, rows) = A.transpose();
    matrix.bottomLeftCorner(rows, size) = A;
    VectorXd right(size + rows);
    right << -g, b;
    const VectorXd all = matrix.fullPivLu().solve(right);
    x = all.head(size);
    multipliers = all.tail(rows);
  }
};

TEST(LinearStages, TheSweepSolvesTheDenseConditions) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const int free_start = static_cast<int>(seed % 3);
    LinearProblem problem(6, free_start, seed);
    const VectorXd start = problem.draw(problem.sizes(0).state, 1);
    hamel::StagePoint guess;
    for (int k = 0; k <= 6; ++k) {
      guess.states.push_back(k == 0 ? start : VectorXd(problem.draw(problem.sizes(k).state, 1)));
      guess.inputs.push_back(problem.draw(problem.sizes(k).inputs, 1));
    }
    const hamel::StageSolution out = hamel::solve_stages(problem, guess);
    ASSERT_EQ(out.status, hamel::StageStatus::ok) << out.reason;
    EXPECT_LE(out.iterations, 3) << seed;  // linear: one, and the proximal term of the goal
    const Dense dense(problem, start);
    Eigen::Index at = free_start, row = 0;
    EXPECT_LT((out.point.states[0] - start - problem.J * dense.x.head(free_start)).norm(), 1e-8);
    for (int k = 0; k <= 6; ++k) {
      const VectorXd& z = out.point.states[size_t(k)];
      const VectorXd& u = out.point.inputs[size_t(k)];
      if (k > 0) {
        EXPECT_LT((z - dense.x.segment(at, z.size())).norm(), 1e-8) << seed << " " << k;
        EXPECT_LT((out.multipliers[size_t(k)] - dense.multipliers.segment(row, z.size())).norm(),
                  1e-6 * (1 + dense.multipliers.norm()))
            << seed << " " << k;
        at += z.size();
        row += z.size();
      }
      EXPECT_LT((u - dense.x.segment(at, u.size())).norm(), 1e-8) << seed << " " << k;
      at += u.size();
    }
    EXPECT_NEAR(out.goal_multipliers[0], dense.multipliers[row],
                1e-6 * (1 + dense.multipliers.norm()));
  }
}

// Without a goal, P_0 along the free directions is the Schur complement of all other unknowns: the
// inverse of the block of w in the inverse of the conditions.
TEST(LinearStages, TheInformationOfTheStartIsTheSchurComplement) {
  struct Free : LinearProblem {
    using LinearProblem::LinearProblem;
    int goals() const override { return 0; }
  };
  for (unsigned seed = 0; seed < 5; ++seed) {
    Free problem(5, 2, seed);
    problem.C.setZero();
    const VectorXd start = problem.draw(problem.sizes(0).state, 1);
    hamel::StagePoint guess;
    for (int k = 0; k <= 5; ++k) {
      guess.states.push_back(k == 0 ? start : VectorXd::Zero(problem.sizes(k).state));
      guess.inputs.push_back(VectorXd::Zero(problem.sizes(k).inputs));
    }
    const hamel::StageSolution out = hamel::solve_stages(problem, guess);
    ASSERT_EQ(out.status, hamel::StageStatus::ok) << out.reason;
    const Dense dense(problem, start);
    const Eigen::Index size = dense.matrix.rows() - 1;  // without the row of the goal
    const MatrixXd inverse = dense.matrix.topLeftCorner(size, size).inverse();
    const MatrixXd information = inverse.topLeftCorner(2, 2).inverse();
    EXPECT_LT((out.start_information - information).norm(), 1e-8 * information.norm()) << seed;
  }
}

}  // namespace
