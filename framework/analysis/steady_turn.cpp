// Folds of a branch, followed by its length.
#include <algorithm>
#include <cmath>

#include <hamel/framework/analysis/steady_branch.hpp>
#include <hamel/framework/lie/decompositions.hpp>

namespace hamel::reduced {
namespace {

constexpr double kTurnRank = 1e-8;  // as of tangents
constexpr double kTurnStep = 1e-3;  // of the scale: where a fold is looked for, a unit of length

}  // namespace

// Lengths of which 1 is a change of q by kTurnStep, and as much of z along the branch.
Branch::Metric Branch::metric_at(const BranchNode& node) const {
  Metric out = own_metric();
  const Eigen::Index z = out.z.size();
  const double steepness = node.tangent.head(z).norm() / std::abs(node.tangent[z]);
  out.q *= kTurnStep;
  out.z *= kTurnStep * (steepness > 1e-6 ? steepness : 1);
  return out;
}

// From a node by a step and what Newton's method adds across it; a step of 2n + 1 numbers.
std::optional<BranchNode> Branch::beside(const BranchNode& from, const Vector& step,
                                         const Metric& metric) {
  const Eigen::Index z = step.size() - 1;
  const int n = static_cast<int>(z / 2);
  const Vector across = step.normalized();
  const auto moved = [&](const BranchNode& at, const Vector& by) {
    BranchNode out;
    out.value = at.value + metric.q * by[z];
    const auto there = equations(out.value);
    const Vector state = metric.z.cwiseProduct(by.head(z));
    out.point =
        there->at(there->flow().moved(at.point.g, state.head(n)), at.point.xi + state.tail(n));
    return out;
  };
  try {
    BranchNode at = moved(from, step);
    double corrected = 0;
    for (int k = 0; k < 12 && at.point.residual > 1e-14; ++k) {
      const auto there = equations(at.value);
      const Matrix whole = slope(at.value, at.point, metric, across);
      Vector left = Vector::Zero(whole.rows());
      const Vector values = there->values(at.point, held_);
      left.head(values.size()) = scales_.rows.head(values.size()).cwiseProduct(values);
      const Vector change = -least_norm(whole, left, kTurnRank);
      corrected += change.norm();
      if (!(corrected < 0.5 * step.norm())) return std::nullopt;
      BranchNode next = moved(at, change);
      if (!(next.point.residual < at.point.residual)) break;
      at = std::move(next);
    }
    if (!(at.point.residual < kGood)) return std::nullopt;
    return node(at.value, std::move(at.point), across, metric);
  } catch (const ConfigError&) {
    return std::nullopt;  // out of the parameter's range
  }
}

// Nodes at equal steps along the branch, from two before `here` to three behind it.
std::vector<BranchNode> Branch::nodes_over(const BranchNode& here, double length,
                                           const Metric& metric) {
  std::vector<BranchNode> out{here};
  const auto add = [&](double sign, int count) {
    BranchNode at = here;
    for (int k = 0; k < count; ++k) {
      const Vector sense = at.tangent;
      const auto next = beside(at, sign * length * sense, metric);
      if (!next) return;
      at = *next;
      if (at.tangent.dot(sense) < 0) at.tangent = -at.tangent;
      out.insert(sign > 0 ? out.end() : out.begin(), at);
    }
  };
  add(1, 3);
  add(-1, 2);
  return out;
}

// Where q is stationary as a function of the place along a direction, by the polynomial through
// nodes: at the point itself Newton's method has two branches to choose from, if it is not a fold.
Branch::Stationary Branch::stationary(const std::vector<BranchNode>& nodes, double guess,
                                      const Vector& places) const {
  const Eigen::Index count = std::ssize(nodes);
  Matrix powers(count, count);
  Vector values(count);
  const double size = places.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j)
      powers(i, j) = std::pow(places[i] / size, static_cast<double>(j));
    values[i] = nodes[static_cast<size_t>(i)].value - nodes.front().value;
  }
  const Vector c = dense::solve_pivoted(powers, values);
  double x = guess / size;
  for (int k = 0; k < 50; ++k) {
    double first = 0, second = 0;
    for (Eigen::Index j = count - 1; j > 0; --j) {
      const auto power = static_cast<double>(j);
      if (j > 1) second = second * x + power * (power - 1) * c[j];
      first = first * x + power * c[j];
    }
    const double step = first / second;
    if (!(std::abs(step) < 10)) break;
    x -= step;
    if (std::abs(step) < 1e-15) break;
  }
  double value = 0;
  for (Eigen::Index j = count; j-- > 0;) value = value * x + c[j];
  return {x * size, nodes.front().value + value};
}

std::optional<Branch::Turn> Branch::turn_at(const BranchNode& here, double length,
                                            const Metric& metric) {
  const std::vector<BranchNode> nodes = nodes_over(here, length, metric);
  if (nodes.size() < 6) return std::nullopt;
  const auto equations = this->equations(here.value);
  const int n = equations->dim();
  const Vector along = here.tangent.head(2 * n).normalized();
  Matrix apart(2 * n, std::ssize(nodes));
  for (size_t i = 0; i < nodes.size(); ++i) {
    apart.col(static_cast<Eigen::Index>(i))
        << equations->flow().difference(here.point.g, nodes[i].point.g),
        nodes[i].point.xi - here.point.xi;
  }
  const Vector places = (metric.z.cwiseInverse().asDiagonal() * apart).transpose() * along;
  const Stationary all = stationary(nodes, 0.5 * (places[2] + places[3]), places);
  const Stationary inner = stationary({nodes.begin() + 1, nodes.end() - 1},
                                      0.5 * (places[2] + places[3]), places.segment(1, 4));
  Vector state = Vector::Zero(2 * n);
  for (Eigen::Index i = 0; i < places.size(); ++i) {
    double weight = 1;
    for (Eigen::Index j = 0; j < places.size(); ++j)
      if (j != i) weight *= (all.place - places[j]) / (places[i] - places[j]);
    state += weight * apart.col(i);
  }
  BranchNode at = here;
  at.value = all.value;
  at.point = this->equations(at.value)->at(equations->flow().moved(here.point.g, state.head(n)),
                                           here.point.xi + state.tail(n));
  const double span = places.maxCoeff() - places.minCoeff();
  const Vector by_value = this->by_value(at.value, at.point);
  const double steepness = scales_.rows.head(by_value.size()).cwiseProduct(by_value).norm();
  const double error = std::abs(all.value - inner.value) + kNoise * scale_ / steepness;
  return Turn{.turns = true,
              .before = node(nodes.front().value, nodes.front().point),
              .at = std::move(at),
              .behind = node(nodes.back().value, nodes.back().point),
              .round_off = error + 4e-16 * std::abs(at.value),
              .place_error = std::abs(all.place - inner.place) / span};
}

std::optional<Branch::Turn> Branch::turn(const BranchNode& from, double value) {
  const Eigen::Index z = from.tangent.size() - 1;
  const double ahead = value > from.value ? 1 : -1;
  const Metric metric = metric_at(from);
  BranchNode here = node(from.value, from.point, Vector::Unit(z + 1, z), metric);
  if (here.tangent[z] * ahead < 0) here.tangent = -here.tangent;
  double length = 0.02;
  for (int k = 0; k < 200 && length > 1e-6; ++k) {
    const auto next = beside(here, length * here.tangent, metric);
    if (!next || next->tangent.dot(here.tangent) < 0.8) {
      length /= 2;
      continue;
    }
    if ((next->value - value) * ahead >= 0) {
      const BranchNode past = node(next->value, next->point);
      return Turn{.turns = false, .before = from, .at = past, .behind = past};
    }
    if (next->tangent[z] * ahead < 0) return turn_at(here, length, metric);
    here = *next;
    length = std::min(50.0, 1.5 * length);
  }
  return std::nullopt;
}

}  // namespace hamel::reduced
