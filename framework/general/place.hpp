// Inertia and constraint at one configuration, and what they make of momenta there.
//
// With Q = A I^-1 (k x n), S = A I^-1 A^T, W = A^T S^-1 (n x k): mu - W Q mu is the part of mu that
// no reaction A^T lambda can carry, and xi = I^-1 (mu - W (Q mu - b)) is the admissible velocity whose
// momentum differs from mu by a reaction alone: A xi = b, E^T I xi = E^T mu for every basis E of ker A.
// So the equations E^T r = 0 and c = 0 (k rows of velocities) are the one equation in R^n
//   r + W (c - Q r) = 0,                                                                    (*)
// with no basis to choose; both terms are momenta: S^-1 c is the impulse that would set c to zero.
#pragma once

#include <Eigen/Cholesky>

#include <hamel/framework/general/small.hpp>
#include <hamel/framework/mechanics.hpp>

namespace hamel {

/// Vectors and matrices of n, fixed or chosen at run time (N = Eigen::Dynamic), and of k <= n.
template <int N>
struct Sized {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, N, 0, N, N>;
  using Columns = Eigen::Matrix<double, N, Eigen::Dynamic, 0, N, N>;
  using Few = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, N, 1>;
  using FewSquare = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, N, N>;
};

template <int N>
class Place {
 public:
  using Z = Sized<N>;
  typename Z::Matrix inertia, inverse;  // I, I^-1
  typename Z::Rows a, q;                // A, Q
  typename Z::Columns w;                // W
  typename Z::Few b;
  typename Z::FewSquare s_inverse;  // S^-1

  explicit Place(const Mechanics& system)
      : inertia(system.dim(), system.dim()),
        inverse(system.dim(), system.dim()),
        a(system.rows(), system.dim()),
        q(system.rows(), system.dim()),
        w(system.dim(), system.rows()),
        b(system.rows()),
        s_inverse(system.rows(), system.rows()),
        few_(system.rows()) {}

  /// Everything at (t, g).
  void set(const Mechanics& system, double t, const double* g) {
    if (!inertia_known_ || !system.constant_inertia()) {
      system.inertia(g, inertia);
      inertia_factors_.compute(inertia);
      inverse.setIdentity();
      inertia_factors_.solveInPlace(inverse);
      inertia_known_ = true;
    }
    if (a.rows() == 0) return;
    system.constraints(t, g, a, b);
    q = a.lazyProduct(inverse);
    s_inverse = q.lazyProduct(a.transpose());
    invert_definite(s_inverse);
    w = a.transpose().lazyProduct(s_inverse);
  }

  /// (*): r + W (c - Q r), in place of r.
  void join(typename Z::Vector& r, const typename Z::Few& c) {
    const Eigen::Index k = a.rows(), n = N == Eigen::Dynamic ? r.size() : N;
    for (Eigen::Index i = 0; i < k; ++i) few_[i] = c[i];
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index i = 0; i < k; ++i) few_[i] -= q(i, j) * r[j];
    }
    for (Eigen::Index i = 0; i < k; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) r[j] += w(j, i) * few_[i];
    }
  }
  /// I^-1 (mu - W (Q mu - b)).
  void admissible(const typename Z::Vector& mu, typename Z::Vector& xi) {
    reduced_ = mu;
    join(reduced_, b);
    xi = inverse.lazyProduct(reduced_);
  }

 private:
  typename Z::Few few_;
  typename Z::Vector reduced_;
  Eigen::LLT<typename Z::Matrix> inertia_factors_;
  bool inertia_known_ = false;
};

}  // namespace hamel
