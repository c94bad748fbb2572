// The symmetries of a flow: where the quantities that they keep do not change.
#include <algorithm>
#include <cmath>

#include <hamel/framework/analysis/reduced_flow.hpp>
#include <hamel/framework/lie/decompositions.hpp>

namespace hamel::reduced {

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
//   dP = M + M^T,   M = H^+ dH (1 - P),
//   d(H^+ b) = H^+ (db - dH H^+ b) + (1 - P) dH^T (H H^T)^-1 b.
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

}  // namespace hamel::reduced
