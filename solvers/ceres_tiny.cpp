#include <hamel/solvers/ceres_tiny.hpp>

#include <limits>

#include <ceres/tiny_solver.h>

#include <hamel/framework/lie/linear_solve.hpp>
#include <hamel/framework/loop/scaled_equation.hpp>

namespace hamel {
namespace {

// F with its size fixed up to 4, so that the small solves stay free of heap.
template <int N>
struct Function {
  using Scalar = double;
  enum { NUM_RESIDUALS = N, NUM_PARAMETERS = N };
  const ScaledEquation* equation = nullptr;

  int NumResiduals() const { return equation->size(); }
  int NumParameters() const { return equation->size(); }
  bool operator()(const double* x, double* f, double* jacobian) const {
    const size_t n = N == Eigen::Dynamic ? static_cast<size_t>(equation->size()) : N;
    equation->evaluate({x, n}, {f, n}, {jacobian, jacobian == nullptr ? 0 : n * n});
    return true;
  }
};

// The solver of its normal equations: one routine for all sizes, where Eigen's Cholesky costs 3 s
// of compilation each.
template <int N>
class Elimination {
 public:
  using Scalar = double;
  void compute(const Eigen::Matrix<double, N, N>& a) { a_ = a; }
  const Eigen::Matrix<double, N, 1>& solve(const Eigen::Matrix<double, N, 1>& b) {
    x_ = b;
    solve_linear(a_.data(), x_.data(), static_cast<int>(b.size()), 1);
    return x_;
  }

 private:
  Eigen::Matrix<double, N, N> a_;
  Eigen::Matrix<double, N, 1> x_;
};

template <int N>
class Tiny {
 public:
  SolveReport solve(ScaledEquation& equation, std::span<double> x) {
    const Function<N> function{&equation};
    const auto n = static_cast<Eigen::Index>(x.size());
    x_ = Eigen::Map<const Parameters>(x.data(), n);
    const double target = equation.target();
    tiny_.options.function_tolerance = tiny_.options.gradient_tolerance = 0;
    tiny_.options.parameter_tolerance = std::numeric_limits<double>::epsilon();
    tiny_.options.initial_trust_region_radius = 1e16;
    tiny_.options.cost_threshold = 0.5 * target * target;
    tiny_.options.max_num_iterations = 50;
    tiny_.Solve(function, &x_);
    // TinySolver tests its cost threshold at the guess already; a guess within it is corrected
    // once.
    const bool met = tiny_.summary.iterations == 0 && equation.residual() > 0;
    if (met) {
      tiny_.options.cost_threshold = 0;
      tiny_.options.max_num_iterations = 2;  // the first of them is the guess
      tiny_.Solve(function, &x_);
    }
    const bool ran_out = !met && tiny_.summary.status == TinySolver::HIT_MAX_ITERATIONS;
    return equation.finish(x, tiny_.summary.iterations,
                           ran_out ? Reason::max_iterations : Reason::stagnated);
  }

 private:
  using Parameters = Eigen::Matrix<double, N, 1>;
  using TinySolver = ceres::TinySolver<Function<N>, Elimination<N>>;
  TinySolver tiny_;
  Parameters x_;
};

class CeresTinySolver final : public Solver {
 public:
  SolveReport solve(const Equation& equation, std::span<double> x, double tolerance) override {
    equation_.start(equation, x, tolerance);
    switch (x.size()) {
      case 1: return one_.solve(equation_, x);
      case 2: return two_.solve(equation_, x);
      case 3: return three_.solve(equation_, x);
      case 4: return four_.solve(equation_, x);
      default: return any_.solve(equation_, x);
    }
  }
  EIGEN_MAKE_ALIGNED_OPERATOR_NEW

 private:
  ScaledEquation equation_;
  Tiny<1> one_;
  Tiny<2> two_;
  Tiny<3> three_;
  Tiny<4> four_;
  Tiny<Eigen::Dynamic> any_;
};

}  // namespace

std::shared_ptr<Solver> CeresTiny::make() { return std::make_shared<CeresTinySolver>(); }

}  // namespace hamel
