#include <hamel/framework/analysis/steady_branch.hpp>

#include <algorithm>
#include <cmath>

#include <hamel/framework/analysis/matching.hpp>
#include <hamel/framework/analysis/state_units.hpp>
#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/run/names/registry.hpp>

namespace hamel::reduced {
namespace {

// Threshold of slopes, whose errors are 1e-11: along a family a tangent has no part.
constexpr double kTangentRank = 1e-8;
constexpr double kCrossingRank = 1e-5;  // nearer to a crossing the tangent has two values
constexpr double kLeastCosine = 0.8;    // between the tangents at the ends of a step
constexpr double kLeastStep = 1e-4;     // of the scale: below it a branch is taken to turn
}  // namespace

Branch::Branch(const Registry& registry, System at, double first, double last)
    : registry_(registry), at_(std::move(at)), scale_(first == last ? 1 : std::abs(last - first)) {
  const auto one = equations(first), other = equations(last),
             middle = equations(0.5 * (first + last));
  along_ = one->guess_momentum() >= other->guess_momentum() ? one->along() : other->along();
  scales_ = state_units({one.get(), middle.get(), other.get()});
  known_.clear();
}

std::shared_ptr<const SteadyEquations> Branch::equations(double value) {
  constexpr size_t most = 32;
  auto found = known_.find(value);
  if (found == known_.end()) {
    if (known_.size() >= most) known_.clear();
    const Simulation run = at_(value);
    const Run built = run.build();
    auto made = std::make_shared<SteadyEquations>(registry_, built.system(), guess_of(run, built),
                                                  neighbour_.get());
    if (along_.size() > 0) made->hold_along(along_);
    if (scales_.columns.size() > 0) made->set_scales(scales_);
    neighbour_ = made;
    found = known_.emplace(value, std::move(made)).first;
  }
  return found->second;
}

Vector Branch::by_value(double value, const SteadyPoint& point) {
  const double e = 1e-4;
  const auto there = [&](double shift) -> std::optional<Vector> {
    try {
      return equations(value + shift * scale_)->values(point, held_);
    } catch (const ConfigError&) {
      return std::nullopt;  // out of the parameter's range
    }
  };
  const auto before = there(-e), behind = there(e);
  if (before && behind) return (*behind - *before) / (2 * e);
  const Vector here = equations(value)->values(point, held_);
  if (behind) return (*behind - here) / e;
  if (before) return (here - *before) / e;
  return Vector::Zero(here.size());
}

Matrix Branch::slope(double value, const SteadyPoint& point, const Metric& metric,
                     const Vector& across) {
  const Matrix slope = equations(value)->slope_across(point, held_);
  const Eigen::Index z = across.size() - 1, rows = slope.rows();
  const Vector by_own = scales_.columns.cwiseInverse().cwiseProduct(metric.z);
  Matrix whole(rows + 1, z + 1);
  whole.topLeftCorner(rows, z) = slope * by_own.asDiagonal();
  whole.block(0, z, rows, 1) =
      scales_.rows.head(rows).cwiseProduct(by_value(value, point)) * (metric.q / scale_);
  whole.bottomRows(1) = across.transpose();
  return whole;
}

BranchNode Branch::node(double value, SteadyPoint point, const Vector& sense,
                        const Metric& metric) {
  BranchNode out{.value = value, .point = std::move(point), .tangent = {}, .rank = 0};
  const Matrix whole = slope(value, out.point, metric, sense);
  const Vector solved =
      least_norm(whole, Vector::Unit(whole.rows(), whole.rows() - 1), kTangentRank);
  out.tangent = solved.normalized();
  const Vector values = dense::svd(whole.topRows(whole.rows() - 1)).values;
  out.rank = (values.array() > kCrossingRank * values[0]).count();
  return out;
}

BranchNode Branch::node(double value, SteadyPoint point) {
  const Eigen::Index z = scales_.columns.size();
  return node(value, std::move(point), Vector::Unit(z + 1, z), own_metric());
}

std::optional<BranchNode> Branch::start(double value) {
  const auto here = equations(value);
  SteadyPoint point = here->find_near_guess(held_);
  if (!(point.residual < kGood)) return std::nullopt;
  return node(value, std::move(point));
}

std::optional<BranchNode> Branch::step_to(const BranchNode& from, double value) {
  const auto there = equations(value);
  const int n = there->dim();
  const Vector& units = scales_.columns;
  const auto size_of = [&](const SteadyPoint& p) {
    return 1 + p.xi.cwiseQuotient(units.tail(n)).norm();
  };
  const double dq = (value - from.value) / scale_;
  if (!(std::abs(from.tangent[2 * n]) > 1e-12)) return std::nullopt;
  const Vector slope = from.tangent / from.tangent[2 * n];
  const Vector predicted = dq * slope.head(2 * n);
  if (!(predicted.norm() < size_of(from.point))) return std::nullopt;
  const Vector step = units.cwiseProduct(predicted);
  SteadyPoint point =
      there->at(there->flow().moved(from.point.g, step.head(n)), from.point.xi + step.tail(n));
  const Vector correction = there->find(point, held_, 12).cwiseQuotient(units);
  if (!(point.residual < kGood)) return std::nullopt;
  const double size = size_of(point);
  BranchNode out = node(value, std::move(point));
  // Where branches cross, equations are missing: the tangent is that of this one.
  if (out.rank < from.rank) out.tangent = from.tangent;
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

// How far the point may move along v, in own units, without F exceeding its noise by more than a
// factor 2: s with sigma s, or the curvature times s^2/2 near a fold, of that size.
static double play(const SteadyEquations& equations, const BranchNode& at, bool held,
                   const Vector& v) {
  const double noise = 2 * std::max(at.point.residual, kNoise);
  const Vector still = Vector::Zero(v.size());
  const auto size = [&](double s) {
    const Vector step = s * equations.scales().columns.cwiseProduct(v);
    const Vector left = equations.displaced(at.point, held, step, still);
    return equations.scales().rows.head(left.size()).cwiseProduct(left).norm();
  };
  double s = 0.1;
  while (s > 1e-14 && std::min(size(s), size(-s)) > noise) s /= 2;
  return s;
}

// Where F_z is nearly singular the point itself is known badly: at a fold to the square root of the
// residual. The eigenvalues' errors include what this changes.
SteadyMotion Branch::motion(const BranchNode& at, int family) {
  const auto here = equations(at.value);
  SteadyMotion out = here->motion(at.point, family);
  const dense::Svd svd = dense::svd(here->slope_across(at.point, held_), Eigen::ComputeFullV);
  const Eigen::Index rank = (svd.values.array() > kNull * svd.values[0]).count();
  if (rank == 0 || svd.values[rank - 1] > kCrossingRank * svd.values[0]) return out;
  const int n = here->dim();
  const Vector v = svd.v.col(rank - 1);
  const Vector step = play(*here, at, held_, v) * scales_.columns.cwiseProduct(v);
  for (const double side : {1.0, -1.0}) {
    const SteadyPoint moved = here->at(here->flow().moved(at.point.g, side * step.head(n)),
                                       at.point.xi + side * step.tail(n));
    const SteadyMotion other = here->motion(moved, out.family);
    const std::vector<int> to = matched(out.eigenvalues, other.eigenvalues);
    for (size_t i = 0; i < to.size(); ++i) {
      if (to[i] < 0) continue;
      const Complex there = other.eigenvalues[static_cast<size_t>(to[i])];
      out.round_off[i] = std::max(out.round_off[i], std::abs(there - out.eigenvalues[i]));
    }
  }
  return out;
}

}  // namespace hamel::reduced
