// Inertia and constraint at one configuration, and a frame of the admissible velocities there.
//
// With D = diag(I), a massless direction taken as the lightest other, and A D^-1/2 = [L 0] O^T, O
// the product of k Householder reflections, the last m = n - k columns of D^-1/2 O are E, a basis
// of ker A with E^T D E = 1. The equations of a step, E^T r = 0 (r a momentum) and c = 0 (k rows of
// velocities), are the n numbers
//   (c_i / |D^-1/2 a_i|, E^T r) = 0,   a_i row i of A,                                       (*)
// all of them square roots of an energy. The admissible velocity of a momentum mu is
//   xi = D^-1/2 O (L^-1 b, 0) + E y,   E^T I xi = E^T mu
// (A xi = b; I xi - mu is a reaction A^T lambda).
// The frame turns smoothly with the configuration. Corrections of a velocity are made in it too
// (expand): the Jacobian of a step is then 1 + O(h) (h instead of 1 for a holonomic row) and
// changes so little from step to step that it can be kept. E is that of (M5), (*) is (M39) of
// framework/schemes/README.md. Source: Golub, Van Loan, Matrix Computations, 5.1 (Householder).
// With sizes known at run time only, reflections take twice the instructions of the frame of
// run_time_frame.hpp, which is taken there.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include <hamel/framework/lie/linear_solve.hpp>
#include <hamel/framework/mechanics/small_factors.hpp>
#include <hamel/framework/metric/run_time_frame.hpp>

namespace hamel {

/// Vectors and matrices of n, k and m = n - k.
template <int N, int K>
struct Sized {
  static constexpr int M = N - K;
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  using ConstraintMatrix = Eigen::Matrix<double, K, N>;
  using Columns = Eigen::Matrix<double, N, K>;
  using Multipliers = Eigen::Matrix<double, K, 1>;
  using FewSquare = Eigen::Matrix<double, K, K>;
  using Frame = Eigen::Matrix<double, N, M>;
  using Reduced = Eigen::Matrix<double, M, 1>;
  using ReducedMatrix = Eigen::Matrix<double, M, M>;
  using FewByReduced = Eigen::Matrix<double, K, M>;
};

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

template <int N = Eigen::Dynamic, int K = Eigen::Dynamic>
class AdmissibleFrame : public InertiaUnits<N> {
  using Units = InertiaUnits<N>;
  using Units::diagonal_;
  using Units::weights_;

 public:
  using Z = Sized<N, K>;
  using Vector = typename Z::Vector;
  using Multipliers = typename Z::Multipliers;
  using Units::inertia;
  using Units::weigh;
  typename Z::ConstraintMatrix a;  // A
  Multipliers b;

  /// Any system with dim() and constraint_count(): Mechanics, or a problem of schemes/problem.hpp.
  template <class System>
  explicit AdmissibleFrame(const System& system)
      : a(system.constraint_count(), system.dim()),
        b(system.constraint_count()),
        signs_(Multipliers::Zero()) {}

  /// Everything at (t, g). same_frame: the reflections keep their signs, for calls within one step.
  template <class System, class Element>
  void set(const System& system, double t, const Element& g, bool same_frame = false) {
    const bool inertia_changes = !known_ || !system.constant_inertia();
    const bool rows_change = k() > 0 && (!known_ || !system.constant_constraints());
    if (inertia_changes) {
      system.inertia(g, inertia);
      Units::set_weights();
    }
    if (rows_change) system.constraints(t, g, a, b);
    if (inertia_changes || rows_change) {
      factor_rows(same_frame && known_);
      reduce_inertia();
    }
    known_ = true;
  }

  /// (*), into f, which may be r.
  void assemble(const Vector& r, const Multipliers& c, Vector& f) {
    reduce(r);
    for (int j = 0; j < k(); ++j) f[j] = c[j] * row_weights_[j];
    for (int j = 0; j < m(); ++j) f[k() + j] = y_[j];
  }
  void assemble(Vector& r, const Multipliers& c) { assemble(r, c, r); }
  /// The velocity with A xi = c, E^T I xi = E^T mu. xi may be mu.
  void velocity(const Vector& mu, const Multipliers& c, Vector& xi) {
    reduce(mu);
    combine(c, xi);
  }
  /// (c_i / |D^-1/2 a_i|, E^T I dxi) -> dxi, in place.
  void expand(double* z) {
    for (int j = 0; j < k(); ++j) few_[j] = z[j] / row_weights_[j];
    for (int j = 0; j < m(); ++j) y_[j] = z[k() + j];
    combine(few_, moved_);
    for (int i = 0; i < n(); ++i) z[i] = moved_[i];
  }
  /// The admissible velocity of mu: A xi = b.
  void admissible(const Vector& mu, Vector& xi) { velocity(mu, b, xi); }
  /// The lambda of a reaction A^T lambda.
  void multipliers(const Vector& reaction, Multipliers& lambda) {
    work_ = reaction;
    weigh(work_);
    for (int j = 0; j < k(); ++j) reflect(j, work_.data());
    for (int j = k() - 1; j >= 0; --j) {  // L^T lambda = the first k
      double sum = work_[j];
      for (int i = j + 1; i < k(); ++i) sum -= l_transposed_(j, i) * lambda[i];
      lambda[j] = sum * l_inverse_diagonal_[j];
    }
  }

 private:
  static constexpr int n() { return N; }
  static constexpr int k() { return K; }
  static constexpr int m() { return N - K; }

  static double dot(const double* x, const double* y, int count) {
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += x[i] * y[i];
    return sum;
  }
  static void add(double factor, const double* x, double* y, int count) {
    for (int i = 0; i < count; ++i) y[i] += factor * x[i];
  }

  // Column j of reflections_ is the vector of reflection j; its first j entries are 0.
  void factor_rows(bool keep_signs) {
    for (int i = 0; i < n(); ++i) {
      for (int j = 0; j < k(); ++j) reflections_(i, j) = a(j, i) * weights_[i];
    }
    for (int j = 0; j < k(); ++j) {
      row_weights_[j] = 1 / std::sqrt(dot(&reflections_(0, j), &reflections_(0, j), n()));
    }
    for (int j = 0; j < k(); ++j) {
      double* v = &reflections_(j, j);
      for (int i = 0; i < j; ++i) {
        l_transposed_(i, j) = reflections_(i, j);
        reflections_(i, j) = 0;
      }
      const double norm = std::sqrt(dot(&reflections_(0, j), &reflections_(0, j), n()));
      if (signs_[j] == 0) signs_[j] = v[0] < 0 ? -1 : 1;
      else if (!keep_signs && signs_[j] * v[0] < -0.1 * norm) signs_[j] = -signs_[j];
      const double diagonal = signs_[j] * norm;
      l_inverse_diagonal_[j] = -1 / diagonal;
      v[0] += diagonal;
      factors_[j] = 1 / (diagonal * v[0]);  // 2/|v|^2
      for (int l = j + 1; l < k(); ++l) reflect(j, &reflections_(0, l));
    }
  }
  // All loops have n rounds and unroll.
  void reflect(int j, double* y) const {
    const double* v = &reflections_(0, j);
    add(-factors_[j] * dot(v, y, n()), v, y, n());
  }
  // L^-1 c, to the first k entries.
  void impulses(const Multipliers& c, Vector& out) const {
    for (int j = 0; j < k(); ++j) {
      double sum = c[j];
      for (int i = 0; i < j; ++i) sum -= l_transposed_(i, j) * out[i];
      out[j] = sum * l_inverse_diagonal_[j];
    }
  }
  // The velocity with A xi = c, E^T I xi = y.
  void combine(const Multipliers& c, Vector& xi) {
    work_.setZero();
    bool moved = false;  // by c
    for (int j = 0; j < k(); ++j) moved = moved || c[j] != 0;
    if (moved) {
      impulses(c, work_);
      for (int j = k() - 1; j >= 0; --j) reflect(j, work_.data());
      weigh(work_);
      if (!diagonal_) {
        image_.noalias() = inertia.lazyProduct(work_);
        for (int j = 0; j < m(); ++j) y_[j] -= dot(&frame_(0, j), image_.data(), n());
      }
    }
    solve_reduced();
    xi = work_;
    for (int j = 0; j < m(); ++j) add(y_[j], &frame_(0, j), xi.data(), n());
  }
  // E, and E^T I E = G G^T: G in the lower triangle, the inverses of its diagonal on it.
  void reduce_inertia() {
    for (int j = 0; j < m(); ++j) {
      double* column = &frame_(0, j);
      for (int i = 0; i < n(); ++i) column[i] = i == k() + j ? 1 : 0;
      for (int i = k() - 1; i >= 0; --i) reflect(i, column);
      for (int i = 0; i < n(); ++i) column[i] *= weights_[i];
    }
    if (diagonal_) return;  // I = D: E^T I E = 1
    for (int j = 0; j < m(); ++j) {
      image_.setZero();
      for (int i = 0; i < n(); ++i) add(frame_(i, j), &inertia(0, i), image_.data(), n());
      for (int i = j; i < m(); ++i) {
        reduced_inertia_(i, j) = dot(&frame_(0, i), image_.data(), n());
      }
    }
    factor_cholesky(reduced_inertia_);
  }
  // y = E^T mu.
  void reduce(const Vector& mu) {
    for (int j = 0; j < m(); ++j) y_[j] = dot(&frame_(0, j), mu.data(), n());
  }
  // y <- (E^T I E)^-1 y.
  void solve_reduced() {
    if (diagonal_) return;
    solve_lower(reduced_inertia_, y_);
    solve_upper(reduced_inertia_, y_);
  }

  typename Z::Columns reflections_;
  typename Z::FewSquare l_transposed_;  // but for its diagonal
  Multipliers row_weights_, factors_, l_inverse_diagonal_, signs_;
  typename Z::Frame frame_;  // E
  typename Z::ReducedMatrix reduced_inertia_;
  Multipliers few_;
  Vector work_, image_, moved_;
  typename Z::Reduced y_;
  bool known_ = false;
};

/// Of sizes known at run time only.
template <>
class AdmissibleFrame<Eigen::Dynamic, Eigen::Dynamic> {
 public:
  using Vector = Eigen::VectorXd;
  using Multipliers = Eigen::VectorXd;
  Eigen::MatrixXd inertia, a;
  Multipliers b;

  template <class System>
  explicit AdmissibleFrame(const System& system)
      : inertia(system.dim(), system.dim()),
        a(system.constraint_count(), system.dim()),
        b(system.constraint_count()),
        frame_(system.dim(), system.constraint_count()) {}

  template <class System, class Element>
  void set(const System& system, double t, const Element& g, bool same_frame = false) {
    const bool inertia_changes = !known_ || !system.constant_inertia();
    const bool rows_change = b.size() > 0 && (!known_ || !system.constant_constraints());
    if (inertia_changes) system.inertia(g, inertia);
    if (rows_change) system.constraints(t, g, a, b);
    if (inertia_changes || rows_change) frame_.set(inertia.data(), a.data(), same_frame && known_);
    known_ = true;
  }
  void assemble(const Vector& r, const Multipliers& c, Vector& f) {
    frame_.assemble(r.data(), c.data(), f.data());
  }
  void assemble(Vector& r, const Multipliers& c) { assemble(r, c, r); }
  void weigh(Vector& mu) const { frame_.weigh(mu.data()); }
  void momentum(const Vector& xi, Vector& out) const { multiply(inertia, xi, out); }
  template <class State>
  double size(const State& /*x*/, const Vector& mu) const {
    return size(mu);
  }
  double size(const Vector& mu) const { return frame_.size(mu.data()); }
  void velocity(const Vector& mu, const Multipliers& c, Vector& xi) {
    xi.resize(mu.size());
    frame_.velocity(mu.data(), c.data(), xi.data());
  }
  void expand(double* z) { frame_.expand(z); }
  void admissible(const Vector& mu, Vector& xi) { velocity(mu, b, xi); }
  void multipliers(const Vector& reaction, Multipliers& lambda) {
    frame_.multipliers(reaction.data(), lambda.data());
  }

 private:
  RunTimeFrame frame_;
  bool known_ = false;
};

}  // namespace hamel
