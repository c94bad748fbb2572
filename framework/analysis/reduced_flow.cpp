#include <hamel/framework/analysis/reduced_flow.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/metric/metric.hpp>

namespace hamel::reduced {

// The resolution of a displacement: epsilon of the numbers of g that it changes.
StepRange Flow::steps(const Vector& g, const Vector& eta) const {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  double scale = 0;  // the largest displacement of a component without one counts as unknown
  bool known = true;
  for (Eigen::Index i = 0; i < eta.size(); ++i) {
    if (eta[i] == 0) continue;
    known = known && scales_[i] > 0;
    if (known) scale = std::max(scale, std::abs(eta[i]) / scales_[i]);
  }
  const double step =
      known ? 0x1p-10 / scale : 0x1p-10 * std::max(1e-300, g.lpNorm<1>()) / eta.norm();
  const Vector rate = (moved(g, step * eta) - g) / step;
  const double most = rate.lpNorm<Eigen::Infinity>();
  double grain = 0;
  for (Eigen::Index i = 0; i < g.size(); ++i)
    if (std::abs(rate[i]) >= most / 4 && most > 0)
      grain = std::max(grain, epsilon * std::abs(g[i]) / most);
  return known ? steps_of_scale(1 / scale, grain) : steps_of_any_scale(grain);
}

StepRange Flow::velocity_steps(const Vector& xi, int component) const {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  double size = std::abs(xi[component]);
  if (scales_[component] > 0) {
    for (Eigen::Index i = 0; i < xi.size(); ++i)
      if (scales_[i] > 0) size = std::max(size, std::abs(xi[i]) / scales_[i] * scales_[component]);
  }
  return steps_of_any_scale(epsilon * size);
}

Vector Flow::extents(const Vector& g) const {
  const int n = dim(), k = constraint_count();
  Vector out = Vector::Constant(n, 1);
  if (mechanics_->constant_inertia() && mechanics_->constant_constraints()) return out;
  if (recorded_ != nullptr || mechanics_->exact_rates()) return out;  // none is needed
  Matrix inertia(n, n), a(k, n);
  Vector b(k);
  Vector all(n * n + k * n + k);
  for (int i = 0; i < n; ++i) {
    const Vector along = Vector::Unit(n, i);
    const auto values = [&](double e) {
      const Vector there = moved(g, e * along);
      mechanics_->inertia(there.data(), inertia);
      if (k > 0) mechanics_->constraints(0, there.data(), a, b);
      all << inertia.reshaped(), a.reshaped(), b;
      return all;
    };
    const Vector value = values(0);
    CentralDifferences differences(values, steps(g, along));
    const Extent extent = differences.extent();
    out[i] = steps(g, along).most;
    const double least = 1e-12 * value.lpNorm<Eigen::Infinity>();  // above the round-off of values
    for (Eigen::Index c = 0; c < value.size(); ++c)
      if (extent.change[c] > least) out[i] = std::min(out[i], extent.length[c]);
  }
  return out;
}

Vector Flow::moved(const Vector& g, const Vector& eta) const {
  Vector out(g.size());
  geometry_->tau(eta.data(), out.data());
  geometry_->compose(g.data(), out.data(), out.data());
  return out;
}

Vector Flow::difference(const Vector& g, const Vector& h) const {
  Vector back(g.size()), out(dim());
  geometry_->inverse(g.data(), back.data());
  geometry_->compose(back.data(), h.data(), back.data());
  if (!geometry_->tau_inverse(back.data(), out.data())) out.setZero();
  return out;
}

Matrix Flow::ad(const Vector& xi) const {
  Matrix out(dim(), dim());
  for (int i = 0; i < dim(); ++i) {
    const Vector unit = Vector::Unit(dim(), i);
    Vector row(dim());
    geometry_->ad_transpose(xi.data(), unit.data(), row.data());
    out.row(i) = row.transpose();
  }
  return out;
}

Matrix Flow::Ad_inverse(const Vector& g) const {
  Vector inverse(g.size()), column(dim());
  geometry_->inverse(g.data(), inverse.data());
  Matrix out(dim(), dim());
  for (int i = 0; i < dim(); ++i) {
    const Vector unit = Vector::Unit(dim(), i);
    geometry_->Ad(inverse.data(), unit.data(), column.data());
    out.col(i) = column;
  }
  return out;
}

// (dI/dt) xi and db/dt - (dA/dt) xi along the motion.
void Flow::find_rates(const Vector& g, const Vector& xi, const Vector& extents, Vector& momentum,
                      Vector& rows) const {
  const int n = dim(), k = constraint_count();
  momentum = Vector::Zero(n);
  rows = Vector::Zero(k);
  if (mechanics_->constant_inertia() && mechanics_->constant_constraints()) return;
  const double speed = xi.cwiseQuotient(extents).lpNorm<Eigen::Infinity>();  // 1/s
  if (!(speed > 0)) return;
  Matrix inertia(n, n), a(k, n);
  Vector b(k);
  differentiate(1 / speed, [&](double shift, double weight) {
    const Vector there = moved(g, shift * xi);
    mechanics_->inertia(there.data(), inertia);
    momentum += weight * (inertia * xi);
    if (k == 0) return;
    mechanics_->constraints(0, there.data(), a, b);
    rows += weight * (b - a * xi);
  });
}

Vector Flow::acceleration(const Vector& g, const Vector& xi, const Vector& extents) const {
  if (recorded_ != nullptr) return recorded_->acceleration(g, xi);
  const int n = dim(), k = constraint_count();
  Metric<> metric(n, k);
  Matrix &inertia = metric.inertia, &a = metric.a;
  Vector &b = metric.b, row_rate(k), change(n);
  if (mechanics_->constant_inertia()) mechanics_->inertia(g.data(), inertia);
  if (k > 0 && mechanics_->constant_constraints()) mechanics_->constraints(0, g.data(), a, b);
  if (mechanics_->exact_rates()) {
    mechanics_->motion(*geometry_, 0, g.data(), xi, inertia, a, b, row_rate, change);
  } else {
    Vector turned(n), momentum_rate;
    find_rates(g, xi, extents, momentum_rate, row_rate);
    mechanics_->inertia(g.data(), inertia);
    if (k > 0) mechanics_->constraints(0, g.data(), a, b);
    mechanics_->force(0, g.data(), xi, change);
    const Vector mu = inertia * xi;
    geometry_->ad_transpose(xi.data(), mu.data(), turned.data());
    change += turned - momentum_rate;
  }
  metric.factor(true, k > 0);
  Vector out(n);
  metric.solve(change, row_rate, out);
  return out;
}

// The rows of phi are their differentials, the last rows of A.
Matrix Flow::slopes(const Vector& g, const Vector& xi) const {
  const int n = dim(), k = constraint_count(), held = holonomic_rows();
  const std::vector<MotionValues> terms = recorded_->along(g, xi, Matrix::Identity(2 * n, 2 * n));
  const Matrix rows = recorded_->at(g, xi).rows;
  Matrix out = Matrix::Zero(n + held + k, 2 * n);
  out.topRows(n) = recorded_->acceleration_slopes(g, xi, terms);
  out.block(n, 0, held, n) = rows.bottomRows(held);
  for (int j = 0; j < 2 * n; ++j) {
    const MotionValues& d = terms[static_cast<size_t>(j)];
    out.col(j).tail(k) = d.rows * xi - d.drift;
  }
  out.bottomRightCorner(k, n) += rows;
  return out;
}

Vector Flow::momentum(const Vector& g, const Vector& xi) const {
  Matrix inertia(dim(), dim());
  mechanics_->inertia(g.data(), inertia);
  return inertia * xi;
}

Vector Flow::holonomic(const Vector& g) const {
  Vector phi(holonomic_rows());
  mechanics_->holonomic(g.data(), phi);
  return phi;
}

Vector Flow::slip(const Vector& g, const Vector& xi) const {
  Matrix a(constraint_count(), dim());
  Vector b(constraint_count());
  mechanics_->constraints(0, g.data(), a, b);
  return a * xi - b;
}

Matrix Flow::orbit(const Matrix& symmetries, const Vector& g, const Vector& xi) const {
  const int n = dim();
  Matrix out(2 * n, symmetries.cols());
  out.topRows(n) = Ad_inverse(g) * symmetries.topRows(n) + symmetries.bottomRows(n);
  out.bottomRows(n) = ad(xi) * symmetries.bottomRows(n);  // -ad_eta xi = ad_xi eta
  return out;
}

Vector Flow::carrier(const Vector& generator, const Vector& g, const Vector& xi) const {
  const int n = dim();
  const Vector zeta = generator.head(n), eta = generator.tail(n);
  Vector inverse(g.size()), moved(n), out(2 * n);
  geometry_->inverse(g.data(), inverse.data());
  geometry_->Ad(inverse.data(), zeta.data(), moved.data());
  out.head(n) = moved + eta;
  if (eta.isZero(0)) out.tail(n).setZero();
  else out.tail(n) = ad(xi) * eta;
  return out;
}

namespace {

Eigen::Index rank_of(const Vector& singular, double least, double scale) {
  Eigen::Index rank = 0;
  const double most = singular.size() == 0 ? scale : std::max({1e-300, scale, singular[0]});
  while (rank < singular.size() && singular[rank] > least * most) ++rank;
  return rank;
}

}  // namespace

Matrix range_of(const Matrix& m, double least, double scale) {
  if (m.cols() == 0) return m;
  const dense::Svd svd = dense::svd(m, Eigen::ComputeFullU);
  return svd.u.leftCols(rank_of(svd.values, least, scale));
}

Matrix kernel_of(const Matrix& m, double least, double scale) {
  if (m.rows() == 0) return Matrix::Identity(m.cols(), m.cols());
  const dense::Svd svd = dense::svd(m, Eigen::ComputeFullV);
  return svd.v.rightCols(m.cols() - rank_of(svd.values, least, scale));
}

}  // namespace hamel::reduced
