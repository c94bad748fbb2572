#include <hamel/framework/analysis/steady_bifurcation.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <hamel/framework/analysis/central_differences.hpp>
#include <hamel/framework/lie/decompositions.hpp>

namespace hamel::reduced {
namespace {

constexpr double kRank = 1e-8;  // of the equations without the singular direction
// Differences along v, in own units, in which F is smooth over about 1.
const StepRange kSteps = steps_of_scale(1);

// The combination of the columns of `all` that has least in common with spaces, orthonormal
// columns.
Vector least_in(const Matrix& all, const std::vector<Matrix>& spaces) {
  Matrix common = Matrix::Zero(all.cols(), all.cols());
  for (const Matrix& space : spaces) {
    const Matrix part = space.transpose() * all;
    common += part.transpose() * part;
  }
  return dense::symmetric_eigen(common).vectors.col(0);
}

// Weights by which values at x give the polynomial through them at x0.
Vector weights_at(double x0, const std::vector<double>& x) {
  Vector out = Vector::Ones(std::ssize(x));
  for (size_t i = 0; i < x.size(); ++i)
    for (size_t j = 0; j < x.size(); ++j)
      if (j != i) out[static_cast<Eigen::Index>(i)] *= (x0 - x[j]) / (x[i] - x[j]);
  return out;
}

}  // namespace

struct BifurcationEquation::Scaled {
  Matrix slope;     // rows dF columns
  Vector carriers;  // sizes of the columns of the carriers
  dense::Svd svd;
  Eigen::Index small;  // how many singular values are zero to their round-off

  double value(Eigen::Index i) const {  // least first
    const Eigen::Index k = slope.cols() - 1 - i;
    return k < svd.values.size() ? svd.values[k] : 0;
  }
};

BifurcationEquation::Scaled BifurcationEquation::scaled(const BranchNode& node) const {
  const auto equations = branch_.equations(node.value);
  Scaled out;
  out.slope = equations->slope(node.point, branch_.held());
  const StateUnits& scales = branch_.scales();
  const Eigen::Index z = scales.columns.size();
  out.slope = (scales.rows.head(out.slope.rows()).asDiagonal() * out.slope).eval();
  out.slope.leftCols(z) *= scales.columns.asDiagonal();
  out.carriers = out.slope.rightCols(out.slope.cols() - z).colwise().norm().transpose();
  for (Eigen::Index i = 0; i < out.carriers.size(); ++i)
    if (out.carriers[i] > 0) out.slope.col(z + i) /= out.carriers[i];
  out.svd = dense::svd(out.slope, Eigen::ComputeFullU | Eigen::ComputeFullV);
  out.small = out.slope.cols() -
              (out.svd.values.array() > kNull * std::max(1e-300, out.svd.values[0])).count();
  return out;
}

BifurcationEquation::BifurcationEquation(Branch& branch, const BranchNode& at,
                                         const std::vector<BranchNode>& around)
    : branch_(branch), at_(at) {
  find_vectors(around);
}

void BifurcationEquation::find_vectors(const std::vector<BranchNode>& around) {
  const Scaled here = scaled(at_);
  const Eigen::Index z = branch_.scales().columns.size(), rows = here.slope.rows(),
                     columns = here.slope.cols();
  std::vector<Scaled> others;
  Eigen::Index known = columns;  // singular there, too
  for (const BranchNode& node : around) {
    others.push_back(scaled(node));
    known = std::min(known, others.back().small);
  }
  kernel_ = 0;
  for (Eigen::Index i = known; i < columns; ++i) {
    double beside = std::numeric_limits<double>::infinity();
    for (const Scaled& other : others) beside = std::min(beside, other.value(i));
    const double part = here.value(i) / std::max(1e-300, beside);
    if (part > 0.3) break;
    if (part > 1e-3) kernel_ = -1;
    if (kernel_ < 0) return;
    ++kernel_;
  }
  if (kernel_ != 1) return;
  std::vector<Matrix> right, left;
  const Eigen::Index rank = columns - known;
  for (const Scaled& other : others) {
    right.push_back(range_of(other.svd.v.topRightCorner(z, known), 1e-9, 1));
    left.push_back(other.svd.u.rightCols(rows - rank));
  }
  const Matrix kernel = here.svd.v.rightCols(known + 1),
               dual = here.svd.u.rightCols(rows - rank + 1);
  v_scaled_ = kernel * least_in(kernel.topRows(z), right);
  v_scaled_ /= std::max(1e-300, v_scaled_.head(z).norm());
  w_ = dual * least_in(dual, left);
  slope_ = here.slope;
  carriers_ = branch_.equations(at_.value)->carriers(at_.point);
  for (Eigen::Index i = 0; i < carriers_.cols(); ++i)
    if (here.carriers[i] > 0) carriers_.col(i) /= here.carriers[i];
  v_ = vector_of(v_scaled_);
}

// The least-norm solution across v of the equations without that of w.
Vector BifurcationEquation::solve(const Vector& right) const {
  Matrix whole(slope_.rows() + 1, slope_.cols());
  whole << slope_, v_scaled_.transpose();
  Vector both(right.size() + 1);
  both << right - w_ * w_.dot(right), 0;
  return dense::least_norm(whole, both, kRank);
}

KernelVector BifurcationEquation::vector_of(const Vector& scaled) const {
  const Vector& columns = branch_.scales().columns;
  return {columns.cwiseProduct(scaled.head(columns.size())),
          carriers_ * scaled.tail(carriers_.cols())};
}

Vector BifurcationEquation::values(const BranchNode& node, double s, double second) const {
  Vector step = s * v_.step, carrier = s * v_.carrier;
  if (second != 0) {
    step += second * second_.step;
    carrier += second * second_.carrier;
  }
  const Vector out =
      branch_.equations(node.value)->displaced(node.point, branch_.held(), step, carrier);
  return branch_.scales().rows.head(out.size()).cwiseProduct(out);
}

double BifurcationEquation::place_of(const BranchNode& node) const {
  const auto equations = branch_.equations(at_.value);
  const int n = equations->dim();
  const Vector apart = equations->flow().difference(at_.point.g, node.point.g);
  Vector step(2 * n);
  step << apart, node.point.xi - at_.point.xi;
  return v_scaled_.head(2 * n).dot(step.cwiseQuotient(branch_.scales().columns));
}

void BifurcationEquation::centre(const std::vector<std::vector<BranchNode>>& sets,
                                 double value_error) {
  double best = std::numeric_limits<double>::infinity(), place = 0, last = 0;
  for (size_t k = 0; k < sets.size(); ++k) {
    std::vector<double> x;
    for (const BranchNode& node : sets[k]) x.push_back(node.value);
    const Vector weights = weights_at(at_.value, x);
    double sum = 0;
    for (size_t i = 0; i < x.size(); ++i)
      sum += weights[static_cast<Eigen::Index>(i)] * place_of(sets[k][i]);
    if (k > 0 && std::abs(sum - last) < best) {
      best = std::abs(sum - last);
      place = sum;
    }
    last = sum;
  }
  place_error_ = best;
  value_error_ = value_error;
  const auto equations = branch_.equations(at_.value);
  const int n = equations->dim();
  const auto move = [&](const KernelVector& by, double s) {
    at_.point = equations->at(equations->flow().moved(at_.point.g, s * by.step.head(n)),
                              at_.point.xi + s * by.step.tail(n));
  };
  move(v_, place);
  for (int k = 0; k < 5; ++k) move(vector_of(solve(values(at_, 0, 0))), -1);
  find_vectors(sets.front());
  if (kernel_ == 1) place_error_ += kNoise / std::abs(slope_at(sets.front()[1]));
}

void BifurcationEquation::expand(const BranchNode& beside) {
  const auto along = [&](const BranchNode& node, bool curved) {
    return CentralDifferences(
        [this, &node, curved](double s) {
          return Vector(Vector::Constant(1, w_.dot(values(node, s, curved ? s * s / 2 : 0))));
        },
        kSteps);
  };
  const auto estimate = [](const Derivative& d) { return Estimate{d.value[0], d.error[0]}; };
  second_ = {};
  CentralDifferences whole([this](double s) { return values(at_, s, 0); }, kSteps);
  const Derivative curvature = whole.derivative(2);
  const Vector second = solve(-curvature.value);
  CentralDifferences straight = along(at_, false);
  const Estimate third = estimate(straight.derivative(3));
  const Estimate there = estimate(along(beside, false).derivative(2));
  second_ = vector_of(second);
  CentralDifferences curved = along(at_, true);
  const Derivative two = curved.derivative(2), three = curved.derivative(3);
  quadratic_ = estimate(two);
  cubic_ = estimate(three);
  reach_ = std::min(two.reach[0] > 0 ? two.reach[0] : three.reach[0], three.reach[0]);
  const double size = curvature.value.norm();
  if (size > 0)
    cubic_.error += std::abs(cubic_.value - third.value) * curvature.error.norm() / size;
  quadratic_.error += std::abs(w_.dot(slope_ * second)) + std::abs(cubic_.value) * place_error_;
  const double run = std::abs(beside.value - at_.value);
  if (run > 0)
    quadratic_.error +=
        value_error_ / run * (std::abs(there.value - quadratic_.value) + there.error);
}

bool BifurcationEquation::quadratic_is_covered() const {
  return quadratic_.is_zero() &&
         quadratic_.error < 1e-3 * std::abs(cubic_.value) * std::max(reach_, 1.0) / 3;
}

double BifurcationEquation::slope_at(const BranchNode& node) const {
  CentralDifferences along(
      [&](double s) { return Vector(Vector::Constant(1, w_.dot(values(node, s, 0)))); }, kSteps);
  return along.derivative(1).value[0];
}

// By values at the same point of systems beside it; along z_q, F_z z_q = -F_q, the slope along v
// changes by d.
void BifurcationEquation::expand_by_value() {
  const double scale = branch_.scale();
  const auto values_at = [&](double x) -> Vector {
    const auto rows = branch_.scales().rows.head(w_.size());
    try {
      return rows.cwiseProduct(branch_.equations(at_.value + x)->values(at_.point, branch_.held()));
    } catch (const ConfigError&) {  // out of the parameter's range
      return Vector::Constant(w_.size(), std::numeric_limits<double>::quiet_NaN());
    }
  };
  CentralDifferences along(
      values_at,
      {.least = 0x1p-16 * scale, .most = 0.3 * scale, .grain = 4e-16 * std::abs(at_.value)});
  const Derivative by_value = along.derivative(1);
  by_value_ = {w_.dot(by_value.value), w_.cwiseAbs().dot(by_value.error)};
  const KernelVector with_value = vector_of(solve(-by_value.value));
  const auto equations = branch_.equations(at_.value);
  const int n = equations->dim();
  const auto slope = [&](double x) {
    BranchNode node = at_;
    node.value += x;
    node.point.g = equations->flow().moved(at_.point.g, x * with_value.step.head(n));
    node.point.xi = at_.point.xi + x * with_value.step.tail(n);
    node.point.generator = at_.point.generator + x * with_value.carrier;
    return slope_at(node);
  };
  const double x = 1e-3 * scale;
  try {
    mixed_ = (slope(x) - slope(-x)) / (2 * x);
  } catch (const ConfigError&) {
    mixed_ = std::numeric_limits<double>::infinity();
  }
  by_value_.error += std::abs(mixed_) * place_error_;
}

SteadyPoint BifurcationEquation::displaced(const BranchNode& from, double value, double s) const {
  const auto equations = branch_.equations(value);
  const int n = equations->dim();
  Vector step = s * v_.step;
  if (second_.step.size() > 0) step += s * s / 2 * second_.step;
  return equations->at(equations->flow().moved(from.point.g, step.head(n)),
                       from.point.xi + step.tail(n));
}

}  // namespace hamel::reduced
