#include <hamel/framework/analysis/steady_branch.hpp>

#include <algorithm>
#include <cmath>

#include <hamel/framework/run/names/registry.hpp>

namespace hamel::reduced {
namespace {

// Threshold of slopes, whose errors are 1e-11: along a family a tangent has no part.
constexpr double kTangentRank = 1e-8;
constexpr double kLeastCosine = 0.8;  // between the tangents at the ends of a step
constexpr double kLeastStep = 1e-4;   // of the scale: below it a branch is taken to turn

}  // namespace

Branch::Branch(const Registry& registry, System at, double first, double last)
    : registry_(registry), at_(std::move(at)), scale_(first == last ? 1 : std::abs(last - first)) {
  const auto one = equations(first), other = equations(last);
  along_ = one->guess_momentum() >= other->guess_momentum() ? one->along() : other->along();
  known_.clear();
}

std::shared_ptr<const SteadyEquations> Branch::equations(double value) {
  constexpr size_t most = 32;
  auto found = known_.find(value);
  if (found == known_.end()) {
    if (known_.size() >= most) known_.clear();
    const Simulation run = at_(value);
    const Run built = run.build();
    auto made = std::make_shared<SteadyEquations>(registry_, built.system(), guess_of(run, built));
    if (along_.size() > 0) made->hold_along(along_);
    found = known_.emplace(value, std::move(made)).first;
  }
  return found->second;
}

Vector Branch::by_value(const BranchNode& at) {
  const double e = 1e-4;
  const auto there = [&](double shift) -> std::optional<Vector> {
    try {
      return equations(at.value + shift * scale_)->values(at.point, held_);
    } catch (const ConfigError&) {
      return std::nullopt;  // out of the parameter's range
    }
  };
  const auto before = there(-e), behind = there(e);
  if (before && behind) return (*behind - *before) / (2 * e);
  const Vector here = equations(at.value)->values(at.point, held_);
  if (behind) return (*behind - here) / e;
  if (before) return (here - *before) / e;
  return Vector::Zero(here.size());
}

BranchNode Branch::node(double value, SteadyPoint point, const Vector& sense) {
  BranchNode out{.value = value, .point = std::move(point), .tangent = {}};
  const Matrix slope = equations(value)->slope(out.point, held_);
  const Eigen::Index z = sense.size() - 1, c = slope.cols() - z;
  Matrix whole = Matrix::Zero(slope.rows() + 1, z + 1 + c);
  whole.topLeftCorner(slope.rows(), z) = slope.leftCols(z);
  whole.block(0, z, slope.rows(), 1) = by_value(out);
  whole.topRightCorner(slope.rows(), c) = slope.rightCols(c);
  whole.bottomLeftCorner(1, z + 1) = sense.transpose();
  const Vector solved =
      least_norm(whole, Vector::Unit(whole.rows(), whole.rows() - 1), kTangentRank);
  out.tangent = solved.head(z + 1).normalized();
  return out;
}

std::optional<BranchNode> Branch::start(double value) {
  const auto here = equations(value);
  SteadyPoint point = here->find_near_guess(held_);
  if (!(point.residual < kGood)) return std::nullopt;
  return node(value, std::move(point), Vector::Unit(2 * here->dim() + 1, 2 * here->dim()));
}

std::optional<BranchNode> Branch::step_to(const BranchNode& from, double value) {
  const auto there = equations(value);
  const int n = there->dim();
  const double dq = (value - from.value) / scale_;
  if (!(std::abs(from.tangent[2 * n]) > 1e-12)) return std::nullopt;
  const Vector slope = from.tangent / from.tangent[2 * n];
  const Vector predicted = dq * slope.head(2 * n);
  if (!(predicted.norm() < 1 + from.point.xi.norm())) return std::nullopt;
  SteadyPoint point = there->at(there->flow().moved(from.point.g, predicted.head(n)),
                                from.point.xi + predicted.tail(n));
  const Vector correction = there->find(point, held_, 12);
  if (!(point.residual < kGood)) return std::nullopt;
  const double size = 1 + point.xi.norm();
  BranchNode out = node(value, std::move(point), Vector::Unit(2 * n + 1, 2 * n));
  if (!(std::abs(out.tangent[2 * n]) > 1e-12)) return std::nullopt;
  const Vector change = (out.tangent / out.tangent[2 * n] - slope).head(2 * n);
  const double left = (correction - dq / 2 * change).norm();
  const bool smooth = std::abs(out.tangent.dot(from.tangent)) > kLeastCosine &&
                      (correction.norm() < 1e-7 * size || left < 0.25 * correction.norm());
  if (!(correction.norm() < 0.1 * size)) return std::nullopt;
  if (smooth) return out;
  // Along a family of steady motions Newton's method has its choice, and nothing can be compared.
  const auto all = there->singular(out.point, held_);
  const Eigen::Index null = (all.values.array() < kNull * all.size).count();
  return there->beside(out.point, all, null).cols() > 0 ? std::optional(out) : std::nullopt;
}

std::optional<BranchNode> Branch::advance(const BranchNode& from, double value, BranchNode& here) {
  here = from;
  double step = value - from.value;
  while (here.value != value) {
    const double left = value - here.value;
    const double next = std::abs(step) >= std::abs(left) ? value : here.value + step;
    if (auto found = step_to(here, next)) {
      here = std::move(*found);
      step *= 2;
    } else {
      step = (next - here.value) / 2;
      if (std::abs(step) < kLeastStep * std::min(scale_, std::abs(value - from.value)))
        return std::nullopt;
    }
  }
  return here;
}

std::optional<BranchNode> Branch::advance(const BranchNode& from, double value) {
  BranchNode here;
  return advance(from, value, here);
}

std::optional<BranchNode> Branch::beside(const BranchNode& from, const Vector& v) {
  const Eigen::Index z = v.size() - 1;
  const int n = static_cast<int>(z / 2);
  const Vector across = v.normalized();
  const auto moved = [&](const BranchNode& at, const Vector& step) {
    BranchNode out;
    out.value = at.value + scale_ * step[z];
    const auto there = equations(out.value);
    out.point =
        there->at(there->flow().moved(at.point.g, step.head(n)), at.point.xi + step.segment(n, n));
    return out;
  };
  try {
    BranchNode at = moved(from, v);
    double corrected = 0;
    for (int k = 0; k < 12 && at.point.residual > 1e-14; ++k) {
      const auto there = equations(at.value);
      const Matrix slope = there->slope(at.point, held_);
      const Eigen::Index c = slope.cols() - z;
      Matrix whole = Matrix::Zero(slope.rows() + 1, z + 1 + c);
      whole.topLeftCorner(slope.rows(), z) = slope.leftCols(z);
      whole.block(0, z, slope.rows(), 1) = by_value(at);
      whole.topRightCorner(slope.rows(), c) = slope.rightCols(c);
      whole.bottomLeftCorner(1, z + 1) = across.transpose();
      Vector left = Vector::Zero(whole.rows());
      left.head(slope.rows()) = there->values(at.point, held_);
      const Vector step = -least_norm(whole, left, kTangentRank).head(z + 1);
      corrected += step.norm();
      if (!(corrected < 0.5 * v.norm())) return std::nullopt;
      BranchNode next = moved(at, step);
      if (!(next.point.residual < at.point.residual)) break;
      at = std::move(next);
    }
    if (!(at.point.residual < kGood)) return std::nullopt;
    return node(at.value, std::move(at.point), across);
  } catch (const ConfigError&) {
    return std::nullopt;  // out of the parameter's range
  }
}

// The node with q' = 0 between `here` and the one `length` further on its tangent (Illinois rule).
BranchNode Branch::level(const BranchNode& here, double length, double behind) {
  const Eigen::Index z = here.tangent.size() - 1;
  double a = 0, b = length, fa = here.tangent[z], fb = behind;
  BranchNode at = here;
  for (int i = 0, side = 0; i < 16 && std::abs(b - a) > 1e-9 * length; ++i) {
    const double x = (fb * a - fa * b) / (fb - fa);
    if (!(std::abs(x) > 0)) break;
    const auto middle = beside(here, x * here.tangent);
    if (!middle) break;
    at = *middle;
    const double f = at.tangent[z];
    if (std::abs(f) < 1e-10) break;
    if ((f > 0) == (fb > 0)) {
      b = x, fb = f;
      if (side == 1) fa /= 2;
      side = 1;
    } else {
      a = x, fa = f;
      if (side == -1) fb /= 2;
      side = -1;
    }
  }
  return at;
}

std::optional<Branch::Turn> Branch::turn(const BranchNode& from, double value) {
  const Eigen::Index z = from.tangent.size() - 1;
  const double ahead = value > from.value ? 1 : -1;
  BranchNode here = from;
  if (here.tangent[z] * ahead < 0) here.tangent = -here.tangent;
  double length = 2e-3;
  for (int k = 0; k < 100 && length > 1e-6; ++k) {
    const auto next = beside(here, length * here.tangent);
    if (!next) {
      length /= 2;
      continue;
    }
    if (next->tangent[z] * ahead >= 0) {
      if ((next->value - value) * ahead > 0) return std::nullopt;
      here = *next;
      length = std::min(0.05, 1.5 * length);
      continue;
    }
    const BranchNode at = level(here, length, next->tangent[z]);
    // q = q0 - c s^2: the error of s counts as its square.
    const double error = std::max(1e-12, std::pow(at.tangent[z], 2)) * scale_;
    return Turn{.at = at, .behind = *next, .round_off = error * (1 + std::abs(at.value) / scale_)};
  }
  return std::nullopt;
}

}  // namespace hamel::reduced
