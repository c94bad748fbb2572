// A system in its own C++ type on its group with a retraction: sizes fixed, nothing virtual.
#pragma once

#include <memory>

#include <hamel/framework/lie/group_operations.hpp>
#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/framework/mechanics/place.hpp>

namespace hamel {

/// A problem of fixed sizes with nothing to bind it.
template <class P>
class WithoutRows : public P {
 public:
  using Rows = Mat<0, P::n>;
  using Few = Vec<0>;
  using Held = Vec<0>;
  using Place = hamel::Place<P::n, 0>;
  explicit WithoutRows(const P& problem) : P(problem) {}
  static constexpr int rows() { return 0; }
  static constexpr int held() { return 0; }
  static constexpr bool constant_constraints() { return true; }
  static void constraints(double /*t*/, const typename P::Element& /*g*/, Rows& /*a*/, Few& /*b*/) {
  }
  static void holonomic(const typename P::Element& /*g*/, Held& /*phi*/) {}
};

template <class System, class Tau>
class Typed : public GroupOperations<Tau> {
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
  using Rows = Mat<k, n>;
  using Few = Vec<k>;
  using Held = Vec<r>;
  using Place = hamel::Place<n, k>;
  using Unconstrained = WithoutRows<Typed>;

  /// mechanics: the TypedMechanics of a System.
  template <class Geometry>
  Typed(const std::shared_ptr<const Geometry>& /*geometry*/,
        const std::shared_ptr<const Mechanics>& mechanics)
      : owner_(mechanics),
        formulas_(&static_cast<const TypedMechanics<System>&>(*mechanics).formulas()) {}

  Unconstrained unconstrained() const { return Unconstrained(*this); }

  static constexpr int rows() { return k; }
  static constexpr int held() { return r; }
  static constexpr int state_size() { return n; }
  static constexpr bool constant_inertia() { return F::constant_inertia(); }
  static constexpr bool constant_constraints() { return F::constant_constraints(); }
  static constexpr bool has_dual_rates() { return F::has_dual_rates(); }
  static constexpr bool autonomous() { return is_autonomous<System>(); }

  static void velocity(const State& x, Vector& xi) { xi = x; }
  static void carry(const Vector& xi, State& x) { x = xi; }
  static void momentum(const Matrix& inertia, const State& x, Vector& mu) {
    mu = inertia.lazyProduct(x);
  }

  void inertia(const Element& g, Matrix& out) const { formulas_->inertia(g, out); }
  void constraints(double t, const Element& g, Rows& a, Few& b) const {
    formulas_->constraints(t, g, a, b);
  }
  void holonomic(const Element& g, Held& phi) const { formulas_->holonomic(g, phi); }
  void force(double t, const Element& g, const Vector& xi, Vector& out) const {
    formulas_->force(t, g, xi, out);
  }
  void inertial_force(const Element& g, const Vector& xi, Vector& out) const {
    formulas_->inertial_force(g, xi, out);
  }
  static constexpr bool force_depends_on_velocity() { return has_force<System>(); }
  double potential(const Element& g) const { return formulas_->potential(g); }
  /// A and I with dA/dt and dI/dt along g tau(e xi), by one dual number (where has_dual_rates()).
  void dual_rates(const Element& g, const Vector& xi, Rows& a, Rows& a_rate, Matrix& inertia,
                  Matrix& inertia_rate) const {
    using Dual = typename F::Dual;
    if constexpr (requires { Group::template along<Dual>(g, xi); }) {
      formulas_->dual_rates(Group::template along<Dual>(g, xi), a, a_rate, inertia, inertia_rate);
    } else {
      VecT<Dual, n> eta;
      for (int i = 0; i < n; ++i) {
        eta[i].a = 0;
        eta[i].v[0] = xi[i];
      }
      formulas_->dual_rates(Group::compose(constant_element<Dual, Group>(g), Tau::tau(eta)), a,
                            a_rate, inertia, inertia_rate);
    }
  }

 private:
  std::shared_ptr<const Mechanics> owner_;
  const F* formulas_;
};

}  // namespace hamel
