// The linearisation about a steady motion with the errors of its entries, and the lengths and rates
// over which the equations are differentiated.
#include <algorithm>
#include <cmath>
#include <limits>

#include <hamel/framework/analysis/state_units.hpp>
#include <hamel/framework/analysis/steady_equations.hpp>
#include <hamel/framework/lie/decompositions.hpp>

namespace hamel::reduced {
namespace {

// The pseudo-inverse, singular values below 1e-10 taken for zero.
Matrix pseudo_inverse(const Matrix& m) {
  if (m.rows() == 0) return m.transpose();
  const dense::Svd svd = dense::svd(m, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const double least = 1e-10 * svd.values.maxCoeff();
  const Vector inverse = svd.values.unaryExpr([&](double s) { return s > least ? 1 / s : 0; });
  return svd.v * inverse.asDiagonal() * svd.u.transpose();
}

}  // namespace

// Displacements that have no scale take the lengths over which the acceleration is linear.
Vector SteadyEquations::units() const {
  const int n = dim();
  Vector out = flow_.units();
  if ((flow_.scales().array() > 0).all()) return out;
  const auto acceleration = [&](const Vector& step) {
    return flow_.acceleration(flow_.moved(guess_g_, step.head(n)), guess_xi_ + step.tail(n),
                              reach_.extents);
  };
  Matrix slope(n, 2 * n);
  for (int j = 0; j < 2 * n; ++j) {
    const Vector along = Vector::Unit(2 * n, j);
    CentralDifferences differences(
        [&](double e) { return acceleration(e * along); },
        j < n ? flow_.steps(guess_g_, along.head(n)) : flow_.velocity_steps(guess_xi_, j - n));
    const Derivative d = differences.derivative(1);
    slope.col(j) = d.error.allFinite() ? d.value : Vector::Zero(n);
  }
  const Vector lengths = own_lengths(slope, guess_xi_, acceleration);
  for (int i = 0; i < n; ++i)
    if (!(flow_.scales()[i] > 0)) out[i] = lengths[i];
  return out;
}

// The equations along one of the 2n numbers (delta, nu), the generator held. noise: of them, or
// empty.
CentralDifferences SteadyEquations::differences(const SteadyPoint& at, int number,
                                                const Reach& reach, const Vector& noise) const {
  const int n = dim(), component = number % n;
  const bool velocity = number >= n;
  const Vector along = Vector::Unit(n, component);
  StepRange steps = velocity ? flow_.velocity_steps(at.xi, component) : flow_.steps(at.g, along);
  steps.noise = noise;
  return {[this, &at, &reach, velocity, along](double e) -> Vector {
            return velocity ? equations(at.generator, at.g, at.xi + e * along, reach)
                            : equations(at.generator, flow_.moved(at.g, e * along), at.xi, reach);
          },
          steps};
}

SteadyPoint SteadyEquations::point_beside(const SteadyPoint& at, const Reach& reach,
                                          double e) const {
  const int n = dim();
  Vector direction(2 * n);
  for (int i = 0; i < 2 * n; ++i) direction[i] = reach.steps[i] * std::sin(12.9898 * (i + 1));
  return {.g = flow_.moved(at.g, e * direction.head(n)),
          .xi = at.xi + e * direction.tail(n),
          .generator = at.generator};
}

// The error of exact derivatives is their round-off, of differences that of their estimates, with
// the round-off of values.
SteadyEquations::Slope SteadyEquations::slope_with_error(const SteadyPoint& at) const {
  constexpr double step = 0x1p-30, kRoundOff = 1e-15;
  const int n = dim();
  Slope out;
  if (flow_.recorded() != nullptr) {
    out.value = derivative(at);
    const Vector noise = noise_of(
        [&](double e) { return Vector(derivative(point_beside(at, reach_, e)).reshaped()); }, step);
    out.error = noise.reshaped(out.value.rows(), out.value.cols())
                    .cwiseMax(kRoundOff * out.value.cwiseAbs());
    return out;
  }
  Reach reach = reach_;
  reach.extents = flow_.extents(at.g);
  const Vector noise = noise_of(
      [&](double e) {
        const SteadyPoint there = point_beside(at, reach, e);
        return equations(there.generator, there.g, there.xi, reach);
      },
      step);
  out.value.resize(noise.size(), 2 * n);
  out.error = out.value;
  for (int j = 0; j < 2 * n; ++j) {
    const Derivative d = differences(at, j, reach, noise).derivative(1);
    out.value.col(j) = d.value;
    out.error.col(j) = d.error;
  }
  return out;
}

// The field, phi and A xi - b along each of the 2n numbers: what they are smooth over, and how fast
// they change. Without an end of smoothness: the scale of the number, or 1.
void SteadyEquations::find_reach() {
  const int n = dim();
  const Vector &g = guess_g_, &xi = guess_xi_, &units = flow_.units();
  Reach& out = reach_;
  out.steps = Vector::Zero(2 * n);
  out.rate = xi.cwiseQuotient(units).lpNorm<Eigen::Infinity>();
  const SteadyPoint point{.g = g, .xi = xi, .generator = Vector::Zero(2 * n)};
  std::vector<Extent> extents;
  double most = 0;  // of the changes of all equations
  for (int j = 0; j < 2 * n; ++j) {
    CentralDifferences differences = this->differences(point, j, out, Vector());
    const Vector slope =
        differences.derivative(1).value.segment(n, n).cwiseQuotient(units) * units[j % n];
    const double size = slope.lpNorm<Eigen::Infinity>();
    if (std::isfinite(size)) out.rate = std::max(out.rate, j < n ? std::sqrt(size) : size);
    Extent& extent = extents.emplace_back(differences.extent());
    for (Eigen::Index c = 0; c < 2 * n; ++c) extent.change[c] /= units[c % n];
    most = std::max(most, extent.change.lpNorm<Eigen::Infinity>());
  }
  if (!(out.rate > 0)) out.rate = 1;
  for (int j = 0; j < 2 * n; ++j) {
    const Extent& extent = extents[static_cast<size_t>(j)];
    double& step = out.steps[j];
    step = std::max(units[j % n] * (j < n ? 1 : out.rate), j < n ? 0 : std::abs(xi[j % n]));
    double length = std::numeric_limits<double>::infinity();
    for (Eigen::Index c = 0; c < extent.length.size(); ++c)
      if (extent.change[c] > 1e-12 * most) length = std::min(length, extent.length[c]);
    step = std::min(step, length);
  }
}

// In units of the system's own sizes, so that ranks do not depend on those of the user: lengths and
// angles of own_scales(), rates of the fastest change.
ReducedLinearisation SteadyEquations::linearise(const SteadyPoint& at) const {
  const int n = dim(), bound = flow_.holonomic_rows() + flow_.constraint_count();
  ReducedLinearisation out;
  auto [whole, error] = slope_with_error(at);  // of W, phi, A xi - b
  out.rate = reach_.rate;
  out.sizes.resize(2 * n);
  out.sizes << flow_.units(), flow_.units() * reach_.rate;
  const Matrix to_own = out.sizes.cwiseInverse().asDiagonal();
  whole = (whole * out.sizes.asDiagonal()).eval();
  error = (error * out.sizes.asDiagonal()).eval();
  whole.topRows(2 * n) = (to_own * whole.topRows(2 * n)).eval();
  error.topRows(2 * n) = (to_own * error.topRows(2 * n)).eval();
  for (Eigen::Index i = 2 * n; i < whole.rows(); ++i) {
    const double size = whole.row(i).norm();
    if (!(size > 0)) continue;
    whole.row(i) /= size;
    error.row(i) /= size;
  }
  const Matrix own_orbit = range_of(to_own * flow_.orbit(symmetries(), at.g, at.xi), 1e-9, 1);
  out.orbit = out.sizes.asDiagonal() * own_orbit;
  Matrix bounds(bound + own_orbit.cols(), 2 * n);
  bounds << whole.bottomRows(bound), own_orbit.transpose();
  const Matrix basis = kernel_of(bounds, 1e-10);
  out.basis = out.sizes.asDiagonal() * basis;
  out.dual = basis.transpose() * to_own;
  const Matrix flow = whole.topRows(2 * n);
  out.flow = basis.transpose() * flow * basis;
  // The errors of the entries, and those of the basis: d basis = -bounds^+ (d bounds) basis.
  const double round_off = 4 * std::numeric_limits<double>::epsilon();
  const Matrix size = basis.cwiseAbs(), flow_size = flow.cwiseAbs();
  Matrix bounds_error = round_off * bounds.cwiseAbs();
  bounds_error.topRows(bound) += error.bottomRows(bound);
  Matrix turned = pseudo_inverse(bounds).cwiseAbs() * bounds_error * size;
  if (bounds.rows() > 0) turned.array() += round_off;  // of the decomposition, in every entry
  out.error =
      size.transpose() * (error.topRows(2 * n) + (round_off + at.residual) * flow_size) * size +
      size.transpose() * flow_size * turned + turned.transpose() * flow_size * size;
  return out;
}

}  // namespace hamel::reduced
