// A system in its own C++ type on its group with a retraction: sizes fixed, nothing virtual.
#pragma once

#include <memory>

#include <hamel/framework/lie/group_operations.hpp>
#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/framework/metric/metric.hpp>
#include <hamel/framework/metric/stated_frame.hpp>

namespace hamel {

/// A problem of fixed sizes with nothing to bind it.
template <class P>
class WithoutRows : public P {
 public:
  using ConstraintMatrix = Mat<0, P::n>;
  using Multipliers = Vec<0>;
  using HolonomicValues = Vec<0>;
  using Metric = hamel::Metric<P::n, 0>;
  using OfMotion = WithoutRows;
  static constexpr bool framed() { return false; }
  explicit WithoutRows(const P& problem) : P(problem) {}
  static constexpr int constraint_count() { return 0; }
  static constexpr int holonomic_rows() { return 0; }
  static constexpr bool constant_constraints() { return true; }
  static void constraints(double /*t*/, const typename P::Element& /*g*/, ConstraintMatrix& /*a*/,
                          Multipliers& /*b*/) {}
  static void constraint_values(double /*t*/, const typename P::Element& /*g*/,
                                const typename P::Vector& /*v*/, Multipliers& /*out*/) {}
  static void holonomic(const typename P::Element& /*g*/, HolonomicValues& /*phi*/) {}
};

template <class System, class Tau>
class StaticProblem : public GroupOperations<Tau> {
  using F = Formulas<System>;

 public:
  using Group = typename System::Group;
  static constexpr bool left_invariant = false;
  static constexpr int n = F::n, k = F::k, r = F::r;
  using typename GroupOperations<Tau>::Element;
  using Vector = Vec<n>;
  using Matrix = Mat<n, n>;
  using State = Vec<n>;  // xi
  using StateMatrix = Mat<n, n>;
  using TwoStates = Vec<2 * n>;
  using TwoStatesMatrix = Mat<2 * n, 2 * n>;
  using ConstraintMatrix = Mat<k, n>;
  using Multipliers = Vec<k>;
  using HolonomicValues = Vec<r>;
  using Metric = std::conditional_t<F::framed(), StatedFrame<n, k>, hamel::Metric<n, k>>;
  using Unconstrained = WithoutRows<StaticProblem>;
  /// Whose equations of motion are compiled: they are the same with every retraction.
  using OfMotion = StaticProblem<System, typename FirstOf<typename Group::Retractions>::type>;

  /// mechanics: the TypedMechanics of a System.
  template <class Geometry>
  StaticProblem(const std::shared_ptr<const Geometry>& /*geometry*/,
                const std::shared_ptr<const Mechanics>& mechanics)
      : owner_(mechanics),
        typed_(&static_cast<const TypedMechanics<System>&>(*mechanics)),
        formulas_(&typed_->formulas()) {}

  template <class Other>
  explicit StaticProblem(const StaticProblem<System, Other>& other)
      : owner_(other.owner_), typed_(other.typed_), formulas_(other.formulas_) {}

  Unconstrained unconstrained() const { return Unconstrained(*this); }

  static constexpr int constraint_count() { return k; }
  static constexpr int holonomic_rows() { return r; }
  static constexpr int state_size() { return n; }
  static constexpr bool constant_inertia() { return F::constant_inertia(); }
  static constexpr bool constant_constraints() { return F::constant_constraints(); }
  static constexpr bool has_dual_rates() { return F::has_dual_rates(); }
  static constexpr bool autonomous() { return is_autonomous<System>(); }

  static void velocity(const State& x, Vector& xi) { xi = x; }
  static void to_state(const Vector& xi, State& x) { x = xi; }
  static void momentum(const Matrix& inertia, const State& x, Vector& mu) {
    mu = inertia.lazyProduct(x);
  }

  void inertia(const Element& g, Matrix& out) const { formulas_->inertia(g, out); }
  void momentum_at(const Element& g, const Vector& xi, Vector& out, Vector& inertial_force) const {
    Matrix inertia;
    formulas_->inertia(g, inertia);
    out = inertia.lazyProduct(xi);
    formulas_->inertial_force(g, xi, inertial_force);
  }
  void constraints(double t, const Element& g, ConstraintMatrix& a, Multipliers& b) const {
    formulas_->constraints(t, g, a, b);
  }
  /// A v - b, but for the rows that are differentials.
  void constraint_values(double t, const Element& g, const Vector& v, Multipliers& out) const {
    out.setZero();
    formulas_->constraint_values(t, g, v, out);
  }
  void holonomic(const Element& g, HolonomicValues& phi) const { formulas_->holonomic(g, phi); }
  void force(double t, const Element& g, const Vector& xi, Vector& out) const {
    formulas_->force(t, g, xi, out);
  }
  void inertial_force(const Element& g, const Vector& xi, Vector& out) const {
    formulas_->inertial_force(g, xi, out);
  }
  void applied_force(double t, const Element& g, const Vector& xi, Vector& out) const {
    formulas_->applied_force(t, g, xi, out);
  }
  static constexpr bool force_depends_on_velocity() { return has_force<System>(); }
  double potential(const Element& g) const { return formulas_->potential(g); }
  /// A and I with the rates of b - A xi and I xi along g tau(e xi), by one dual number (where
  /// has_dual_rates()).
  void dual_rates(const Element& g, const Vector& xi, ConstraintMatrix& rows, Multipliers& row_rate,
                  Matrix& inertia, Vector& momentum_rate) const {
    using Dual = typename F::Dual;
    formulas_->dual_rates(element_along<Dual, Group>(g, xi), xi, rows, row_rate, inertia,
                          momentum_rate);
  }
  /// Does the system state a frame? Then xi = E(g) y of the first entries y of x, and its rate
  /// (framed_equations.hpp).
  static constexpr bool framed() { return F::framed(); }
  Mat<k, n - k> frame(const Element& g) const requires(F::framed()) { return formulas_->frame(g); }
  void expand(const Element& g, const State& x, Vector& xi) const {
    typed_->framed_equations().expand(*formulas_, g, x, xi);
  }
  void framed_motion(double t, const Element& g, const State& x, Vector& xi, State& rate) const {
    typed_->framed_equations()(*formulas_, t, g, x, xi, rate);
  }

 private:
  template <class, class>
  friend class StaticProblem;
  std::shared_ptr<const Mechanics> owner_;
  const TypedMechanics<System>* typed_;
  const F* formulas_;
};

}  // namespace hamel
