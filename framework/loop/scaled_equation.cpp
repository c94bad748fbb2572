#include <hamel/framework/loop/scaled_equation.hpp>

#include <algorithm>
#include <cmath>

namespace hamel {

ScaledEquation::ScaledEquation() = default;
ScaledEquation::~ScaledEquation() = default;

void ScaledEquation::start(const Equation& equation, std::span<const double> guess,
                           double tolerance, int patience) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  equation_ = &equation;
  size_ = equation.size();
  patience_ = patience;
  inverse_scale_ = 1 / equation.scale();
  tolerance_ = tolerance;
  target_ =
      std::min(tolerance, std::max(0.01 * tolerance, 8 * std::numeric_limits<double>::epsilon()));
  target_square_ = target_ * target_;
  guess_.assign(guess.begin(), guess.end());
  best_x_.assign(guess.begin(), guess.end());
  best_ = halved_ = infinity;
  evaluations_ = calls_ = halved_at_ = 0;
  moved_ = false;
  finite_ = true;
}

void ScaledEquation::evaluate(std::span<const double> x, std::span<double> f,
                              std::span<double> jacobian) const {
  equation_->evaluate(x, f, jacobian);
  evaluations_ += jacobian.empty() ? 1 : equation_->jacobian_cost();
  ++calls_;
  double square = 0;
  for (double& value : f) {
    value *= inverse_scale_;
    square += value * value;
  }
  for (double& value : jacobian) value *= inverse_scale_;
  finite_ = std::isfinite(square);
  if (!finite_) return;
  const bool guess = !moved_ && std::equal(x.begin(), x.end(), guess_.begin());
  moved_ = !guess;
  // A point within the target replaces a guess that was as good.
  if (square < best_ || (!guess && square <= target_square_)) {
    best_ = square;
    std::copy(x.begin(), x.end(), best_x_.begin());
  }
  if (square <= 0.25 * halved_) {
    halved_ = square;
    halved_at_ = calls_;
  }
}

bool ScaledEquation::reached() const {
  if (best_ == 0) return true;
  if (!moved_ || best_ > tolerance_ * tolerance_) return false;
  return best_ <= target_square_ || calls_ - halved_at_ >= patience_;
}

SolveReport ScaledEquation::finish(std::span<double> x, int iterations, Reason otherwise) const {
  std::copy(best_x_.begin(), best_x_.end(), x.begin());
  SolveReport report{Reason::converged, residual(), iterations, evaluations_};
  if (report.residual > std::max(tolerance_, round_off)) {
    report.reason = std::isfinite(best_) ? otherwise : Reason::not_finite;
  } else if (report.residual > tolerance_) {
    report.reason = Reason::round_off;
  }
  return report;
}

}  // namespace hamel
