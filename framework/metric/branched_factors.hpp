// W with W^T W = I^-1, Y = W A^T and the factors of Y^T Y, of sizes known at run time only, along
// the branches of I.
//
// I = L^T L with L lower triangular, W = L^-T. In a tree of bodies whose links come after those
// that carry them, row i of L has entries only at the velocities on the way from i to the root, as
// I has: nothing fills in. They are found as L is, by looking: another order or a full I costs time
// alone. Source: Featherstone, Efficient factorization of the joint-space inertia matrix for
// branched kinematic trees, Int. J. Robotics Research 24 (2005).
#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

namespace hamel {

/// The work is done by functions of pointers, compiled once: Eigen's vectors stay in the caller's
/// code, whose flags may align them differently.
class BranchedFactors {
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;

 public:
  BranchedFactors(int n, int k);

  /// L. False where I is not definite.
  bool find_root(const Matrix& inertia) { return find_root(inertia.data()); }
  /// Y and the factors of Y^T Y.
  void find_rows(const Matrix& a) { find_rows(a.data()); }
  /// Is a row within 1/100 of a combination of those before? Y^T Y has lost four digits then.
  bool nearly_dependent() const { return nearly_dependent_; }

  /// W mu.
  void apply_root(const Vector& mu, Vector& out) const {
    out = mu;
    solve_transposed(out.data());
  }
  /// W^T v.
  void apply_root_transpose(const Vector& v, Vector& out) const {
    out = v;
    solve(out.data());
  }
  /// out = c - Y^T v.
  void subtract_rows(const Vector& c, const Vector& v, Vector& out) const {
    subtract_rows(c.data(), v.data(), out.data());
  }
  /// out = Y lambda.
  void find_reaction(const Vector& lambda, Vector& out) const {
    out.setZero();
    add_reaction(lambda.data(), out.data());
  }
  /// out += Y lambda.
  void add_reaction(const Vector& lambda, Vector& out) const {
    add_reaction(lambda.data(), out.data());
  }
  /// c <- (Y^T Y)^-1 c.
  void solve_gram(Vector& c) const { solve_gram(c.data()); }

 private:
  bool find_root(const double* inertia);
  void find_rows(const double* a);
  void solve_transposed(double* x) const;
  void solve(double* x) const;
  void subtract_rows(const double* c, const double* v, double* out) const;
  void add_reaction(const double* lambda, double* out) const;
  void solve_gram(double* c) const;

  struct Span {
    int begin, end;
    void join(Span other) {
      begin = std::min(begin, other.begin);
      end = std::max(end, other.end);
    }
  };
  static Span span_of(const double* row, int k);
  void factor_gram(int width);

  int n_, k_;
  bool nearly_dependent_ = false;
  std::vector<double> lower_;    // L by rows, but for its diagonal
  std::vector<double> inverse_;  // of its diagonal
  std::vector<int> runs_;  // of row i from i (n + 1) on: [begin, end) of entries that are not 0
  std::vector<int> run_count_;        // how many numbers these are
  std::vector<double> y_;             // Y by rows
  std::vector<Span> spans_;           // of a row of Y: but for these entries it is 0
  std::vector<double> gram_;          // L D L^T as in dense_factors.hpp, by rows
  mutable std::vector<double> sums_;  // work space
};

}  // namespace hamel
