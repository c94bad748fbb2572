// inverse: J^-1 as Newton's method keeps it (newton.hpp), and Broyden's update of it.
#pragma once

#include <type_traits>

#include <Eigen/LU>

#include <hamel/framework/lie/linear_solve.hpp>

namespace hamel {

/// J^-1: in closed form up to 4 x 4, as a matrix up to 16 x 16 (it only steers, and is used many
/// times), by LU beyond; there it is 1 until it is computed.
template <class Jacobian>
class Inverse {
  static constexpr int size = Jacobian::RowsAtCompileTime;
  static constexpr bool closed_form = size != Eigen::Dynamic && size <= 4;
  static constexpr bool may_be_large = size == Eigen::Dynamic || size > 16;

 public:
  static constexpr bool is_large(Eigen::Index n) { return may_be_large && n > 16; }
  bool is_one() const { return one_; }
  /// J^-1, in closed form or as a matrix.
  const Jacobian& matrix() const { return inverse_; }
  void set_one() { one_ = true; }
  void compute(const Jacobian& jacobian) {
    one_ = false;
    if constexpr (size == 0) {
      return;
    } else if constexpr (closed_form) {
      inverse_ = jacobian.inverse();
    } else if (const int n = static_cast<int>(jacobian.rows()); n <= 16) {
      inverse_.setIdentity(n, n);
      work_ = jacobian;
      solve_linear(work_.data(), inverse_.data(), n, n);
    } else if constexpr (may_be_large) {
      lu_.compute(jacobian);
    }
  }
  /// Broyden's update behind a correction c = J^-1 f that has left f_1 (Kelley 2003, ch. 4): the
  /// change of J along c that makes F(x - c) what it was found to be. With c_1 = J^-1 f_1
  ///   J^-1 <- J^-1 + c_1 (J^-T c)^T / c.(c - c_1).
  /// No update where that is ill-conditioned. Not of a large J.
  template <class Vector>
  void update(const Vector& c, const Vector& f_1) {
    constexpr int most = size == Eigen::Dynamic ? 16 : size;
    Eigen::Matrix<double, size, 1, 0, most, 1> c_1(c.size());
    multiply(inverse_, f_1, c_1);
    const double square = c.squaredNorm(), along = square - c.dot(c_1);
    if (!(along > 0.3 * square)) return;
    add_along(c.data(), c_1.data(), 1 / along, inverse_.data(), static_cast<int>(c.size()));
  }
  template <class Vector>
  void solve(const Vector& f, Vector& out) const {
    if constexpr (may_be_large) {
      if (is_large(f.size())) {
        if (one_) out = f;
        else out = lu_.solve(f);
        return;
      }
    }
    multiply(inverse_, f, out);
  }

 private:
  struct Nothing {};
  Jacobian inverse_;
  [[no_unique_address]] std::conditional_t<closed_form, Nothing, Jacobian> work_;
  [[no_unique_address]] std::conditional_t<may_be_large, Eigen::PartialPivLU<Jacobian>, Nothing>
      lu_;
  bool one_ = true;
};

}  // namespace hamel
