// W with W^T W = I^-1, Y = W A^T and the factors of Y^T Y, of sizes known at compile time: all
// loops unroll.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include <hamel/framework/mechanics/small_factors.hpp>

namespace hamel {

template <int N, int K>
class DenseFactors {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Multipliers = Eigen::Matrix<double, K, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  DenseFactors(int /*n*/, int /*k*/) {}

  /// W = L^-1, I = L L^T: rows of W from those above. False where I is not definite.
  bool find_root(const Matrix& inertia) {
    bool definite = true;
    diagonal_ = true;
    for (int j = 0; j < N; ++j) {
      for (int i = 0; i < N; ++i) diagonal_ = diagonal_ && (i == j || inertia(i, j) == 0);
    }
    root_.setZero();
    if (diagonal_) {
      for (int i = 0; i < N; ++i) {
        definite = definite && inertia(i, i) > 0;
        root_(i, i) = weights_[i] = 1 / std::sqrt(inertia(i, i));
      }
      return definite;
    }
    // w_i = (e_i - sum_{j<i} (w_j I e_i) w_j) / its length: Gram-Schmidt on e_i in the metric I,
    // row by row.
    Vector work;
    for (int i = 0; i < N; ++i) {
      for (int l = 0; l <= i; ++l) work[l] = l == i ? 1 : 0;
      for (int j = 0; j < i; ++j) {
        double product = 0;
        for (int l = 0; l <= j; ++l) product += root_(j, l) * inertia(l, i);
        for (int l = 0; l <= j; ++l) work[l] -= product * root_(j, l);
      }
      double square = 0;
      for (int l = 0; l <= i; ++l) square += work[l] * inertia(l, i);  // orthogonal to e_j, j < i
      definite = definite && square > 1e-14 * inertia(i, i);
      const double scale = 1 / std::sqrt(square);
      for (int l = 0; l <= i; ++l) root_(i, l) = scale * work[l];
    }
    return definite;
  }
  /// Y and the factors of Y^T Y; not a number where a row depends on those before.
  void find_rows(const Eigen::Matrix<double, K, N>& a) {
    if (diagonal_) y_ = weights_.asDiagonal() * a.transpose();
    else y_ = root_.lazyProduct(a.transpose());
#pragma GCC unroll 4
    for (int j = 0; j < K; ++j) {
#pragma GCC unroll 4
      for (int i = j; i < K; ++i) gram_(i, j) = y_.col(i).dot(y_.col(j));
    }
    const Multipliers squares = gram_.diagonal();
    factor_small(gram_);
    nearly_dependent_ = ((gram_.diagonal().array() * squares.array()) > kNearlyDependent).any();
  }
  /// Is a row within 1/100 of a combination of those before? Y^T Y has lost four digits then.
  bool nearly_dependent() const { return nearly_dependent_; }

  void apply_inertia(const Matrix& inertia, const Vector& xi, Vector& mu) const {
    if (diagonal_) mu = inertia.diagonal().cwiseProduct(xi);
    else mu = inertia.lazyProduct(xi);
  }
  /// W mu.
  void apply_root(const Vector& mu, Vector& out) const {
    if (diagonal_) out = weights_.cwiseProduct(mu);
    else out = root_.lazyProduct(mu);
  }
  /// W^T v.
  void apply_root_transpose(const Vector& v, Vector& out) const {
    if (diagonal_) out = weights_.cwiseProduct(v);
    else out = root_.transpose().lazyProduct(v);
  }
  /// out = c - Y^T v.
  void subtract_rows(const Multipliers& c, const Vector& v, Multipliers& out) const {
    out.noalias() = c - y_.transpose().lazyProduct(v);
  }
  /// out = Y lambda.
  void find_reaction(const Multipliers& lambda, Vector& out) const { out = y_.lazyProduct(lambda); }
  /// out += Y lambda.
  void add_reaction(const Multipliers& lambda, Vector& out) const { out += y_.lazyProduct(lambda); }
  /// c <- (Y^T Y)^-1 c.
  void solve_gram(Multipliers& c) const { solve_small(gram_, c); }

 private:
  static constexpr double kNearlyDependent = 1e4;  // of |y|^2 over a pivot
  bool diagonal_ = false, nearly_dependent_ = false;
  Vector weights_;  // the diagonal of W, where there is no more
  Matrix root_;     // W
  Eigen::Matrix<double, N, K> y_;
  Eigen::Matrix<double, K, K> gram_;
};

}  // namespace hamel
