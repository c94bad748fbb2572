// The formulas of a system's struct, as it states them, with their differentials and their rates
// along a motion by automatic differentiation where it leaves them out (general_system.hpp).
#pragma once

#include <type_traits>
#include <utility>

#if __has_include(<ceres/jet.h>)
#include <ceres/jet.h>
#define HAMEL_HAS_JET 1
#else
#define HAMEL_HAS_JET 0
#endif

#include <hamel/framework/lie/group_operations.hpp>
#include <hamel/framework/lie/retraction_defaults.hpp>
#include <hamel/framework/mechanics/system_members.hpp>

namespace hamel {

/// An element over another scalar, its derivatives zero.
template <class T, class G>
typename G::template Element<T> constant_element(const typename G::template Element<double>& g) {
  if constexpr (requires { g.template cast<T>(); }) return g.template cast<T>();
  else return G::template constant<T>(g);
}

#if HAMEL_HAS_JET
/// The value and the left-trivialised differential, row i for entry i: d/de f(g tau(e eta)).
template <class G, class Function>
auto left_differential(const Function& f, const typename G::template Element<double>& g) {
  constexpr int n = G::dim;
  using Jet = ceres::Jet<double, n>;
  using Tau = typename FirstOf<typename G::Retractions>::type;
  VecT<Jet, n> eta;
  for (int i = 0; i < n; ++i) eta[i] = Jet(0.0, i);
  const auto moved = G::compose(constant_element<Jet, G>(g), Tau::tau(eta));
  const auto value = f(moved);
  if constexpr (requires { value.rows(); }) {
    constexpr int rows = std::decay_t<decltype(value)>::RowsAtCompileTime;
    Mat<rows, n> d;
    for (int i = 0; i < rows; ++i) d.row(i) = value[i].v.transpose();
    return d;
  } else {
    return Vec<n>(value.v);
  }
}

/// g with its derivative along xi, g tau(e xi), as dual numbers.
template <class Dual, class G>
typename G::template Element<Dual> element_along(const typename G::template Element<double>& g,
                                                 const Vec<G::dim>& xi) {
  if constexpr (requires { G::template along<Dual>(g, xi); }) {
    return G::template along<Dual>(g, xi);
  } else {
    using Tau = typename FirstOf<typename G::Retractions>::type;
    VecT<Dual, G::dim> eta;
    for (int i = 0; i < G::dim; ++i) {
      eta[i].a = 0;
      eta[i].v[0] = xi[i];
    }
    return G::compose(constant_element<Dual, G>(g), Tau::tau(eta));
  }
}
#endif

/// The formulas of a system's struct on elements of its type, with out-parameters.
template <class S>
class Formulas {
 public:
  using G = typename S::Group;
  using Element = typename G::template Element<double>;
  static constexpr int n = G::dim;
  static constexpr int r = holonomic_count<S>();
  static constexpr int own = constraint_count<S>();  // rows of A that are no differential
  static constexpr int k = own + r;

  explicit Formulas(const S& system) : system_(system) {}

  static constexpr bool constant_inertia() {
    return requires(const S& s) { s.inertia(); };
  }
  static constexpr bool constant_constraints() {
    constexpr bool rows = own == 0 || requires(const S& s) { s.constraints(); };
    return r == 0 && rows && (!has_drift<S>() || has_constant_drift<S>());
  }

  void inertia(const Element& g, Mat<n, n>& out) const { out = inertia_at(g); }
  void constraints(double t, const Element& g, Mat<k, n>& a, Vec<k>& b) const {
    b.setZero();
    if constexpr (own > 0) a.template topRows<own>() = rows(t, g);
    if constexpr (has_drift<S>()) b.template head<own>() = drift_of(system_, t, g);
    if constexpr (r > 0) a.template bottomRows<r>() = holonomic_differential(g);
  }
  /// A v - b of the rows that are no differentials.
  void constraint_values(double t, const Element& g, const Vec<n>& v, Vec<k>& out) const {
    if constexpr (own > 0) out.template head<own>() = rows(t, g).lazyProduct(v);
    if constexpr (has_drift<S>()) out.template head<own>() -= drift_of(system_, t, g);
  }
  void holonomic(const Element& g, Vec<r>& out) const {
    if constexpr (r > 0) out = system_.holonomic(g);
  }
  void force(double t, const Element& g, const Vec<n>& xi, Vec<n>& out) const {
    applied_force(t, g, xi, out);
    if constexpr (!constant_inertia()) out += inertia_differential(g, xi);
  }
  void applied_force(double t, const Element& g, const Vec<n>& xi, Vec<n>& out) const {
    out.setZero();
    if constexpr (has_potential<S>()) out -= potential_differential(g);
    if constexpr (has_force<S>()) out += force_of(system_, t, g, xi);
  }
  void inertial_force([[maybe_unused]] const Element& g, [[maybe_unused]] const Vec<n>& xi,
                      Vec<n>& out) const {
    if constexpr (constant_inertia()) out.setZero();
    else out = inertia_differential(g, xi);
  }
  double power(double t, const Element& g, const Vec<n>& xi) const {
    if constexpr (has_force<S>()) return Vec<n>(force_of(system_, t, g, xi)).dot(xi);
    else return 0;
  }
  double potential(const Element& g) const {
    if constexpr (has_potential<S>()) return system_.potential(g);
    else return 0;
  }

  // The differentials, by hand where the system gives them.
  Vec<n> potential_differential(const Element& g) const {
    if constexpr (requires { system_.potential_differential(g); }) {
      return system_.potential_differential(g);
    } else {
      static_assert(!named::potential_differential<S>,
                    "expected a const member potential_differential(g)");
      return automatic([this](const auto& x) { return system_.potential(x); }, g);
    }
  }
  Mat<r, n> holonomic_differential(const Element& g) const {
    if constexpr (requires { system_.holonomic_differential(g); }) {
      return system_.holonomic_differential(g);
    } else {
      static_assert(!named::holonomic_differential<S>,
                    "expected a const member holonomic_differential(g)");
      return automatic([this](const auto& x) { return system_.holonomic(x); }, g);
    }
  }
  Vec<n> inertia_differential(const Element& g, const Vec<n>& xi) const {
    if constexpr (requires { system_.inertia_differential(g, xi); }) {
      return system_.inertia_differential(g, xi);
    } else {
      static_assert(!named::inertia_differential<S>,
                    "expected a const member inertia_differential(g, xi)");
      return automatic(
          [&](const auto& x) {
            const auto inertia = system_.inertia(x);
            using T = typename std::decay_t<decltype(inertia)>::Scalar;
            T twice(0.0);
            for (int i = 0; i < n; ++i) {
              for (int j = 0; j < n; ++j) twice += inertia(i, j) * (xi[i] * xi[j]);
            }
            return T(0.5 * twice);
          },
          g);
    }
  }

#if HAMEL_HAS_JET
  using Dual = ceres::Jet<double, 1>;
  using DualElement = typename G::template Element<Dual>;
  /// Are A, b and I formulas over any scalar (templates on the element) or constant? Then one dual
  /// number carries their rates.
  static constexpr bool has_dual_rates() {
    constexpr bool rows = own == 0 || requires(const S& s) { s.constraints(); }
    || dual_constraints();
    return rows && (r == 0 || dual_differential()) && (constant_inertia() || dual_inertia()) &&
           (!has_drift<S>() || has_constant_drift<S>() || dual_drift());
  }
  /// A and I, and the rates of b - A xi and I xi at constant xi along the curve g tau(e xi), of
  /// which `moving` is the first-order jet; rows and I that are constant are left as they are.
  void dual_rates(const DualElement& moving, const Vec<n>& xi, Mat<k, n>& rows, Vec<k>& row_rate,
                  Mat<n, n>& inertia, Vec<n>& momentum_rate) const {
    const auto split = [&](const auto& from, int at) {
      for (int i = 0; i < from.rows(); ++i) {
        double rate = 0;
        for (int j = 0; j < n; ++j) {
          rows(at + i, j) = from(i, j).a;
          rate -= from(i, j).v[0] * xi[j];
        }
        row_rate[at + i] = rate;
      }
    };
    if constexpr (own > 0 && !requires(const S& s) { s.constraints(); })
      split(system_.constraints(moving), 0);
    else row_rate.template head<own>().setZero();
    if constexpr (has_drift<S>() && !has_constant_drift<S>()) {
      const VecT<Dual, own> drift = system_.drift(moving);
      for (int i = 0; i < own; ++i) row_rate[i] += drift[i].v[0];
    }
    if constexpr (r > 0) split(system_.holonomic_differential(moving), own);
    if constexpr (!constant_inertia()) this->inertia_rate(moving, xi, inertia, momentum_rate);
  }
  /// I, and the rate of I xi at constant xi.
  void inertia_rate(const DualElement& moving, const Vec<n>& xi, Mat<n, n>& inertia,
                    Vec<n>& momentum_rate) const {
    const MatT<Dual, n, n> moved = system_.inertia(moving);
    momentum_rate.setZero();
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        inertia(i, j) = moved(i, j).a;
        momentum_rate[i] += moved(i, j).v[0] * xi[j];
      }
    }
  }
  /// Does the system state a frame, as a formula over any scalar? With a drift it is not used.
  static constexpr bool framed() {
    if constexpr (requires(const S& s, const Element& g) { s.frame(g); }) {
      static_assert(
          dual_frame() && (constant_inertia() || dual_inertia()),
          "frame of this system cannot be used: expected a template frame(const auto& g), k x m, "
          "and an inertia that is constant or such a template");
      return !has_drift<S>();
    } else {
      static_assert(!named::frame<S>,
                    "frame of this system cannot be called: expected a const member frame(g)");
      return false;
    }
  }
  /// B of framed_equations.hpp.
  template <class Configuration>
  auto frame(const Configuration& g) const {
    return system_.frame(g);
  }
  /// B' y along g tau(e xi), y the first of xi.
  Vec<k> frame_turn(const Element& g, const Vec<n>& xi) const {
    const Vec<n - k> y = xi.template head<n - k>();
    Vec<k> out;
    if constexpr (requires { system_.frame_rate(g, xi); }) {
      const Mat<k, n - k> rate = system_.frame_rate(g, xi);
      out = rate.lazyProduct(y);
    } else {
      static_assert(!named::frame_rate<S>,
                    "frame_rate of this system cannot be called: expected a const member "
                    "frame_rate(g, xi)");
      const MatT<Dual, k, n - k> moved = system_.frame(element_along<Dual, G>(g, xi));
      for (int i = 0; i < k; ++i) {
        out[i] = moved(i, 0).v[0] * y[0];
        for (int j = 1; j < n - k; ++j) out[i] += moved(i, j).v[0] * y[j];
      }
    }
    return out;
  }
#else
  static constexpr bool has_dual_rates() { return false; }
  static constexpr bool framed() { return false; }
#endif

 private:
  Mat<own, n> rows([[maybe_unused]] double t, [[maybe_unused]] const Element& g) const
      requires(own > 0) {
    if constexpr (requires { system_.constraints(t, g); }) return system_.constraints(t, g);
    else if constexpr (requires { system_.constraints(g); }) return system_.constraints(g);
    else return system_.constraints();
  }
  Mat<n, n> inertia_at([[maybe_unused]] const Element& g) const {
    if constexpr (constant_inertia()) return system_.inertia();
    else return system_.inertia(g);
  }
#if HAMEL_HAS_JET
  // A member whose address can be taken is no template; a template may still answer with doubles.
  template <class Answer>
  static constexpr bool is_dual = std::is_same_v<typename std::decay_t<Answer>::Scalar, Dual>;
  static constexpr bool dual_constraints() {
    if constexpr (requires { &S::constraints; }) return false;
    else if constexpr (requires(const S& s, const DualElement& g) { s.constraints(g); })
      return is_dual<decltype(std::declval<const S&>().constraints(std::declval<DualElement>()))>;
    else return false;
  }
  static constexpr bool dual_drift() {
    if constexpr (requires { &S::drift; }) return false;
    else if constexpr (requires(const S& s, const DualElement& g) { s.drift(g); })
      return is_dual<decltype(std::declval<const S&>().drift(std::declval<DualElement>()))>;
    else return false;
  }
  static constexpr bool dual_differential() {
    if constexpr (requires { &S::holonomic_differential; }) return false;
    else if constexpr (requires(const S& s, const DualElement& g) { s.holonomic_differential(g); })
      return is_dual<decltype(std::declval<const S&>().holonomic_differential(
          std::declval<DualElement>()))>;
    else return false;
  }
  static constexpr bool dual_frame() {
    if constexpr (requires { &S::frame; }) {
      return false;
    } else {
      using B = std::decay_t<decltype(std::declval<const S&>().frame(std::declval<DualElement>()))>;
      return is_dual<B> && B::RowsAtCompileTime == k && B::ColsAtCompileTime == n - k;
    }
  }
  static constexpr bool dual_inertia() {
    if constexpr (requires { &S::inertia; }) return false;
    else if constexpr (requires(const S& s, const DualElement& g) { s.inertia(g); })
      return is_dual<decltype(std::declval<const S&>().inertia(std::declval<DualElement>()))>;
    else return false;
  }
#endif
  template <class Function>
  static auto automatic(const Function& f, const Element& g) {
#if HAMEL_HAS_JET
    return left_differential<G>(f, g);
#else
    static_assert(sizeof(Function) == 0,
                  "give the differential by hand, or install libceres-dev for <ceres/jet.h>");
    return Vec<n>(f(g));
#endif
  }

  S system_;
};

}  // namespace hamel
