#include <hamel/solvers/hybrid.hpp>

#include <Eigen/Core>
#include <unsupported/Eigen/NonLinearOptimization>

#include <hamel/framework/loop/scaled_equation.hpp>

namespace hamel {
namespace {

using Vector = Eigen::VectorXd;

std::span<double> span_of(Vector& v) { return {v.data(), static_cast<size_t>(v.size())}; }
std::span<const double> span_of(const Vector& v) {
  return {v.data(), static_cast<size_t>(v.size())};
}

// The functor that Eigen calls; a negative return value ends the solve.
struct Functor {
  const ScaledEquation& equation;
  mutable Vector f;

  int operator()(const Vector& x, Vector& value) const {
    equation.evaluate(span_of(x), span_of(value), {});
    return equation.reached() || !equation.finite() ? -1 : 0;
  }
  int df(const Vector& x, Eigen::MatrixXd& j) const {
    f.resize(x.size());
    equation.evaluate(span_of(x), span_of(f), {j.data(), static_cast<size_t>(j.size())});
    return equation.finite() ? 0 : -1;
  }
};

class HybridSolver final : public Solver {
 public:
  HybridSolver() : functor_{equation_, {}}, hybrid_(functor_) {
    hybrid_.parameters.xtol = 0;
    hybrid_.parameters.maxfev = 200;
  }
  SolveReport solve(const Equation& equation, std::span<double> x, double tolerance) override {
    equation_.start(equation, x, tolerance);
    x_ = Eigen::Map<const Vector>(x.data(), static_cast<Eigen::Index>(x.size()));
    const auto status = hybrid_.solve(x_);
    const bool ran_out = status == Eigen::HybridNonLinearSolverSpace::TooManyFunctionEvaluation;
    return equation_.finish(x, static_cast<int>(hybrid_.iter),
                            ran_out ? Reason::max_iterations : Reason::stagnated);
  }

 private:
  ScaledEquation equation_;
  Functor functor_;
  Eigen::HybridNonLinearSolver<Functor> hybrid_;
  Vector x_;
};

}  // namespace

std::shared_ptr<Solver> Hybrid::make() { return std::make_shared<HybridSolver>(); }

}  // namespace hamel
