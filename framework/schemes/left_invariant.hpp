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

/// T: a number, or one in each lane (lanes/lane.hpp), each lane a body of its own.
template <class Group_, int M, class Tau, class T = double>
class LeftInvariant : public GroupOperations<Tau, T> {
 public:
  using Group = Group_;
  static constexpr bool left_invariant = true;
  /// Steps state their Jacobians in closed form; on larger groups differences spare a minute of
  /// compilation, but where the Hamel form has it (hamel_form.hpp).
  static constexpr bool has_jacobians =
      Group::dim <= 3 || (M == 2 && requires { requires Tau::quadratic_weight_is_one; });
  static constexpr int n = Group::dim, m = M, k = n - M;
  using typename GroupOperations<Tau, T>::Element;
  /// The same problem over other numbers.
  template <class Other>
  using Over = LeftInvariant<Group, M, Tau, Other>;
  using Vector = VecT<T, n>;
  using Matrix = MatT<T, n, n>;
  using State = VecT<T, M>;  // y
  using StateMatrix = MatT<T, M, M>;
  using TwoStates = VecT<T, 2 * M>;
  using TwoStatesMatrix = MatT<T, 2 * M, 2 * M>;
  using ConstraintMatrix = MatT<T, k, n>;
  using Multipliers = VecT<T, k>;
  using HolonomicValues = VecT<T, 0>;
  using Frame = MatT<T, n, M>;
  /// The same body with nothing to bind it.
  using Unconstrained = LeftInvariant<Group, n, Tau, T>;

  /// mechanics: of dimension n with k rows, left-invariant.
  template <class Geometry>
  LeftInvariant(const std::shared_ptr<const Geometry>& /*geometry*/,
                const std::shared_ptr<const Mechanics>& mechanics) {
    Eigen::MatrixXd inertia(n, n), rows(mechanics->constraint_count(), n);
    Eigen::VectorXd none(mechanics->constraint_count());
    mechanics->inertia(nullptr, inertia);
    mechanics->constraints(0, nullptr, rows, none);
    inertia_ = inertia;
    rows_ = rows.topRows(k);
    set_frame();
  }
  LeftInvariant(const Matrix& inertia, const ConstraintMatrix& rows)
      : inertia_(inertia), rows_(rows) {
    set_frame();
  }
  /// That of bodies in lanes: each(member, out) joins the numbers of a member over them.
  template <class Each>
  explicit LeftInvariant(const Each& each) requires(!std::is_same_v<T, double>) {
    each(&One::inertia_, inertia_);
    each(&One::rows_, rows_);
    each(&One::frame_, frame_);
    each(&One::momentum_frame_, momentum_frame_);
    each(&One::gamma_, gamma_);
  }
  Unconstrained unconstrained() const { return {inertia_, MatT<T, 0, n>()}; }

  static constexpr int constraint_count() { return k; }
  static constexpr int holonomic_rows() { return 0; }
  static constexpr int state_size() { return M; }
  static constexpr bool constant_inertia() { return true; }
  static constexpr bool constant_constraints() { return true; }

  const Frame& frame() const { return frame_; }
  /// xi = E y; y = (I E)^T xi; I xi = I E y.
  void velocity(const State& y, Vector& xi) const { xi = frame_.lazyProduct(y); }
  void to_state(const Vector& xi, State& y) const {
    y = momentum_frame_.transpose().lazyProduct(xi);
  }
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
  void constraints(double /*t*/, const Element& /*g*/, ConstraintMatrix& a, Multipliers& b) const {
    a = rows_;
    b.setZero();
  }
  void momentum_at(const Element& /*g*/, const Vector& xi, Vector& out,
                   Vector& inertial_force) const {
    out = inertia_.lazyProduct(xi);
    inertial_force.setZero();
  }
  void constraint_values(double /*t*/, const Element& /*g*/, const Vector& v,
                         Multipliers& out) const {
    out = rows_.lazyProduct(v);
  }
  static void holonomic(const Element& /*g*/, HolonomicValues& /*phi*/) {}
  static void applied_force(double /*t*/, const Element& /*g*/, const Vector& /*xi*/, Vector& out) {
    out.setZero();
  }
  static void force(double /*t*/, const Element& /*g*/, const Vector& /*xi*/, Vector& out) {
    out.setZero();
  }
  static void inertial_force(const Element& /*g*/, const Vector& /*xi*/, Vector& out) {
    out.setZero();
  }
  static constexpr bool force_depends_on_velocity() { return false; }
  static T potential(const Element& /*g*/) { return 0; }
  /// y' = E^T ad*_xi I xi, contracted: y'_c = sum_{a <= b} Gamma_c^{ab} y_a y_b.
  void acceleration(const State& y, State& rate) const {
    VecT<T, kPairs> products;
    for (int a = 0, i = 0; a < M; ++a) {
      for (int b = a; b < M; ++b) products[i++] = y[a] * y[b];
    }
    if constexpr (requires { T::width; }) {  // lanes: the order in which Eigen adds those of double
      rate = gamma_.col(0) * products[0];
      for (int i = 1; i < kPairs; ++i) rate += gamma_.col(i) * products[i];
    } else {
      rate = gamma_.lazyProduct(products);
    }
  }

  /// The frame, the same everywhere.
  class Metric {
   public:
    explicit Metric(const LeftInvariant& problem)
        : inertia(problem.inertia_), frame_(problem.frame_) {}
    Matrix inertia;
    void set(const LeftInvariant&, double, const Element&, bool /*same_frame*/ = false) {}
    void assemble(const Vector& r, const Multipliers& /*c*/, State& f) const {
      f = frame_.transpose().lazyProduct(r);
    }
    void admissible(const Vector& mu, State& y) const { y = frame_.transpose().lazyProduct(mu); }
    static T size(const State& y, const Vector& /*mu*/) { return y.norm(); }
    T size(const Vector& mu) const { return frame_.transpose().lazyProduct(mu).norm(); }

   private:
    Frame frame_;
  };

 private:
  using One = LeftInvariant<Group, M, Tau>;  // of one body
  template <class, int, class, class>
  friend class LeftInvariant;
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
  ConstraintMatrix rows_;
  Frame frame_, momentum_frame_;  // E, I E
  static constexpr int kPairs = M * (M + 1) / 2;
  MatT<T, M, kPairs> gamma_;
};

}  // namespace hamel
