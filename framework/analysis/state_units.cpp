#include <hamel/framework/analysis/state_units.hpp>

#include <algorithm>
#include <cmath>

namespace hamel::reduced {
namespace {

// The distance at which values stop to be linear in a step, along two directions of columns.
double reach_of(const Vector& columns, const Vector& rows,
                const std::function<Vector(const Vector&)>& displaced) {
  double out = 0;
  for (int sample = 1; sample <= 2; ++sample) {
    Vector direction(columns.size());
    for (Eigen::Index i = 0; i < direction.size(); ++i)
      direction[i] = std::sin(12.9898 * static_cast<double>(i + 1) + 78.233 * sample);
    direction = columns.cwiseProduct(direction.normalized());
    const auto one = linear_reach(
        [&](double e) -> Vector { return rows.cwiseProduct(displaced(e * direction)); });
    if (one) out = out > 0 ? std::min(out, *one) : *one;
  }
  return out;
}

// The same, or the size of a velocity of a linear system, or 1.
double reach_or_size(double reach, const Vector& xi, const Vector& columns) {
  const double size = xi.cwiseQuotient(columns.tail(xi.size())).norm();
  return reach > 0 ? reach : size > 0 ? size : 1;
}

}  // namespace

Vector balanced(const Matrix& m) {
  Vector out = Vector::Ones(m.rows());
  for (int k = 0; k < 50; ++k) {
    for (Eigen::Index i = 0; i < m.rows(); ++i) {
      const double row = m.row(i).dot(out.transpose()) - m(i, i) * out[i],
                   column = m.col(i).dot(out.cwiseInverse()) - m(i, i) / out[i];
      if (row > 0 && column > 0) out[i] = std::sqrt(row / column);
    }
  }
  return out;
}

std::optional<double> linear_reach(const std::function<Vector(double)>& values) {
  const Vector here = values(0);
  bool linear = false;
  for (double h = 1e-10; h < 1e10; h *= 4) {
    const Vector up = values(h), down = values(-h);
    const Vector slope = up - down, half = 2 * (values(h / 2) - values(-h / 2));
    const double off = (slope - half).norm() + (up - 2 * here + down).norm();
    if (!(off < 1e300)) break;
    if (linear && off > 0.3 * half.norm()) return h;
    linear = linear || off < 0.1 * slope.norm();
  }
  return std::nullopt;
}

BalancedUnits balanced_units(const Matrix& by_place, const Matrix& by_velocity) {
  BalancedUnits out{.lengths = Vector::Ones(by_place.rows()), .rate = 0};
  for (int k = 0; k < 5; ++k) {
    const auto size = [&](const Matrix& m) {
      return (out.lengths.cwiseInverse().asDiagonal() * m * out.lengths.asDiagonal()).norm();
    };
    out.rate = std::max(std::sqrt(size(by_place)), size(by_velocity));
    if (!(out.rate > 0)) out.rate = 1;
    out.lengths = balanced(by_place + out.rate * by_velocity);
  }
  return out;
}

Vector own_lengths(const Matrix& slope, const Vector& xi,
                   const std::function<Vector(const Vector&)>& acceleration) {
  const Eigen::Index n = xi.size();
  const Matrix sizes = slope.cwiseAbs();
  const auto [lengths, rate] = balanced_units(sizes.leftCols(n), sizes.rightCols(n));
  Vector columns(2 * n);
  columns << lengths, rate * lengths;
  const double reach = reach_of(columns, (rate * rate * lengths).cwiseInverse(), acceleration);
  return reach_or_size(reach, xi, columns) * lengths;
}

StateUnits state_units(const std::vector<const SteadyEquations*>& systems) {
  StateUnits out;
  const int n = systems.front()->dim();
  Matrix sizes;
  for (const SteadyEquations* system : systems) {
    const Matrix slope = system->slope(system->carried_guess(), true).leftCols(2 * n).cwiseAbs();
    if (sizes.size() == 0) sizes = slope;
    else sizes = sizes.cwiseMax(slope);
  }
  const double least = 1e-9 * sizes.maxCoeff();  // round-off
  sizes = (sizes.array() < least).select(0, sizes);
  const auto [lengths, rate] = balanced_units(sizes.block(n, 0, n, n), sizes.block(n, n, n, n));
  out.columns.resize(2 * n);
  out.columns << lengths, rate * lengths;
  out.rows.resize(sizes.rows());
  out.rows.head(2 * n) << (rate * lengths).cwiseInverse(), (rate * rate * lengths).cwiseInverse();
  for (Eigen::Index i = 2 * n; i < sizes.rows(); ++i) {
    const double norm = sizes.row(i).dot(out.columns.transpose());
    out.rows[i] = norm > 0 ? 1 / norm : 1;
  }
  double reach = 0;
  const Vector still = Vector::Zero(2 * n);
  for (const SteadyEquations* system : systems) {
    const SteadyPoint at = system->carried_guess();
    const double one = reach_of(out.columns, out.rows, [&](const Vector& step) {
      return system->displaced(at, true, step, still);
    });
    if (one > 0) reach = reach > 0 ? std::min(reach, one) : one;
  }
  reach = reach_or_size(reach, systems.front()->carried_guess().xi, out.columns);
  out.columns *= reach;
  out.rows /= reach;
  return out;
}

}  // namespace hamel::reduced
