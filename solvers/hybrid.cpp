#include <hamel/solvers/hybrid.hpp>

#include <vector>

#include <Eigen/Core>
#include <unsupported/Eigen/NonLinearOptimization>

#include <hamel/framework/loop/scaled_equation.hpp>

// The update of a QR factorisation by u v^T, R in s: MINPACK's r1updt. Where a component of the
// spike w is zero, Eigen 3.4 puts the identity into v_givens instead of w_givens, which then has no
// value there (uncoupled equations).
template <>
void Eigen::internal::r1updt<double>(MatrixXd& s, const VectorXd& u,
                                     std::vector<JacobiRotation<double>>& v_givens,
                                     std::vector<JacobiRotation<double>>& w_givens, VectorXd& v,
                                     VectorXd& w, bool* singular) {
  const Index end = s.cols() - 1;
  const auto at = [](auto& list, Index j) -> auto& { return list[static_cast<size_t>(j)]; };
  w[end] = s(end, end);
  for (Index j = end - 1; j >= 0; --j) {  // v becomes a multiple of the last unit vector
    w[j] = 0;
    JacobiRotation<double>& turn = at(v_givens, j) = JacobiRotation<double>(1, 0);
    if (v[j] == 0) continue;
    turn.makeGivens(-v[end], v[j]);
    v[end] = turn.s() * v[j] + turn.c() * v[end];
    for (Index i = j; i <= end; ++i) {
      const double kept = turn.c() * s(j, i) - turn.s() * w[i];
      w[i] = turn.s() * s(j, i) + turn.c() * w[i];
      s(j, i) = kept;
    }
  }
  w += v[end] * u;
  *singular = false;
  for (Index j = 0; j < end; ++j) {  // the spike goes
    JacobiRotation<double>& turn = at(w_givens, j) = JacobiRotation<double>(1, 0);
    if (w[j] != 0) {
      turn.makeGivens(-s(j, j), w[j]);
      for (Index i = j; i <= end; ++i) {
        const double kept = turn.c() * s(j, i) + turn.s() * w[i];
        w[i] = -turn.s() * s(j, i) + turn.c() * w[i];
        s(j, i) = kept;
      }
    }
    *singular = *singular || s(j, j) == 0;
  }
  s(end, end) = w[end];
  *singular = *singular || w[end] == 0;
}

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
