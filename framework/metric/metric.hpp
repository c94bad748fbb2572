// Inertia and rows at one configuration: the one factorisation behind accelerations, multipliers,
// projections and the equation of a step.
//
//   I xi = mu + A^T lambda,   A xi = c                                                          (1)
// With W^T W = I^-1, Y = W A^T, xi = W^T z and v = W mu, (1) is z = v + Y lambda, Y^T z = c: z is
// nearest to v of all that Y^T maps to c,
//   z = F(mu, c) = v + Y lambda,   lambda = (Y^T Y)^-1 (c - Y^T v).                             (2)
//   - acceleration: mu the force, c the rate of the rows;  admissible velocity of mu: c = b;
//   - smallest velocity with A xi = c in the metric I: mu = 0, |z|^2 = xi . I xi;
//   - equation of a step: r (a momentum) is a reaction and c = 0 exactly where F(r, c) = 0, n
//     square roots of an energy, |F|^2 = |the part of v that no reaction has|^2 + |the smallest
//     velocity with A xi = c|^2. No basis of ker A is chosen: no pivots, no signs, and F turns as
//     smoothly as I and A do.
// A correction dxi = W^T dz moves r = I dxi and c = A dxi by W I W^T dz = dz and Y^T dz, hence F by
// dz: the Jacobian of a step in dz is 1 + O(h), and changes so little from step to step that it can
// be kept. Rows phi of positions move by h A dxi: dz + Y (Y^T Y)^-1 (S^-1 - 1) Y^T dz, S = diag(1,
// h), in place of dz.
//
// With massless links I is definite on ker A only. I + kappa A^T A has the same solutions, as the
// term that it adds to I xi is a reaction, with lambda + kappa c in place of lambda.
//
// W and the factors of Y^T Y: those of dense_factors.hpp, or where sizes are known at run time only
// of branched_factors.hpp. With more than 12 velocities a basis of ker A by elimination
// (run_time_frame.hpp) takes the place of (2), F in that basis: W amplifies the round-off of a
// momentum by the root of the condition of I, 4e4 of a chain of 200 bodies; and a train of trailers
// has a full I and a full Y^T Y of nearly its size, whose factors cost n^3, the elimination n^2.
// F is (M39) of framework/schemes/README.md.
#pragma once

#include <cmath>
#include <optional>
#include <type_traits>

#include <Eigen/Core>

#include <hamel/framework/lie/linear_solve.hpp>
#include <hamel/framework/metric/branched_factors.hpp>
#include <hamel/framework/metric/dense_factors.hpp>
#include <hamel/framework/metric/run_time_frame.hpp>

namespace hamel {

template <int N = Eigen::Dynamic, int K = Eigen::Dynamic>
class Metric {
  static constexpr bool fixed = N != Eigen::Dynamic;

 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  using ConstraintMatrix = Eigen::Matrix<double, K, N>;
  using Multipliers = Eigen::Matrix<double, K, 1>;
  Matrix inertia;      // I
  ConstraintMatrix a;  // A
  Multipliers b;

  Metric(int n, int k)
      : inertia(n, n),
        a(k, n),
        b(k),
        factors_(has_chain(n) ? 0 : n, has_chain(n) ? 0 : k),
        lambda_(Multipliers::Zero(k)),
        none_(Multipliers::Zero(k)),
        rows_(none_),
        first_(none_),
        so_far_(none_),
        work_(n),
        left_(n) {
    if constexpr (!fixed)
      if (has_chain(n)) chain_.emplace(n, k);
  }
  /// Any system with dim() and constraint_count(): Mechanics, or a problem of schemes/problem.hpp.
  template <class System>
  explicit Metric(const System& system) : Metric(system.dim(), system.constraint_count()) {}

  /// Everything at (t, g). same_frame: within one step, for the basis of long chains.
  template <class System, class Element>
  void set(const System& system, double t, const Element& g, bool same_frame = false) {
    const bool inertia_changes = !known_ || !system.constant_inertia();
    const bool rows_change = k() > 0 && (!known_ || !system.constant_constraints());
    if (inertia_changes) system.inertia(g, inertia);
    if (rows_change) system.constraints(t, g, a, b);
    factor(inertia_changes, rows_change, same_frame);
  }
  /// The members I and A that changed have been written.
  void factor(bool inertia_changes, bool rows_change, bool same_frame = false) {
    if (!inertia_changes && !rows_change) return;
    if constexpr (!fixed)
      if (chain_) chain_->set(inertia.data(), a.data(), same_frame && known_);
    if (!on_chain()) {
      if (inertia_changes) massless_ = !factors_.find_root(inertia);
      if (massless_) [[unlikely]]
        find_stiff_root();
      if (k() > 0) factors_.find_rows(a);
    }
    known_ = true;
  }
  bool known() const { return known_; }

  /// F(r, c), into f, which is not r.
  void assemble(const Vector& r, const Multipliers& c, Vector& f) {
    if constexpr (!fixed)
      if (chain_) return chain_->assemble(r.data(), c.data(), f.data());
    project(r, c, f);
  }
  /// dz -> dxi, in place; the last `places` rows move by h times a velocity.
  void expand(Vector& z, double h = 1, int places = 0) {
    if constexpr (!fixed)
      if (chain_) {
        for (int i = k() - places; i < k(); ++i) z[i] /= h;
        return chain_->expand(z.data());
      }
    work_ = z;
    if (places > 0) {
      factors_.subtract_rows(none_, work_, lambda_);
      lambda_.head(k() - places).setZero();
      lambda_ *= 1 - 1 / h;
      factors_.solve_gram(lambda_);
      factors_.add_reaction(lambda_, work_);
    }
    factors_.apply_root_transpose(work_, z);
  }
  /// z <- z - Y (Y^T Y)^-1 Y^T z: F(r, 0) of r = I W^T z.
  void drop_reaction(Vector& z) {
    if (k() == 0) return;
    if (on_chain()) {
      z.head(k()).setZero();
      return;
    }
    factors_.subtract_rows(none_, z, lambda_);
    factors_.solve_gram(lambda_);
    factors_.add_reaction(lambda_, z);
    if (factors_.nearly_dependent()) [[unlikely]]
      refine(none_, z);
  }
  /// The xi of (1). xi may be mu.
  void solve(const Vector& mu, const Multipliers& c, Vector& xi) {
    if constexpr (!fixed)
      if (chain_) return chain_->velocity(mu.data(), c.data(), xi.data());
    project(mu, c, work_);
    factors_.apply_root_transpose(work_, xi);
    if (massless_) [[unlikely]]
      lambda_ -= stiffness_ * c;
  }
  /// The lambda of (1), behind solve() with xi of mu.
  const Multipliers& multipliers([[maybe_unused]] const Vector& mu,
                                 [[maybe_unused]] const Vector& xi) {
    if constexpr (!fixed)
      if (chain_) {
        momentum(xi, work_);
        work_ -= mu;
        chain_->multipliers(work_.data(), lambda_.data());
        return lambda_;
      }
    return lambda_;
  }
  /// The admissible velocity of mu, A xi = b, refined once: Y^T Y squares the condition of the
  /// rows, and the round-off of its factors is nearly the same in every step. xi is not mu.
  void admissible(const Vector& mu, Vector& xi) {
    if (on_chain() || k() == 0) return solve(mu, b, xi);
    project(mu, b, work_);
    factors_.apply_root_transpose(work_, xi);
    if (massless_) [[unlikely]]
      lambda_ -= stiffness_ * b;
    first_ = lambda_;
    momentum(xi, left_);  // I xi = mu + A^T lambda but for round-off
    left_ = mu - left_;
    left_ += a.transpose().lazyProduct(first_);
    rows_ = b - a.lazyProduct(xi);
    project(left_, rows_, work_);
    factors_.apply_root_transpose(work_, left_);
    xi += left_;
    if (massless_) [[unlikely]]
      lambda_ -= stiffness_ * rows_;
    lambda_ += first_;
  }
  /// The smallest velocity with A xi = c; returns xi . I xi.
  double smallest(const Multipliers& c, Vector& xi) {
    if (on_chain()) {
      xi.setZero();
      solve(xi, c, xi);
      return square(xi);
    }
    lambda_ = c;
    factors_.solve_gram(lambda_);
    factors_.find_reaction(lambda_, work_);
    factors_.apply_root_transpose(work_, xi);
    return work_.squaredNorm();
  }

  /// I xi.
  void momentum(const Vector& xi, Vector& out) const {
    if constexpr (fixed) factors_.apply_inertia(inertia, xi, out);
    else multiply(inertia, xi, out);
  }
  /// xi . I xi.
  double square(const Vector& xi) {
    momentum(xi, work_);
    return work_.dot(xi);
  }
  /// W mu, in place: a momentum as square roots of an energy.
  void weigh(Vector& mu) {
    if constexpr (!fixed)
      if (chain_) return chain_->weigh(mu.data());
    factors_.apply_root(mu, work_);
    mu = work_;
  }
  /// |W mu|.
  template <class State>
  double size(const State& /*x*/, const Vector& mu) {
    return size(mu);
  }
  double size(const Vector& mu) {
    if constexpr (!fixed)
      if (chain_) return chain_->size(mu.data());
    factors_.apply_root(mu, work_);
    return work_.norm();
  }

 private:
  int k() const { return static_cast<int>(a.rows()); }
  static constexpr bool has_chain(int n) { return !fixed && n > 12; }
  bool on_chain() const {
    if constexpr (fixed) return false;
    else return chain_.has_value();
  }

  // (2), into z, which is not mu.
  void project(const Vector& mu, const Multipliers& c, Vector& z) {
    factors_.apply_root(mu, z);
    if (k() == 0) return;
    factors_.subtract_rows(c, z, lambda_);
    factors_.solve_gram(lambda_);
    factors_.add_reaction(lambda_, z);
    if (factors_.nearly_dependent()) [[unlikely]]
      refine(c, z);
  }
  // Y^T z = c to the round-off of z, as of an orthogonal basis: Y^T Y squares the condition of the
  // rows. Source: Bjorck, Stability analysis of the method of seminormal equations for linear least
  // squares problems, Linear Algebra Appl. 88/89 (1987).
  [[gnu::noinline, gnu::cold]] void refine(const Multipliers& c, Vector& z) {
    so_far_ = lambda_;
    factors_.subtract_rows(c, z, lambda_);
    factors_.solve_gram(lambda_);
    factors_.add_reaction(lambda_, z);
    lambda_ += so_far_;
  }
  [[gnu::noinline, gnu::cold]] void find_stiff_root() {
    stiffness_ = inertia.trace() / a.squaredNorm();
    const Matrix stiff = inertia + stiffness_ * a.transpose().lazyProduct(a);
    factors_.find_root(stiff);
  }

  struct NoChain {};
  using Factors = std::conditional_t<fixed, DenseFactors<N, K>, BranchedFactors>;
  Factors factors_;
  [[no_unique_address]] std::conditional_t<fixed, NoChain, std::optional<RunTimeFrame>> chain_;
  Multipliers lambda_, none_, rows_, first_, so_far_;
  Vector work_, left_;
  bool known_ = false, massless_ = false;
  double stiffness_ = 0;
};

}  // namespace hamel
