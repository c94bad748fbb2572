#include <hamel/solvers/nlopt.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <nlopt.h>

#include <hamel/framework/loop/scaled_equation.hpp>

namespace hamel {
namespace {

class NloptSolver final : public Solver {
 public:
  NloptSolver(const char* algorithm, bool derivatives)
      : algorithm_(nlopt_algorithm_from_string(algorithm)),
        derivatives_(derivatives),
        constrained_(algorithm_ == NLOPT_LD_SLSQP),
        patience_(constrained_  ? 3
                  : derivatives ? 20
                                : 40) {}
  NloptSolver(const NloptSolver&) = delete;
  NloptSolver& operator=(const NloptSolver&) = delete;
  ~NloptSolver() override { nlopt_destroy(opt_); }

  SolveReport solve(const Equation& equation, std::span<double> x, double tolerance) override {
    prepare(x.size());
    equation_.start(equation, x, tolerance, patience_ * equation.size());
    const double slope = constrained_ ? 1 : slope_at(x);
    int iterations = 0;
    Reason otherwise = Reason::max_iterations;
    for (int leg = 0; leg < 10 && equation_.finite() && !equation_.reached(); ++leg) {
      const double before = equation_.residual();
      base_.assign(equation_.best().begin(), equation_.best().end());
      unit_ = constrained_ ? 1 : before;
      length_ = unit_ / slope;
      std::fill(z_.begin(), z_.end(), 0.0);
      const double target = equation_.target() / unit_;
      nlopt_set_stopval(opt_, constrained_ ? -1 : 0.5 * target * target);
      double value = 0;
      nlopt_optimize(opt_, z_.data(), &value);
      iterations += nlopt_get_numevals(opt_);
      if (equation_.residual() > 0.5 * before) {
        otherwise = Reason::stagnated;
        break;
      }
    }
    return equation_.finish(x, iterations, otherwise);
  }

 private:
  // The object is kept from solve to solve, as long as the size stays.
  void prepare(size_t n) {
    if (z_.size() == n) return;
    nlopt_destroy(opt_);
    opt_ = nlopt_create(algorithm_, static_cast<unsigned>(n));
    z_.resize(n);
    x_.resize(n);
    f_.resize(n);
    jacobian_.resize(derivatives_ ? n * n : 0);
    nlopt_set_min_objective(opt_, constrained_ ? nothing : half_square, this);
    if (constrained_) {
      const std::vector<double> exactly(n, 0.0);
      nlopt_add_equality_mconstraint(opt_, static_cast<unsigned>(n), equations, this,
                                     exactly.data());
    }
    nlopt_set_maxeval(opt_, constrained_ ? 60 : derivatives_ ? 200 : 1000);
    if (!constrained_) nlopt_set_xtol_abs1(opt_, derivatives_ ? 1e-14 : 1e-9);  // z is of order one
    if (!derivatives_) nlopt_set_initial_step1(opt_, 1);
  }

  // |dF|/|dx| along the diagonal at the guess: the factor from the size of x to that of F.
  double slope_at(std::span<const double> x) {
    const size_t n = x.size();
    const double root = std::sqrt(static_cast<double>(n));
    double square = 0, step = 1 / root;
    equation_.evaluate(x, f_, jacobian_);
    std::fill(z_.begin(), z_.end(), 0.0);  // the change of F
    if (derivatives_) {
      for (size_t k = 0; k < n * n; ++k) z_[k % n] += step * jacobian_[k];
    } else {
      for (const double value : x) square += value * value;
      step = 1e-6 + 1e-3 * std::sqrt(square) / root;
      for (size_t i = 0; i < n; ++i) x_[i] = x[i] + step;
      z_ = f_;
      equation_.evaluate(x_, f_, {});
      for (size_t i = 0; i < n; ++i) z_[i] = (f_[i] - z_[i]) / (step * root);
    }
    square = 0;
    for (const double change : z_) square += change * change;
    return square > 0 && std::isfinite(square) ? std::sqrt(square) : 1;
  }

  // F(x_b + sigma z)/(r scale) into f_, its Jacobian by z into jacobian_.
  void evaluate(const double* z, bool with_jacobian) {
    for (size_t i = 0; i < x_.size(); ++i) x_[i] = base_[i] + length_ * z[i];
    equation_.evaluate(x_, f_, with_jacobian ? std::span(jacobian_) : std::span<double>{});
    for (double& value : f_) value /= unit_;
    if (with_jacobian) {
      for (double& value : jacobian_) value *= length_ / unit_;
    }
    if (equation_.reached() || !equation_.finite()) nlopt_force_stop(opt_);
  }
  static double nothing(unsigned n, const double*, double* gradient, void*) {
    if (gradient != nullptr) std::fill(gradient, gradient + n, 0.0);
    return 0;
  }
  static void equations(unsigned n, double* result, unsigned, const double* z, double* gradient,
                        void* data) {
    auto& self = *static_cast<NloptSolver*>(data);
    self.evaluate(z, gradient != nullptr);
    std::copy(self.f_.begin(), self.f_.end(), result);
    if (gradient == nullptr) return;
    for (size_t i = 0; i < n; ++i) {  // by rows
      for (size_t j = 0; j < n; ++j) gradient[i * n + j] = self.jacobian_[j * n + i];
    }
  }
  static double half_square(unsigned n, const double* z, double* gradient, void* data) {
    auto& self = *static_cast<NloptSolver*>(data);
    self.evaluate(z, gradient != nullptr);
    double sum = 0;
    for (const double value : self.f_) sum += 0.5 * value * value;
    if (gradient != nullptr) {
      for (size_t j = 0; j < n; ++j) {
        gradient[j] = 0;
        for (size_t i = 0; i < n; ++i) gradient[j] += self.jacobian_[j * n + i] * self.f_[i];
      }
    }
    return sum;
  }

  nlopt_algorithm algorithm_;
  bool derivatives_, constrained_;
  int patience_;  // evaluations for each unknown
  nlopt_opt opt_ = nullptr;
  ScaledEquation equation_;
  double unit_ = 1, length_ = 1;
  std::vector<double> base_, z_, x_, f_, jacobian_;
};

}  // namespace

bool Nlopt::found() { return true; }

std::shared_ptr<Solver> Nlopt::make() const {
  return std::make_shared<NloptSolver>(algorithm, derivatives);
}

}  // namespace hamel
