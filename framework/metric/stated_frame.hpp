// The frame of the admissible velocities that a system states (framed_equations.hpp), with the
// interface of Metric (metric.hpp).
//
// v = B(g) y: columns of E = [1; B], E^T I E = M = G G^T (Cholesky). The equations of a step are
// taken in the frame E G^-T, in which I is 1:
//   F(r, c) = (c_i / |D^-1/2 a_i|, G^-1 E^T r) = 0,   D = diag(I), a_i row i of A,              (*)
// and the velocity with A xi = c, G^-1 E^T I xi = z, A = [A_1 A_2], is
//   xi = (u, B u + w),   w = A_2^-1 c,   M u = G z - E^T I (0, w).
// A massless direction counts as the lightest other in D.
//
// This frame turns with the body, so that a Jacobian kept in it stays good for longer than in
// Metric or in one of Householder reflections: falling_disk at 10 m/s makes 2007 corrections in
// 2000 steps, where reflections make 4485 and Metric 7334.
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/LU>

#include <hamel/framework/mechanics/small_factors.hpp>

namespace hamel {

/// An inertia, and the units of (*).
template <int N>
class InertiaUnits {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  Eigen::Matrix<double, N, N> inertia;  // I

  /// The inertia was set.
  void set_weights() {
    diagonal_ = true;
    for (int j = 0; j < N; ++j) {
      if (!(inertia(j, j) > 0)) [[unlikely]]
        diagonal_ = false;
      weights_[j] = 1 / std::sqrt(diagonal_of_weights(j));
      for (int i = 0; i < N; ++i) diagonal_ = diagonal_ && (i == j || inertia(i, j) == 0);
    }
  }
  /// I xi.
  void momentum(const Vector& xi, Vector& out) const {
    if (diagonal_) out = inertia.diagonal().cwiseProduct(xi);
    else out = inertia.lazyProduct(xi);
  }
  /// D^-1/2 mu, in place: a momentum in the units of (*).
  void weigh(Vector& mu) const {
    for (int i = 0; i < N; ++i) mu[i] *= weights_[i];
  }
  /// |D^-1/2 mu|: its size there.
  template <class State>
  double size(const State& /*x*/, const Vector& mu) const {
    return size(mu);
  }
  double size(const Vector& mu) const {
    double sum = 0;
    for (int i = 0; i < N; ++i) sum += (weights_[i] * mu[i]) * (weights_[i] * mu[i]);
    return std::sqrt(sum);
  }

 protected:
  Vector weights_;  // D^-1/2
  bool diagonal_ = false;

 private:
  double diagonal_of_weights(int j) const { return inertia(j, j) > 0 ? inertia(j, j) : lightest(); }
  [[gnu::noinline, gnu::cold]] double lightest() const {
    double out = 0;
    for (int i = 0; i < N; ++i) {
      if (inertia(i, i) > 0 && (out == 0 || inertia(i, i) < out)) out = inertia(i, i);
    }
    return out;
  }
};

/// Of a system without a drift.
template <int N, int K>
class StatedFrame : public InertiaUnits<N> {
  using Units = InertiaUnits<N>;
  static constexpr int m = N - K;

 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Multipliers = Eigen::Matrix<double, K, 1>;
  using Units::inertia;
  Eigen::Matrix<double, K, N> a;        // A
  Multipliers b = Multipliers::Zero();  // the drift

  template <class System>
  explicit StatedFrame(const System& /*system*/) {}

  /// Everything at (t, g).
  template <class System, class Element>
  void set(const System& system, double t, const Element& g, bool /*same_frame*/ = false) {
    if (!known_ || !system.constant_inertia()) {
      system.inertia(g, inertia);
      Units::set_weights();
      known_ = true;
    }
    system.constraints(t, g, a, b);
    frame_ = system.frame(g);
    for (int j = 0; j < K; ++j) {
      double sum = 0;
      for (int i = 0; i < N; ++i) {
        const double entry = a(j, i) * Units::weights_[i];
        sum += entry * entry;
      }
      row_norms_[j] = std::sqrt(sum);
      row_weights_[j] = 1 / row_norms_[j];
    }
    reduce_inertia();
  }

  /// (*), into f, which may be r.
  void assemble(const Vector& r, const Multipliers& c, Vector& f) const {
    Reduced y = reduce(r);
    solve_lower(factor_, y);
    f.template head<K>() = c.cwiseProduct(row_weights_);
    f.template tail<m>() = y;
  }
  /// (c_i / |D^-1/2 a_i|, G^-1 E^T I dxi) -> dxi, in place; the last `places` rows move by h times
  /// a velocity.
  void expand(Vector& z, double h = 1, int places = 0) const {
    Multipliers c = z.template head<K>().cwiseProduct(row_norms_);
    for (int i = K - places; i < K; ++i) c[i] /= h;
    combine(c, z.template tail<m>(), z);
  }
  /// F(r, 0) of r = I xi, z the coordinates of xi.
  static void drop_reaction(Vector& z) { z.template head<K>().setZero(); }
  /// The admissible velocity of mu, refined once: the round-off of the factor is nearly the same in
  /// every step, and adds up (a disk turned back after 7 s returns 60 times as near).
  void admissible(const Vector& mu, Vector& xi) const {
    Reduced u = reduce(mu);
    solve(u);
    Vector first, left;
    first << u, frame_.lazyProduct(u);
    Units::momentum(first, left);
    left = mu - left;
    u = reduce(left);
    solve(u);
    xi << u, frame_.lazyProduct(u);
    xi += first;
  }

 private:
  using Reduced = Eigen::Matrix<double, m, 1>;

  // M, its factor G in the lower triangle, the inverses of G's diagonal on it; the last k rows of
  // I E.
  void reduce_inertia() {
    if (Units::diagonal_) {
      image_ = inertia.diagonal().template tail<K>().asDiagonal() * frame_;
      factor_ = frame_.transpose().lazyProduct(image_);
      factor_.diagonal() += inertia.diagonal().template head<m>();
    } else {
      const auto coupling = inertia.template bottomLeftCorner<K, m>();
      image_ = coupling + inertia.template bottomRightCorner<K, K>().lazyProduct(frame_);
      factor_ = inertia.template topLeftCorner<m, m>() + coupling.transpose().lazyProduct(frame_) +
                frame_.transpose().lazyProduct(image_);
    }
    factor_cholesky(factor_);
  }
  // E^T mu.
  Reduced reduce(const Vector& mu) const {
    return mu.template head<m>() + frame_.transpose().lazyProduct(mu.template tail<K>());
  }
  // y <- M^-1 y.
  void solve(Reduced& y) const {
    solve_lower(factor_, y);
    solve_upper(factor_, y);
  }
  // The velocity with A xi = c, G^-1 E^T I xi = z.
  template <class Out>
  void combine(const Multipliers& c, const Reduced& z, Out& xi) const {
    Reduced u = z;
    Multipliers w = Multipliers::Zero();
    if ((c.array() != 0).any()) {
      w = a.template rightCols<K>().inverse() * c;
      Reduced pull = image_.transpose().lazyProduct(w);
      solve_lower(factor_, pull);
      u -= pull;
    }
    solve_upper(factor_, u);
    w += frame_.lazyProduct(u);
    xi << u, w;
  }

  Eigen::Matrix<double, K, m> frame_, image_;  // B; the last k rows of I E
  Eigen::Matrix<double, m, m> factor_;
  Multipliers row_norms_, row_weights_;
  bool known_ = false;
};

}  // namespace hamel
