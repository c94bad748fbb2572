// The frame of the admissible velocities that a system states (framed_equations.hpp), with the
// interface and the units of AdmissibleFrame (admissible_frame.hpp).
//
// v = B(g) y: columns of E = [1; B], E^T I E = M = G G^T (Cholesky). The equations of a step are
// taken in the frame E G^-T, in which I is 1 (in AdmissibleFrame D is):
//   (c_i / |D^-1/2 a_i|, G^-1 E^T r) = 0,                                                       (*)
// and the velocity with A xi = c, G^-1 E^T I xi = z, A = [A_1 A_2], is
//   xi = (u, B u + w),   w = A_2^-1 c,   M u = G z - E^T I (0, w).
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/LU>

#include <hamel/framework/mechanics/small_factors.hpp>
#include <hamel/framework/metric/admissible_frame.hpp>

namespace hamel {

/// Of a system without a drift.
template <int N, int K>
class StatedFrame : public InertiaUnits<N> {
  using Units = InertiaUnits<N>;
  static constexpr int m = N - K;

 public:
  using Z = Sized<N, K>;
  using Vector = typename Z::Vector;
  using Multipliers = typename Z::Multipliers;
  using Units::inertia;
  typename Z::ConstraintMatrix a;       // A
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
  /// (c_i / |D^-1/2 a_i|, G^-1 E^T I dxi) -> dxi, in place.
  void expand(double* z) const {
    Eigen::Map<Vector> out(z);
    combine(out.template head<K>().cwiseProduct(row_norms_), out.template tail<m>(), out);
  }
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

  typename Z::FewByReduced frame_, image_;  // B; the last k rows of I E
  typename Z::ReducedMatrix factor_;
  Multipliers row_norms_, row_weights_;
  bool known_ = false;
};

}  // namespace hamel
