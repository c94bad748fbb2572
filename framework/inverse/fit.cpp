#include <hamel/framework/inverse/fit.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <Eigen/Core>

#include <hamel/framework/inverse/bounded_number.hpp>
#include <hamel/framework/inverse/fit_covariance.hpp>
#include <hamel/framework/inverse/fit_problem.hpp>
#include <hamel/framework/io/errors.hpp>

namespace hamel {
namespace {

constexpr double kRoundOff = 1e-9;  // a sigma beside the size of its column

class FitSolver final : public FitDescent {
 public:
  FitSolver(FitProblem& problem, const FitRequest& request,
            const std::function<void(long, double)>& progress, const std::atomic<bool>* stop)
      : problem_(problem), request_(request), progress_(progress), stop_(stop) {
    for (const FitUnknown& one : problem.unknowns())
      numbers_.emplace_back(one.low, one.high, one.guess);
    begin_sigma();
    begin(request.segments);
  }

  bool linearise(FitLinear& out) override {
    if (!problem_.jacobian(now_, TangentMotion::Carries::ten_digits, out)) return false;
    residuals_ = out.r;
    last_ = out;
    weigh(out);
    if (progress_) progress_(iterations_ + 1, out.r.squaredNorm());
    for (Eigen::Index j = 0; j < u_.size(); ++j) {
      const BoundedNumber& number = numbers_[static_cast<size_t>(j)];
      const double slope = number.slope(u_[j]);
      if (number.bounded()) out.sizes[j] = 1;
      out.J.col(j) *= slope;
      if (out.C.rows() > 0) out.C.col(j) *= slope;
    }
    return true;
  }
  bool try_increment(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::VectorXd& c) override {
    if (stopped()) return false;
    next_u_ = u_ + x.head(u_.size());
    next_.x = x_of(next_u_);
    if (!next_.x.allFinite() || !problem_.move_nodes(now_, x, next_) ||
        !problem_.residuals(next_, next_residuals_, c))
      return false;
    r = next_residuals_;
    for (Eigen::Index i = 0; i < r.size(); ++i) r[i] = loss(r[i] / sigma_at(i));
    return r.allFinite();
  }
  void accept() override {
    u_ = next_u_;
    now_ = next_;
    residuals_ = next_residuals_;
  }
  Eigen::VectorXd numbers() const override { return u_; }
  double size_of_data() const override {
    double out = 0;
    for (const std::size_t column : problem_.column_of())
      out += std::pow(scale_[column] / sigma_[column], 2);
    return std::sqrt(out);
  }
  bool stopped() const override { return stop_ != nullptr && stop_->load(); }

  Fit solve() {
    Fit out;
    constexpr int rounds = 20;
    for (int n = 0; n < rounds; ++n) {
      out.converged = minimise(out.reason);
      if (!out.converged || !estimate_sigma()) break;
    }
    describe(out);
    return out;
  }

 private:
  Eigen::VectorXd x_of(const Eigen::VectorXd& u) const {
    Eigen::VectorXd out(u.size());
    for (Eigen::Index i = 0; i < u.size(); ++i) out[i] = numbers_[static_cast<size_t>(i)].x(u[i]);
    return out;
  }
  double sigma_at(Eigen::Index i) const {
    return sigma_[problem_.column_of()[static_cast<size_t>(i)]];
  }
  // sign(r) sqrt(2 rho(r)), and its derivative.
  double loss(double r) const {
    const double k = request_.huber.value_or(HUGE_VAL);
    return std::abs(r) <= k ? r : std::copysign(std::sqrt(2 * k * std::abs(r) - k * k), r);
  }
  double loss_slope(double r) const {
    const double k = request_.huber.value_or(HUGE_VAL);
    return std::abs(r) <= k ? 1 : k / std::abs(loss(r));
  }
  // At the guess.
  void begin(std::optional<int> segments) {
    u_.resize(static_cast<Eigen::Index>(numbers_.size()));
    for (Eigen::Index i = 0; i < u_.size(); ++i) {
      const auto k = static_cast<size_t>(i);
      u_[i] = numbers_[k].u(problem_.unknowns()[k].guess);
    }
    now_.x = x_of(u_);
    problem_.choose_nodes(sigma_, scale_, segments, now_);
  }
  int most_segments() const {
    std::size_t out = 0;
    for (const auto& nodes : now_.nodes) out = std::max(out, nodes.size() + 1);
    return static_cast<int>(out);
  }
  // Where displacements grow: from twice as many segments, if it does not converge soon. The growth
  // is that of the guess, which may be slower than that of the data.
  End descend_over_segments() {
    constexpr int soon = 12, row_pairs = 2;
    std::size_t rows = std::numeric_limits<int>::max();
    for (const Recording& one : request_.recordings) rows = std::min(rows, one.t.size());
    while (!request_.segments && !settled_ && most_segments() > 1) {
      const End end = descend(std::min(soon, request_.iterations));
      const int twice = 2 * most_segments();
      if (end == End::converged || end == End::stopped) return end;
      if (static_cast<std::size_t>(row_pairs * twice) > rows) break;
      begin(twice);
    }
    return descend(request_.iterations);
  }

  // Residuals in units of the data to those of the loss.
  void weigh(FitLinear& at) const {
    for (Eigen::Index i = 0; i < at.r.size(); ++i) {
      const double r = at.r[i] / sigma_at(i);
      at.J.row(i) *= loss_slope(r) / sigma_at(i);
      at.r[i] = loss(r);
    }
  }

  // Where none is given: at first the root of the mean square of the column.
  void begin_sigma() {
    const size_t columns = problem_.columns().size();
    sigma_.assign(columns, 1);
    scale_.assign(columns, 0);
    std::vector<double> count(columns, 0);
    for (const Recording& recording : request_.recordings) {
      for (size_t c = 0; c < recording.columns.size(); ++c) {
        const auto at = std::ranges::find(problem_.columns(), recording.columns[c]);
        if (at == problem_.columns().end()) continue;
        const auto k = static_cast<size_t>(at - problem_.columns().begin());
        for (const double x : recording.values[c]) {
          if (!std::isfinite(x)) continue;
          scale_[k] += x * x;
          ++count[k];
        }
      }
    }
    for (size_t k = 0; k < columns; ++k) {
      scale_[k] = scale_[k] > 0 ? std::sqrt(scale_[k] / count[k]) : 1;
      const auto given = request_.sigma.find(problem_.columns()[k]);
      given_.push_back(given != request_.sigma.end());
      sigma_[k] = given_[k] ? given->second : scale_[k];
    }
  }
  // False where they have settled. Huber: from the median of |r|.
  bool estimate_sigma() {
    bool moved = false;
    const double n = static_cast<double>(problem_.data()),
                 free = std::max(1.0, n - static_cast<double>(u_.size()));
    for (size_t k = 0; k < sigma_.size(); ++k) {
      if (given_[k]) continue;
      std::vector<double> off;
      for (Eigen::Index i = 0; i < residuals_.size(); ++i)
        if (problem_.column_of()[static_cast<size_t>(i)] == k)
          off.push_back(std::abs(residuals_[i]));
      double next = 0;
      if (request_.huber) {
        constexpr double normal = 1.4826;  // of a normal distribution
        const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
        std::nth_element(off.begin(), middle, off.end());
        next = normal * *middle;
      } else {
        for (const double x : off) next += x * x;
        next = std::sqrt(next / static_cast<double>(off.size()) * n / free);
      }
      next = std::max(next, kRoundOff * scale_[k]);
      moved = moved || std::abs(next - sigma_[k]) > 1e-5 * sigma_[k];
      sigma_[k] = next;
    }
    return moved;
  }

  bool minimise(std::string& reason) {
    const End end = descend_over_segments();
    settled_ = end == End::converged;
    switch (end) {
      case End::converged: return true;
      case End::stopped: reason = "interrupted"; break;
      case End::no_derivative:
        reason = (iterations_ == 0 ? "no motion from the guess: " : "no derivative there: ") +
                 problem_.failure();
        break;
      case End::too_many:
        reason = fmt::format("not converged in {} iterations", iterations_);
        break;
      case End::no_descent: reason = "no step along the derivatives lessens chi2"; break;
    }
    return false;
  }

  void describe(Fit& out) {
    const Eigen::VectorXd& x = now_.x;
    const Eigen::Index q = x.size();
    out.iterations = iterations_;
    out.dof = static_cast<long>(problem_.data() - q);
    for (Eigen::Index i = 0; i < residuals_.size(); ++i)
      out.chi2 += std::pow(loss(residuals_[i] / sigma_at(i)), 2);
    for (size_t k = 0; k < sigma_.size(); ++k) out.sigma[problem_.columns()[k]] = sigma_[k];
    for (Eigen::Index i = 0; i < q; ++i) {
      const FitUnknown& one = problem_.unknowns()[static_cast<size_t>(i)];
      const double near = 1e-6 * (one.high - one.low);
      out.parameters.push_back(
          {one.name, problem_.variables().all()[one.variable].unit, x[i], one.guess, HUGE_VAL,
           std::isfinite(near) && (x[i] < one.low + near || x[i] > one.high - near)});
    }
    out.covariance = NumberMatrix(static_cast<int>(q), static_cast<int>(q));
    out.covariance.values.assign(static_cast<size_t>(q * q),
                                 std::numeric_limits<double>::quiet_NaN());
    if (residuals_.size() == problem_.data()) out.residuals = problem_.tables(residuals_, sigma_);
    for (const auto& nodes : now_.nodes) out.segments.push_back(static_cast<int>(nodes.size()) + 1);
    if (!out.converged) return;
    // That of the last iteration, whose increment is nothing beside a deviation.
    last_.r = residuals_;
    weigh(last_);
    if (sees_clearly(last_, x)) return estimate_covariance(last_, x, out);
    if (!problem_.jacobian(now_, TangentMotion::Carries::columns, last_)) return;
    weigh(last_);
    estimate_covariance(last_, x, out);
  }

  FitProblem& problem_;
  const FitRequest& request_;
  const std::function<void(long, double)>& progress_;
  const std::atomic<bool>* stop_;
  std::vector<BoundedNumber> numbers_;
  Eigen::VectorXd u_, next_u_, residuals_, next_residuals_;
  FitPoint now_, next_;
  FitLinear last_;  // at the point of the last iteration, by the numbers themselves
  std::vector<double> sigma_, scale_;
  std::vector<bool> given_;
  bool settled_ = false;  // nodes stay
};

// The run with the fitted numbers, its start in full.
Config fitted_run(const FitProblem& problem, const Eigen::VectorXd& x) {
  const Eigen::VectorXd values = problem.values_of(x, 0);
  const Simulation fitted = problem.variables().with(values);
  Config out = fitted.config();
  const bool starts = std::ranges::any_of(problem.variables().all(),
                                          [](const MotionVariable& v) { return !v.of_system(); });
  if (!starts) return out;
  Run run = fitted.build();
  out.start = problem.variables().start_of(run, values);
  out.start.momentum.clear();
  out.speed.reset();
  out.start_values.clear();
  return out;
}

}  // namespace

FitName parse_fit_name(const std::string& text) {
  const size_t equal = text.find('=');
  FitName out{text.substr(0, equal)};
  const auto refuse = [&] {
    throw ConfigError({fmt::format(
        "fit: got '{}', expected NAME, NAME=guess or NAME=guess:low:high", shortened(text))});
  };
  if (out.name.empty()) refuse();
  if (equal == std::string::npos) return out;
  std::vector<double> numbers;
  std::string rest = text.substr(equal + 1);
  for (size_t at = 0; at != std::string::npos;) {
    at = rest.find(':');
    double number = 0;
    read_text("fit: " + out.name, rest.substr(0, at), number);
    numbers.push_back(number);
    if (at != std::string::npos) rest = rest.substr(at + 1);
  }
  if (numbers.size() != 1 && numbers.size() != 3) refuse();
  out.guess = numbers[0];
  if (numbers.size() == 3) {
    out.low = numbers[1];
    out.high = numbers[2];
  }
  return out;
}

Fit fit(const Simulation& simulation, const FitRequest& request,
        const std::function<void(long, double)>& progress, const std::atomic<bool>* stop) {
  const auto begin = std::chrono::steady_clock::now();
  if (!simulation.config().stop_at.empty())
    throw ConfigError({"fit: a stop has no place beside recordings: leave stop_at out"});
  FitProblem problem(simulation, request);
  {  // what no fit can begin with is a mistake
    Eigen::VectorXd guess(static_cast<Eigen::Index>(problem.unknowns().size()));
    for (Eigen::Index i = 0; i < guess.size(); ++i)
      guess[i] = problem.unknowns()[static_cast<size_t>(i)].guess;
    for (size_t r = 0; r < request.recordings.size(); ++r)
      TangentMotion("fit", problem.variables(), problem.values_of(guess, static_cast<int>(r)),
                    TangentMotion::Carries::values);
  }
  FitSolver solver(problem, request, progress, stop);
  Fit out = solver.solve();
  out.runs = problem.runs();
  if (!problem.left_out().empty())
    out.notes.push_back(
        fmt::format("no quantities of the motion, left out: {}", join(problem.left_out())));
  Eigen::VectorXd x(static_cast<Eigen::Index>(out.parameters.size()));
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = out.parameters[static_cast<size_t>(i)].value;
  if (out.converged) out.run = fitted_run(problem, x);
  if (out.converged && !out.undetermined.empty())
    out.reason = "the data do not determine all numbers";
  for (const FittedNumber& one : out.parameters)
    if (one.at_bound)
      out.notes.push_back(
          fmt::format("{} is at its bound: its sigma is that of the fit without "
                      "bounds",
                      one.name));
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

}  // namespace hamel
