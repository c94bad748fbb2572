// A left-invariant system with m fixed: one Hamel frame for all configurations.
//
//   l(xi) = 1/2 xi^T I xi,   d = ker A,   E: n x m, columns an I-orthonormal basis of d.
// Coordinates on d are y = E^T I xi, and on its dual mu_bar = E^T mu; since E^T I E = Id, y =
// mu_bar: a node carries y, and the equations of a step are E^T r = 0 (m numbers).
#pragma once

#include <memory>

#include <hamel/framework/lie/group_operations.hpp>
#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>

namespace hamel {

template <class Group_, int M, class Tau>
class LeftInvariant : public GroupOperations<Tau> {
 public:
  using Group = Group_;
  static constexpr bool left_invariant = true;
  /// Steps state their Jacobians in closed form; on larger groups differences spare a minute of
  /// compilation.
  static constexpr bool has_jacobians = Group::dim <= 3;
  static constexpr int n = Group::dim, m = M, k = n - M;
  using typename GroupOperations<Tau>::Element;
  using Vector = Vec<n>;
  using Matrix = Mat<n, n>;
  using State = Vec<M>;  // y
  using StateMatrix = Mat<M, M>;
  using TwoStates = Vec<2 * M>;
  using TwoStatesMatrix = Mat<2 * M, 2 * M>;
  using Rows = Mat<k, n>;
  using Few = Vec<k>;
  using Held = Vec<0>;
  using Frame = Mat<n, M>;
  /// The same body with nothing to bind it.
  using Unconstrained = LeftInvariant<Group, n, Tau>;

  /// mechanics: of dimension n with k rows, left-invariant.
  template <class Geometry>
  LeftInvariant(const std::shared_ptr<const Geometry>& /*geometry*/,
                const std::shared_ptr<const Mechanics>& mechanics) {
    Eigen::MatrixXd inertia(n, n), rows(mechanics->rows(), n);
    Eigen::VectorXd none(mechanics->rows());
    mechanics->inertia(nullptr, inertia);
    mechanics->constraints(0, nullptr, rows, none);
    inertia_ = inertia;
    rows_ = rows.topRows(k);
    set_frame();
  }
  LeftInvariant(const Matrix& inertia, const Rows& rows) : inertia_(inertia), rows_(rows) {
    set_frame();
  }
  Unconstrained unconstrained() const { return {inertia_, Mat<0, n>()}; }

  static constexpr int rows() { return k; }
  static constexpr int held() { return 0; }
  static constexpr int state_size() { return M; }
  static constexpr bool constant_inertia() { return true; }
  static constexpr bool constant_constraints() { return true; }

  const Frame& frame() const { return frame_; }
  /// xi = E y; y = (I E)^T xi; I xi = I E y.
  void velocity(const State& y, Vector& xi) const { xi = frame_.lazyProduct(y); }
  void carry(const Vector& xi, State& y) const { y = momentum_frame_.transpose().lazyProduct(xi); }
  void momentum(const Matrix& /*inertia*/, const State& y, Vector& mu) const {
    mu = momentum_frame_.lazyProduct(y);
  }
  /// iota^* mu = E^T mu.
  State reduce(const Vector& mu) const { return frame_.transpose().lazyProduct(mu); }
  /// E^T B E and E^T B I E for an n x n matrix B.
  StateMatrix reduce_both(const Matrix& b) const {
    const Frame be = b.lazyProduct(frame_);
    return frame_.transpose().lazyProduct(be);
  }
  StateMatrix reduce_momentum(const Matrix& b) const {
    const Frame be = b.lazyProduct(momentum_frame_);
    return frame_.transpose().lazyProduct(be);
  }

  void inertia(const Element& /*g*/, Matrix& out) const { out = inertia_; }
  void constraints(double /*t*/, const Element& /*g*/, Rows& a, Few& b) const {
    a = rows_;
    b.setZero();
  }
  static void holonomic(const Element& /*g*/, Held& /*phi*/) {}
  static void force(double /*t*/, const Element& /*g*/, const Vector& /*xi*/, Vector& out) {
    out.setZero();
  }
  static void inertial_force(const Element& /*g*/, const Vector& /*xi*/, Vector& out) {
    out.setZero();
  }
  static constexpr bool force_depends_on_velocity() { return false; }
  static double potential(const Element& /*g*/) { return 0; }
  /// y' = E^T ad*_xi I xi, contracted: y'_c = sum_{a <= b} Gamma_c^{ab} y_a y_b.
  void acceleration(const State& y, State& rate) const {
    Vec<kPairs> products;
    for (int a = 0, i = 0; a < M; ++a) {
      for (int b = a; b < M; ++b) products[i++] = y[a] * y[b];
    }
    rate = gamma_.lazyProduct(products);
  }

  /// The frame, the same everywhere.
  class Place {
   public:
    explicit Place(const LeftInvariant& problem)
        : inertia(problem.inertia_), frame_(problem.frame_) {}
    Matrix inertia;
    void set(const LeftInvariant&, double, const Element&, bool /*same_frame*/ = false) {}
    void join(const Vector& r, const Few& /*c*/, State& f) const {
      f = frame_.transpose().lazyProduct(r);
    }
    void admissible(const Vector& mu, State& y) const { y = frame_.transpose().lazyProduct(mu); }
    static double size(const State& y, const Vector& /*mu*/) { return y.norm(); }
    double size(const Vector& mu) const { return frame_.transpose().lazyProduct(mu).norm(); }

   private:
    Frame frame_;
  };

 private:
  void set_frame() {
    frame_ = hamel_frame(inertia_, rows_);
    momentum_frame_ = inertia_.lazyProduct(frame_);
    // E^T ad*_{E_a} I E_b + E^T ad*_{E_b} I E_a; half of it where a = b.
    for (int a = 0, i = 0; a < M; ++a) {
      for (int b = a; b < M; ++b, ++i) {
        const Vector x = frame_.col(a), z = frame_.col(b);
        const Vector ix = momentum_frame_.col(a), iz = momentum_frame_.col(b);
        const Vector half = Group::coad(iz) * x, other = Group::coad(ix) * z;
        gamma_.col(i) = reduce(a == b ? half : Vector(half + other));
      }
    }
  }

  Matrix inertia_;
  Rows rows_;
  Frame frame_, momentum_frame_;  // E, I E
  static constexpr int kPairs = M * (M + 1) / 2;
  Mat<M, kPairs> gamma_;
};

}  // namespace hamel
