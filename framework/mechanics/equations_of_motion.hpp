// The equations of motion: accelerations and reactions at an admissible (t, g, xi).
//
// Lagrange-d'Alembert with multipliers, d/dt along the motion:
//   I xi' = ad*_xi I xi + force - (dI/dt) xi + A^T lambda,   A xi' = db/dt - (dA/dt) xi.
// (dI/dt) xi and db/dt - (dA/dt) xi: by one dual number where the problem has its formulas over any
// scalar, its own where it has them (Mechanics::rates), else by differences along g tau(e xi) at t,
// and in t at g (lie/differences.hpp). A left-invariant problem has y' in closed form.
#pragma once

#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Core>

#include <hamel/framework/lie/differences.hpp>

namespace hamel {

template <class Problem>
class EquationsOfMotion {
 public:
  using Element = typename Problem::Element;
  using Vector = typename Problem::Vector;
  using State = typename Problem::State;
  using Few = typename Problem::Few;

  explicit EquationsOfMotion(const Problem& problem)
      : problem_(problem),
        acceleration_(problem.dim()),
        momentum_(problem.dim()),
        change_(problem.dim()),
        work_(problem.dim()),
        reaction_(problem.rows()),
        b_(problem.rows()),
        row_rate_(problem.rows()),
        time_rate_(b_),
        time_work_{b_, b_},
        momentum_rate_(problem.dim()),
        a_(problem.rows(), problem.dim()),
        a_rate_(Problem::Rows::Zero(problem.rows(), problem.dim())),
        moved_a_(a_),
        moved_b_(b_),
        inertia_(problem.dim(), problem.dim()),
        inertia_rate_(inertia_),
        moved_inertia_(inertia_),
        root_(problem.dim(), problem.dim()),
        y_(problem.dim(), problem.rows()),
        gram_(problem.rows(), problem.rows()),
        moved_(problem.element()) {}

  /// The rate of the carried velocity at an admissible (t, g, x).
  void operator()(double t, const Element& g, const State& x, State& rate) {
    if constexpr (Problem::left_invariant) {
      problem_.acceleration(x, rate);
    } else {
      solve(t, g, x);
      rate = acceleration_;
    }
  }
  /// xi' and lambda (k entries, N or N m as the rows have it) at (t, g, xi).
  void solve(double t, const Element& g, const Vector& xi) {
    if (has_dual_rates() && known_) {
      evaluate_with_rates(g, xi);
      factor(t, g);
    } else {
      set(t, g);
      find_rates(t, g, xi);
    }
    apply_inertia(xi, momentum_);
    problem_.force(t, g, xi, change_);
    if (!problem_.constant_inertia()) change_ -= momentum_rate_;
    problem_.ad_transpose(xi, momentum_, work_);
    change_ += work_;
    apply_root(change_, work_);
    if (problem_.rows() > 0) {
      reaction_ = row_rate_ - y_.transpose().lazyProduct(work_);
      solve_gram(reaction_);
      work_ += y_.lazyProduct(reaction_);
      if (singular_) reaction_ -= stiffness_ * row_rate_;
    }
    apply_root_transpose(work_, acceleration_);
  }
  /// What depends on (t, g) alone. With W^T W = I^-1 (W lower triangular), Y = W A^T and c = W
  /// change: Y^T Y lambda = db/dt - (dA/dt) xi - Y^T c,  xi' = W^T (c + Y lambda).
  void set(double t, const Element& g) {
    if (!known_ || !problem_.constant_inertia()) problem_.inertia(g, inertia_);
    if (problem_.rows() > 0 && (!known_ || !problem_.constant_constraints()))
      problem_.constraints(t, g, a_, b_);
    factor(t, g);
  }
  /// The smallest v in the metric I with A v = c, A and I those of the last set(); returns its
  /// size, v . I v.
  double smallest(const Few& c, Vector& v) {
    reaction_ = c;
    solve_gram(reaction_);
    work_ = y_.lazyProduct(reaction_);
    apply_root_transpose(work_, v);
    return work_.squaredNorm();
  }
  /// Moves xi onto A xi = b in the metric I (A, b, I those of the last set()); returns the squared
  /// sizes of what was added, and of xi.
  std::pair<double, double> project(Vector& xi) {
    apply_inertia(xi, momentum_);
    const double size = momentum_.dot(xi);
    if (problem_.rows() == 0) return {0, size};
    row_rate_ = b_ - a_.lazyProduct(xi);
    const double added = smallest(row_rate_, acceleration_);
    xi += acceleration_;
    return {added, size};
  }
  const Vector& acceleration() const { return acceleration_; }
  const Few& reaction() const { return reaction_; }

 private:
  static constexpr bool has_dual_rates() {
    if constexpr (requires { Problem::has_dual_rates(); }) return Problem::has_dual_rates();
    else return false;
  }
  // By one dual number; b is constant.
  void evaluate_with_rates(const Element& g, const Vector& xi) {
    if constexpr (has_dual_rates())
      problem_.dual_rates(g, xi, a_, a_rate_, inertia_, inertia_rate_);
    row_rate_ = -a_rate_.lazyProduct(xi);
    if (!problem_.constant_inertia()) momentum_rate_ = inertia_rate_.lazyProduct(xi);
  }
  // What follows from inertia_ and a_.
  void factor(double t, const Element& g) {
    const bool inertia_changes = !known_ || !problem_.constant_inertia();
    const bool rows_change = problem_.rows() > 0 && (!known_ || !problem_.constant_constraints());
    if (inertia_changes) find_root(inertia_);
    if (singular_) [[unlikely]]
      find_stiff_root(t, g);
    if (problem_.rows() == 0 || !(inertia_changes || rows_change)) return;
    for (int j = 0; j < problem_.rows(); ++j) {
      momentum_ = a_.row(j).transpose();
      apply_root(momentum_, work_);
      y_.col(j) = work_;
    }
    factor_gram();
  }
  void apply_inertia(const Vector& xi, Vector& mu) const {
    if (diagonal_) mu = inertia_.diagonal().cwiseProduct(xi);
    else mu = inertia_.lazyProduct(xi);
  }

  void find_rates(double t, const Element& g, const Vector& xi) {
    row_rate_.setZero();
    if (problem_.rows() == 0 && problem_.constant_inertia()) return;
    const bool moves = !problem_.constant_constraints(), varies = !problem_.constant_inertia();
    if (!moves && !varies) return;
    if constexpr (has_dual_rates()) return evaluate_with_rates(g, xi);
    if constexpr (requires { problem_.rates(t, g, xi, row_rate_, momentum_rate_); }) {
      if (problem_.rates(t, g, xi, row_rate_, momentum_rate_)) return;
    }
    row_rate_.setZero();
    momentum_rate_.setZero();
    // What A xi lacks of b.
    const auto lack = [&](double at, const Element& where) {
      problem_.constraints(at, where, moved_a_, moved_b_);
      moved_b_ -= moved_a_.lazyProduct(xi);
    };
    differentiate_along(problem_, g, xi, work_, moved_, [&](double, double weight) {
      if (moves) {
        lack(t, moved_);
        row_rate_ += weight * moved_b_;
      }
      if (varies) {
        problem_.inertia(moved_, moved_inertia_);
        momentum_rate_ += weight * moved_inertia_.lazyProduct(xi);
      }
    });
    if (!moves || autonomous()) return;
    differentiate_in_time(
        t,
        [&](double at) -> const Few& {
          lack(at, g);
          return moved_b_;
        },
        time_work_, time_rate_);
    row_rate_ += time_rate_;
  }
  bool autonomous() const {
    if constexpr (requires { problem_.autonomous(); }) return problem_.autonomous();
    else return true;
  }

  // root_ = W = L^-1, I = L L^T: rows of W from those above.
  void find_root(const typename Problem::Matrix& inertia) {
    known_ = true;
    singular_ = false;
    const int n = problem_.dim();
    diagonal_ = true;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) diagonal_ = diagonal_ && (i == j || inertia(i, j) == 0);
    }
    root_.setZero();
    if (diagonal_) {
      for (int i = 0; i < n; ++i) {
        singular_ = singular_ || !(inertia(i, i) > 0);
        root_(i, i) = 1 / std::sqrt(inertia(i, i));
      }
      return;
    }
    // w_i = (e_i - sum_{j<i} (w_j I e_i) w_j) / its length: Gram-Schmidt on e_i in the metric I,
    // row by row.
    for (int i = 0; i < n; ++i) {
      for (int l = 0; l <= i; ++l) work_[l] = l == i ? 1 : 0;
      for (int j = 0; j < i; ++j) {
        double product = 0;
        for (int l = 0; l <= j; ++l) product += root_(j, l) * inertia(l, i);
        for (int l = 0; l <= j; ++l) work_[l] -= product * root_(j, l);
      }
      double square = 0;
      for (int l = 0; l <= i; ++l) square += work_[l] * inertia(l, i);  // orthogonal to e_j, j < i
      singular_ = singular_ || !(square > 1e-14 * inertia(i, i));
      const double scale = 1 / std::sqrt(square);
      for (int l = 0; l <= i; ++l) root_(i, l) = scale * work_[l];
    }
  }
  // With massless links I is definite on ker A only. I + kappa A^T A has the same motions, as the
  // term it adds to the momentum is a reaction: (I + kappa A^T A) xi' = change + A^T (lambda +
  // kappa A xi').
  [[gnu::noinline, gnu::cold]] void find_stiff_root(double t, const Element& g) {
    problem_.constraints(t, g, a_, b_);
    stiffness_ = inertia_.trace() / a_.squaredNorm();
    const typename Problem::Matrix stiff = inertia_ + stiffness_ * a_.transpose().lazyProduct(a_);
    find_root(stiff);
    singular_ = true;
  }
  void apply_root(const Vector& mu, Vector& out) const {
    if (diagonal_) out = root_.diagonal().cwiseProduct(mu);
    else out = root_.lazyProduct(mu);
  }
  void apply_root_transpose(const Vector& v, Vector& out) const {
    if (diagonal_) out = root_.diagonal().cwiseProduct(v);
    else out = root_.transpose().lazyProduct(v);
  }
  // gram_: the Cholesky factor of Y^T Y.
  void factor_gram() {
    const int k = problem_.rows();
    for (int j = 0; j < k; ++j) {
      for (int i = j; i < k; ++i) {
        double sum = y_.col(i).dot(y_.col(j));
        for (int l = 0; l < j; ++l) sum -= gram_(i, l) * gram_(j, l);
        gram_(i, j) = i == j ? std::sqrt(sum) : sum / gram_(j, j);
      }
    }
  }
  // c <- (Y^T Y)^-1 c.
  void solve_gram(Few& c) const {
    const int k = problem_.rows();
    for (int i = 0; i < k; ++i) {
      for (int l = 0; l < i; ++l) c[i] -= gram_(i, l) * c[l];
      c[i] /= gram_(i, i);
    }
    for (int i = k - 1; i >= 0; --i) {
      for (int l = i + 1; l < k; ++l) c[i] -= gram_(l, i) * c[l];
      c[i] /= gram_(i, i);
    }
  }

  Problem problem_;
  bool known_ = false, diagonal_ = false, singular_ = false;
  double stiffness_ = 0;
  Vector acceleration_, momentum_, change_, work_;
  Few reaction_, b_, row_rate_, time_rate_;  // row_rate_: of b - A xi at constant xi
  std::array<Few, 2> time_work_;
  Vector momentum_rate_;  // of I xi at constant xi
  typename Problem::Rows a_, a_rate_, moved_a_;
  Few moved_b_;
  typename Problem::Matrix inertia_, inertia_rate_, moved_inertia_, root_;
  Eigen::Matrix<double, Vector::RowsAtCompileTime, Few::RowsAtCompileTime> y_;
  Eigen::Matrix<double, Few::RowsAtCompileTime, Few::RowsAtCompileTime> gram_;
  Element moved_;
};

}  // namespace hamel
