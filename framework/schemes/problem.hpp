// A left-invariant nonholonomic system as the schemes see it: an inertia and a Hamel frame.
//
//   l(xi) = 1/2 xi^T I xi,   d = ker A,   E: n x m, columns an I-orthonormal basis of d.
// Coordinates on d are y = E^T I xi, and on its dual mu_bar = E^T mu; since E^T I E = Id, y = mu_bar.
#pragma once

#include <hamel/framework/lie/concepts.hpp>

namespace hamel {

/// The dimension of a frame that is known only at run time (at most the group's).
inline constexpr int kRunTime = Eigen::Dynamic;

/// m is fixed at compile time (M >= 1) or chosen at run time (M = kRunTime, still without heap).
template <class G, int M>
struct LeftInvariant {
  using Group = G;
  static constexpr int n = G::dim;
  static constexpr int m_at_compile_time = M;
  static constexpr int max_m = M == kRunTime ? n : M;
  using Reduced = Eigen::Matrix<double, M, 1, 0, max_m, 1>;  // y, mu_bar
  using ReducedMatrix = Eigen::Matrix<double, M, M, 0, max_m, max_m>;
  using Frame = Eigen::Matrix<double, n, M, n == 1 ? Eigen::RowMajor : 0, n, max_m>;

  Frame frame;           // E
  Frame momentum_frame;  // I E

  LeftInvariant(const Mat<n, n>& inertia, const Frame& e) : frame(e), momentum_frame(inertia * e) {}

  int m() const { return static_cast<int>(frame.cols()); }
  /// E y: from coordinates on d to the algebra.
  Vec<n> velocity(const Reduced& y) const { return frame.lazyProduct(y); }
  /// I E y: pi^* of the paper, from d* into the dual of the algebra.
  Vec<n> momentum(const Reduced& y) const { return momentum_frame.lazyProduct(y); }
  /// E^T mu: iota^*, from the dual of the algebra onto d*.
  Reduced reduce(const Vec<n>& mu) const { return frame.transpose().lazyProduct(mu); }
  /// E^T B E for an n x n matrix B.
  ReducedMatrix reduce_both(const Mat<n, n>& b) const {
    const Frame be = b.lazyProduct(frame);
    return frame.transpose().lazyProduct(be);
  }
  /// E^T B (I E).
  ReducedMatrix reduce_momentum(const Mat<n, n>& b) const {
    const Frame be = b.lazyProduct(momentum_frame);
    return frame.transpose().lazyProduct(be);
  }
  /// E^T B^T (I E).
  ReducedMatrix reduce_momentum_transposed(const Mat<n, n>& b) const {
    const Frame be = b.lazyProduct(frame);
    return be.transpose().lazyProduct(momentum_frame);
  }
};

}  // namespace hamel
