#include <hamel/framework/analysis/state_units.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace hamel::reduced {
namespace {

// The factors l with equal norms of row i and column i of |m|_ij l_j/l_i, without the diagonal.
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

// l and 1/T; sizes: |dF| by (delta, nu).
void set_lengths(const Matrix& sizes, Vector& lengths, double& rate) {
  const Eigen::Index n = sizes.cols() / 2;
  const Matrix place = sizes.block(n, 0, n, n), velocity = sizes.block(n, n, n, n);
  lengths = Vector::Ones(n);
  rate = 0;
  for (int k = 0; k < 5; ++k) {
    const auto size = [&](const Matrix& m) {
      return (lengths.cwiseInverse().asDiagonal() * m * lengths.asDiagonal()).norm();
    };
    rate = std::max(std::sqrt(size(place)), size(velocity));
    if (!(rate > 0)) rate = 1;
    lengths = balanced(place + rate * velocity);
  }
}

// The distance along a direction at which F differs from its linear part by a third of it; nothing
// where it never does.
std::optional<double> linear_reach(const SteadyEquations& system, const SteadyPoint& at,
                                   const Vector& rows, const Vector& direction) {
  const Vector still = Vector::Zero(2 * system.dim());
  const auto values = [&](double e) -> Vector {
    return rows.cwiseProduct(system.displaced(at, true, e * direction, still));
  };
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

}  // namespace

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
  Vector lengths;
  double rate = 0;
  set_lengths(sizes, lengths, rate);
  out.columns.resize(2 * n);
  out.columns << lengths, rate * lengths;
  out.rows.resize(sizes.rows());
  out.rows.head(2 * n) << (rate * lengths).cwiseInverse(), (rate * rate * lengths).cwiseInverse();
  for (Eigen::Index i = 2 * n; i < sizes.rows(); ++i) {
    const double norm = sizes.row(i).dot(out.columns.transpose());
    out.rows[i] = norm > 0 ? 1 / norm : 1;
  }
  double reach = 0;
  for (const SteadyEquations* system : systems) {
    const SteadyPoint at = system->carried_guess();
    for (int sample = 1; sample <= 2; ++sample) {
      Vector direction(2 * n);
      for (int i = 0; i < 2 * n; ++i) direction[i] = std::sin(12.9898 * (i + 1) + 78.233 * sample);
      const auto one =
          linear_reach(*system, at, out.rows, out.columns.cwiseProduct(direction.normalized()));
      if (one) reach = reach > 0 ? std::min(reach, *one) : *one;
    }
  }
  if (!(reach > 0)) {
    const SteadyPoint guess = systems.front()->carried_guess();
    reach = guess.xi.cwiseQuotient(out.columns.tail(n)).norm();
    if (!(reach > 0)) reach = 1;
  }
  out.columns *= reach;
  out.rows /= reach;
  return out;
}

}  // namespace hamel::reduced
