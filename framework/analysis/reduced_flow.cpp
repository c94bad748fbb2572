#include <hamel/framework/analysis/reduced_flow.hpp>

#include <algorithm>
#include <cmath>

#include <hamel/framework/lie/decompositions.hpp>

namespace hamel::reduced {

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

Vector Flow::acceleration(const Vector& g, const Vector& xi) const {
  const int n = dim(), k = constraint_count();
  Matrix inertia(n, n), a(k, n), inertia_rate = Matrix::Zero(n, n), a_rate = Matrix::Zero(k, n);
  Vector b(k), b_rate = Vector::Zero(k), force(n), turned(n);
  differentiate(kStep / std::max(1.0, xi.norm()), [&](double shift, double weight) {
    const Vector there = moved(g, shift * xi);
    mechanics_->inertia(there.data(), inertia);
    inertia_rate += weight * inertia;
    if (k == 0) return;
    mechanics_->constraints(0, there.data(), a, b);
    a_rate += weight * a;
    b_rate += weight * b;
  });
  mechanics_->inertia(g.data(), inertia);
  if (k > 0) mechanics_->constraints(0, g.data(), a, b);
  mechanics_->force(0, g.data(), xi, force);
  const Vector mu = inertia * xi;
  geometry_->ad_transpose(xi.data(), mu.data(), turned.data());
  Matrix whole = Matrix::Zero(n + k, n + k);
  whole.topLeftCorner(n, n) = inertia;
  whole.topRightCorner(n, k) = -a.transpose();
  whole.bottomLeftCorner(k, n) = a;
  Vector right(n + k);
  right << force + turned - inertia_rate * xi, b_rate - a_rate * xi;
  return Vector(whole.partialPivLu().solve(right)).head(n);
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

Vector Flow::kept(const Vector& g, const Vector& xi, const Vector& eta, double e) const {
  const int n = dim(), k = constraint_count();
  const Vector back = -e * eta;
  Vector turn(g.size()), xi_there(n), force(n), phi(holonomic_rows());
  geometry_->tau(back.data(), turn.data());
  geometry_->Ad(turn.data(), xi.data(), xi_there.data());
  Matrix carry(n, n);  // Ad_exp(-e eta)
  for (int i = 0; i < n; ++i) {
    const Vector unit = Vector::Unit(n, i);
    Vector column(n);
    geometry_->Ad(turn.data(), unit.data(), column.data());
    carry.col(i) = column;
  }
  Matrix inertia(n, n), a(k, n), onto = Matrix::Zero(n, n);
  Vector b(k), drift = Vector::Zero(n);
  mechanics_->inertia(g.data(), inertia);
  mechanics_->force(0, g.data(), xi_there, force);
  mechanics_->holonomic(g.data(), phi);
  if (k > 0) {  // the span of the rows, and b, whatever the rows: an orthogonal projector
    mechanics_->constraints(0, g.data(), a, b);
    const Matrix here = a * carry;
    const Matrix square = dense::inverse(here * here.transpose());
    onto = here.transpose() * square * here;
    drift = here.transpose() * square * b;
  }
  const Matrix inertia_back = carry.transpose() * inertia * carry;
  const Vector force_back = carry.transpose() * force;
  Vector out(2 * n * n + 2 * n + holonomic_rows());
  out << inertia_back.reshaped(), onto.reshaped(), force_back, drift, phi;
  return out;
}

Matrix Flow::symmetries(const Vector& g) const {
  const int n = dim();
  Matrix changes(0, 2 * n), orbits(0, 2 * n);
  double scale = 0;  // of what is kept
  for (int sample = 1; sample <= 3; ++sample) {
    Vector shift(n), xi(n);
    for (int i = 0; i < n; ++i) {
      shift[i] = 0.3 * std::sin(12.9898 * (i + 1) + 78.233 * sample);
      xi[i] = std::sin(39.346 * (i + 1) + 11.135 * sample);
    }
    const Vector here = moved(g, shift);
    const Matrix back = Ad_inverse(here);
    Matrix change;
    for (int j = 0; j < 2 * n; ++j) {
      const Vector eta = j < n ? Vector::Zero(n) : Vector(Vector::Unit(n, j - n));
      const Vector delta = j < n ? Vector(back.col(j)) : eta;
      const double unit = kStep / std::max(1.0, delta.norm());
      Vector slope;
      differentiate(unit, [&](double e, double weight) {
        const Vector value = weight * kept(moved(here, e * delta), xi, eta, e);
        if (slope.size() == 0) slope = value;
        else slope += value;
      });
      if (change.size() == 0) change.resize(slope.size(), 2 * n);
      change.col(j) = slope;
    }
    changes.conservativeResize(changes.rows() + change.rows(), Eigen::NoChange);
    changes.bottomRows(change.rows()) = change;
    orbits.conservativeResize(orbits.rows() + 2 * n, Eigen::NoChange);
    orbits.bottomRows(2 * n) = orbit(Matrix::Identity(2 * n, 2 * n), here, xi);
    scale = std::max(scale, kept(here, xi, Vector::Zero(n), 0).lpNorm<Eigen::Infinity>());
  }
  const Matrix all = kernel_of(changes, 1e-9, scale);
  return all * range_of((orbits * all).transpose(), 1e-9, 1);
}

Matrix Flow::orbit(const Matrix& symmetries, const Vector& g, const Vector& xi) const {
  const int n = dim();
  Matrix out(2 * n, symmetries.cols());
  out.topRows(n) = Ad_inverse(g) * symmetries.topRows(n) + symmetries.bottomRows(n);
  out.bottomRows(n) = ad(xi) * symmetries.bottomRows(n);  // -ad_eta xi = ad_xi eta
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
