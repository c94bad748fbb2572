#include <hamel/framework/analysis/reduced_flow.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <hamel/framework/lie/decompositions.hpp>

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
  Matrix inertia(n, n), a(k, n);
  Vector b(k), row_rate(k), change(n);
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
  Matrix whole = Matrix::Zero(n + k, n + k);
  whole.topLeftCorner(n, n) = inertia;
  whole.topRightCorner(n, k) = -a.transpose();
  whole.bottomLeftCorner(k, n) = a;
  Vector right(n + k);
  right << change, row_rate;
  return Vector(whole.partialPivLu().solve(right)).head(n);
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
    const Matrix here = a * carry * units_.asDiagonal();
    const Matrix square = dense::inverse(here * here.transpose());
    onto = here.transpose() * square * here;
    drift = here.transpose() * square * b;
  }
  const Matrix own = carry * units_.asDiagonal();  // to own units
  const Matrix inertia_back = own.transpose() * inertia * own;
  const Vector force_back = own.transpose() * force;
  Vector out(2 * n * n + 2 * n + holonomic_rows());
  out << inertia_back.reshaped(), onto.reshaped(), force_back, drift, phi;
  return out;
}

// Inertia, span of the rows, force, drift, phi, each beside its largest value; a force also beside
// a part of the kinetic energy, which is what its round-off is, phi beside its own slopes.
void Flow::scale_blocks(const Vector& value, const Vector& velocity, Matrix& change) const {
  const int n = dim();
  const auto inertia = value.head(n * n);
  const double rate = velocity.cwiseQuotient(units_).squaredNorm();
  const auto scale = [&](Eigen::Index from, Eigen::Index count, double size) {
    if (count > 0 && size > 0) change.middleRows(from, count) /= size;
  };
  const auto largest = [&](Eigen::Index from, Eigen::Index count) {
    return count > 0 ? value.segment(from, count).lpNorm<Eigen::Infinity>() : 0.0;
  };
  const Eigen::Index force = 2 * n * n, drift = force + n, phi = drift + n;
  scale(0, n * n, largest(0, n * n));
  scale(n * n, n * n, largest(n * n, n * n));
  scale(force, n, std::max(largest(force, n), 1e-4 * inertia.lpNorm<Eigen::Infinity>() * rate));
  scale(drift, n, largest(drift, n));
  if (holonomic_rows() > 0)
    scale(phi, holonomic_rows(), change.bottomRows(holonomic_rows()).lpNorm<Eigen::Infinity>());
}

Matrix Flow::changes_by_differences(const Vector& g, const Vector& xi, const Matrix& back,
                                    const Vector& speeds) const {
  const int n = dim();
  Matrix out(2 * n * n + 2 * n + holonomic_rows(), 2 * n);
  for (int j = 0; j < 2 * n; ++j) {
    const Vector eta = j < n ? Vector::Zero(n) : Vector(Vector::Unit(n, j - n));
    const Vector delta = j < n ? Vector(back.col(j)) : eta;
    Vector slope = Vector::Zero(out.rows());
    differentiate(1 / speeds[j], [&](double e, double weight) {
      slope += weight * kept(moved(g, e * delta), xi, eta, e);
    });
    out.col(j) = slope;
  }
  return out;
}

// With H = A U, U the units, P = H^+ H, in place of the force ad*_xi I xi + F - (dI/dt) xi, which
// is kept with the inertia where F is: along (delta, -ad_eta xi), with the terms moved by -ad_eta,
//   dP = M + M^T,  M = H^+ dH (1 - P),   d(H^+ b) = H^+ (db - dH H^+ b) + (1 - P) dH^T (H H^T)^-1 b.
Matrix Flow::changes_of_formulas(const Vector& g, const Vector& xi, const Matrix& back,
                                 Vector& value) const {
  const int n = dim(), k = constraint_count(), held = holonomic_rows();
  const MotionValues here = recorded_->at(g, xi);
  const Matrix units = units_.asDiagonal(), h = here.rows * units;
  const Matrix square = k > 0 ? dense::inverse(h * h.transpose()) : Matrix(0, 0);
  const Matrix inverse = h.transpose() * square, onto = inverse * h,
               off = Matrix::Identity(n, n) - onto;
  const Vector drift = inverse * here.drift;
  Matrix directions = Matrix::Zero(2 * n, 2 * n);
  directions.topLeftCorner(n, n) = back;
  directions.topRightCorner(n, n).setIdentity();
  directions.bottomRightCorner(n, n) = ad(xi);  // -ad_eta xi = ad_xi eta
  const std::vector<MotionValues> slopes = recorded_->along(g, xi, directions);
  Vector phi(held);
  mechanics_->holonomic(g.data(), phi);
  value.resize(2 * n * n + 2 * n + held);
  value << Matrix(units * here.inertia * units).reshaped(), onto.reshaped(), units * here.change,
      drift, phi;
  Matrix out(value.size(), 2 * n);
  for (int j = 0; j < 2 * n; ++j) {
    const MotionValues& d = slopes[static_cast<size_t>(j)];
    const Matrix turn = j < n ? Matrix::Zero(n, n) : ad(Vector::Unit(n, j - n));
    const Matrix inertia =
        units * (d.inertia - turn.transpose() * here.inertia - here.inertia * turn) * units;
    const Matrix dh = (d.rows - here.rows * turn) * units, m = inverse * dh * off;
    const Vector change = units * (d.change - turn.transpose() * here.change);
    const Vector moved_drift =
        inverse * (d.drift - dh * drift) + off * dh.transpose() * (square * here.drift);
    out.col(j) << inertia.reshaped(), (m + m.transpose()).reshaped(), change, moved_drift,
        here.rows.bottomRows(held) * directions.col(j).head(n);
  }
  return out;
}

Matrix Flow::symmetries(const Vector& g, const Vector& xi, const Vector& reach) const {
  const int n = dim();
  Matrix changes(0, 2 * n), orbits(0, 2 * n);
  Vector sizes;  // of the columns: what moves g by the reach at the first place
  // Places at random within the reach of the equations, and nearer.
  for (int sample = 1; sample <= 5; ++sample) {
    const double part = sample <= 3 ? 1 : 0x1p-4;
    Vector shift(n), velocity(n);
    for (int i = 0; i < n; ++i) {
      shift[i] = 0.3 * part * reach[i] * std::sin(12.9898 * (i + 1) + 78.233 * sample);
      velocity[i] = xi[i] + part * reach[n + i] * std::sin(39.346 * (i + 1) + 11.135 * sample);
    }
    const Vector here = moved(g, shift);
    const Matrix back = Ad_inverse(here);
    Vector speeds(2 * n);
    for (int j = 0; j < 2 * n; ++j) {
      const Vector delta = j < n ? Vector(back.col(j)) : Vector(Vector::Unit(n, j - n));
      speeds[j] = delta.cwiseQuotient(part * reach.head(n)).lpNorm<Eigen::Infinity>();
    }
    Vector value;
    Matrix change;
    if (recorded_ != nullptr) {
      change = changes_of_formulas(here, velocity, back, value);
    } else {
      value = kept(here, velocity, Vector::Zero(n), 0);
      change = changes_by_differences(here, velocity, back, speeds);
    }
    if (sizes.size() == 0) sizes = speeds.cwiseInverse();
    change = change * sizes.asDiagonal();
    scale_blocks(value, velocity, change);
    changes.conservativeResize(changes.rows() + change.rows(), Eigen::NoChange);
    changes.bottomRows(change.rows()) = change;
    orbits.conservativeResize(orbits.rows() + 2 * n, Eigen::NoChange);
    Matrix moves = orbit(Matrix(sizes.asDiagonal()), here, velocity);
    const Vector own = velocity.cwiseQuotient(units_);
    moves.topRows(n) = units_.cwiseInverse().asDiagonal() * moves.topRows(n);
    moves.bottomRows(n) =
        (units_ * std::max(1e-300, own.norm())).cwiseInverse().asDiagonal() * moves.bottomRows(n);
    orbits.bottomRows(2 * n) = moves;
  }
  Matrix all = kernel_of(changes, 1e-9, 1);
  all = (all * range_of((orbits * all).transpose(), 1e-9, 1)).eval();
  return sizes.asDiagonal() * all;
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
