#include <hamel/framework/inverse/fit_descent.hpp>

#include <algorithm>
#include <cmath>

namespace hamel {
namespace {

constexpr double kLeastDamping = 1e-13, kMostDamping = 1e10;
constexpr double kSettled = 1e-13;       // an increment, of the scaled size of the point
constexpr double kExpectedFall = 1e-12;  // a fall that is expected, of the merit
constexpr double kSmall = 1e-9;          // an increment that does not lessen the merit
constexpr double kNoFall = 1e-9;         // one that is not found
constexpr double kSameGap = 1e-9;        // equations that hold: a change of the data, beside them
constexpr double kRankOfRows = 1e-9;     // equations that depend on each other

}  // namespace

Eigen::VectorXd scales_of_columns(const FitLinear& at) {
  Eigen::VectorXd out = at.J.colwise().norm().transpose().cwiseProduct(at.sizes);
  const double longest = out.size() == 0 ? 0 : out.maxCoeff();
  for (double& one : out)
    if (!(one > 1e-12 * longest)) one = longest > 0 ? longest : 1;
  return out.cwiseQuotient(at.sizes);
}

FitStep::FitStep(const FitLinear& at, const Eigen::VectorXd& scales) : at_(at), scales_(scales) {
  scaled_ = at.J * scales.cwiseInverse().asDiagonal();
  particular_.setZero(scales.size());
  if (at.C.rows() == 0) {
    directions_ = scaled_;
  } else {
    Eigen::MatrixXd rows = at.C * scales.cwiseInverse().asDiagonal();
    rows_ = rows.rowwise().norm();
    for (double& one : rows_) one = one > 0 ? 1 / one : 1;
    rows = rows_.asDiagonal() * rows;
    factors_.setThreshold(kRankOfRows);
    factors_.compute(rows.transpose());
    const Eigen::Index rank = factors_.rank(), all = scales.size();
    // R^T Q^T x = P^T (-c) of the rows that are independent.
    const Eigen::VectorXd right =
        factors_.colsPermutation().transpose() * (-rows_.cwiseProduct(at.c));
    Eigen::VectorXd z = Eigen::VectorXd::Zero(all);
    z.head(rank) = factors_.matrixR()
                       .topLeftCorner(rank, rank)
                       .triangularView<Eigen::Upper>()
                       .transpose()
                       .solve(right.head(rank));
    particular_ = factors_.householderQ() * z;
    null_.setZero(all, all - rank);
    null_.bottomRows(all - rank).setIdentity();
    null_.applyOnTheLeft(factors_.householderQ());
    directions_ = scaled_ * null_;
  }
  pulled_ = at.r + scaled_ * particular_;
  const Eigen::HouseholderQR<Eigen::MatrixXd> triangle(directions_);
  const Eigen::Index count = std::min(directions_.rows(), directions_.cols());
  const Eigen::MatrixXd upper = triangle.matrixQR().topRows(count).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(upper, Eigen::ComputeThinU | Eigen::ComputeThinV);
  singular_ = svd.singularValues();
  directions_ = svd.matrixV();
  Eigen::VectorXd turned = pulled_;
  turned.applyOnTheLeft(triangle.householderQ().adjoint());
  pulled_ = svd.matrixU().transpose() * turned.head(count);
}

double FitStep::solve(double damping, Eigen::VectorXd& x) const {
  const double least = std::max(damping, kLeastDamping) * largest_singular() * largest_singular();
  Eigen::VectorXd y(singular_.size());
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const double s = singular_[i];
    y[i] = s > 0 ? -s * pulled_[i] / (s * s + least) : 0;
  }
  y = directions_ * y;
  Eigen::VectorXd moved = particular_;
  if (at_.C.rows() > 0) moved += null_ * y;
  else moved = y;
  x = moved.cwiseQuotient(scales_);
  return 0.5 * (at_.r + scaled_ * moved).squaredNorm();
}

// C^T mu = -J^T (r + J x).
double FitStep::largest_multiplier(const Eigen::VectorXd& x) const {
  if (at_.C.rows() == 0) return 0;
  const Eigen::VectorXd slope = -scaled_.transpose() * (at_.r + at_.J * x);
  const Eigen::VectorXd mu = factors_.solve(slope);
  return mu.lpNorm<Eigen::Infinity>();
}

double FitStep::infeasible(const Eigen::VectorXd& c) const {
  return rows_.size() == 0 ? 0 : rows_.cwiseProduct(c).lpNorm<1>();
}

double FitStep::largest_gap(const Eigen::VectorXd& c) const {
  return rows_.size() == 0 ? 0 : rows_.cwiseProduct(c).lpNorm<Eigen::Infinity>();
}

Eigen::MatrixXd FitStep::directions() const {
  const Eigen::MatrixXd all =
      at_.C.rows() == 0 ? directions_ : Eigen::MatrixXd(null_ * directions_);
  return scales_.cwiseInverse().asDiagonal() * all;
}

// Beside the numbers, as their columns scale them.
bool FitDescent::is_small(const FitLinear& at, const Eigen::VectorXd& x) const {
  const Eigen::VectorXd p = numbers();
  const Eigen::VectorXd scales = scales_of_columns(at).head(p.size());
  const double size = scales.cwiseProduct(p).norm();
  return p.size() > 0 && scales.cwiseProduct(x.head(p.size())).norm() <= kSmall * size;
}

// Takes an increment by its fall and the one that was foreseen, and damps the next accordingly.
bool FitDescent::takes(double actual, double fall) {
  if (!(actual > 1e-4 * fall && actual > 0)) return false;
  if (actual > 0.75 * fall) damping_ = std::max(damping_ * 0.1, kLeastDamping);
  if (actual < 0.25 * fall) damping_ *= 4;
  return true;
}

// settled: no nearer point is expected within round-off.
bool FitDescent::search(const FitStep& step, const FitLinear& at, bool& settled) {
  const double cost = 0.5 * at.r.squaredNorm(), gap = step.infeasible(at.c);
  const bool same = step.largest_gap(at.c) <= kSameGap * size_of_data();
  constexpr int tries = 40;
  double length = 1, first_fall = 0;
  bool small = false;
  Eigen::VectorXd x, r, c;
  for (int n = 0; n < tries; ++n) {
    double expected = step.solve(damping_, x);
    if (n == 0) penalty_ = std::max(penalty_, 2 * step.largest_multiplier(x));
    if (length < 1) {
      x *= length;
      expected = 0.5 * (at.r + at.J * x).squaredNorm();
    }
    const double merit = cost + penalty_ * gap;
    const double fall = merit - expected - penalty_ * (1 - length) * gap;
    if (n == 0) first_fall = fall;
    if (n == 0) small = is_small(at, x);
    settled = cost - expected <= kExpectedFall * merit && same;
    const double size = (scales_of_columns(at).cwiseProduct(x)).norm();
    if (try_increment(x, r, c) &&
        takes(merit - 0.5 * r.squaredNorm() - penalty_ * step.infeasible(c), fall))
      return true;
    // Merits beside each other differ by their round-off and by that of the derivatives.
    if ((small || first_fall < kNoFall * merit) && same) settled = true;
    if (settled || size <= kSettled) return false;
    damping_ = std::min(std::max(damping_, 1e-6) * 8, kMostDamping);
    if (at.C.rows() > 0 && n >= 2) length *= 0.5;
  }
  return false;
}

FitDescent::End FitDescent::descend(int iterations) {
  penalty_ = 0;
  damping_ = std::min(damping_, 1e-6);
  FitLinear at;
  Eigen::VectorXd longest;
  for (int n = 0; n < iterations; ++n) {
    if (stopped()) return End::stopped;
    if (!linearise(at)) return stopped() ? End::stopped : End::no_derivative;
    ++iterations_;
    const Eigen::VectorXd now = scales_of_columns(at);
    if (longest.size() != now.size()) longest = now;
    longest = longest.cwiseMax(now);
    const FitStep step(at, longest);
    bool settled = false;
    const bool moved = search(step, at, settled);
    if (moved) accept();
    if (settled) return End::converged;
    if (!moved) return stopped() ? End::stopped : End::no_descent;
  }
  return End::too_many;
}

}  // namespace hamel
