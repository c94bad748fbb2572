// From a system's struct to Mechanics: formulas as stated, their differentials by automatic
// differentiation.
//
// A system whose inertia, constraint or forces depend on the configuration states, beside Group:
//   inertia() or inertia(g)                      n x n
//   constraints(), constraints(g) or (t, g)      k x n rows A
//   drift(), drift(g) or drift(t, g)             b, k entries: A xi = b (left out: 0)
//   holonomic(g)                                 phi, r entries: phi = 0; its differential joins A
//   potential(g)                                 V, a number
//   force(g, xi) or force(t, g, xi)              f, n entries in the dual (controls, friction)
//   force(t, g, xi, u), drift(t, g, u)           what inputs add to them (inputs.hpp)
// Written as templates on the element (`const auto& g`), potential, holonomic and inertia are
// differentiated automatically (ceres::Jet, seeded along g tau(eta)). By hand, where speed counts:
//   potential_differential(g)   n entries, <dV, eta> = d/de V(g tau(e eta))
//   holonomic_differential(g)   r x n
//   inertia_differential(g, xi) n entries, 1/2 d(xi^T I(g) xi)
// check/system_laws.hpp compares the two. constraints(g) and holonomic_differential(g) as templates
// spare the explicit schemes six evaluations for dA/dt.
#pragma once

#include <memory>
#include <type_traits>

#if __has_include(<ceres/jet.h>)
#include <ceres/jet.h>
#define HAMEL_HAS_JET 1
#else
#define HAMEL_HAS_JET 0
#endif

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/lie/retraction_defaults.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>
#include <hamel/framework/mechanics/system.hpp>
#include <hamel/framework/mechanics/with_inputs.hpp>

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
    if constexpr (own > 0) {
      if constexpr (requires { system_.constraints(t, g); }) {
        a.template topRows<own>() = system_.constraints(t, g);
      } else if constexpr (requires { system_.constraints(g); }) {
        a.template topRows<own>() = system_.constraints(g);
      } else {
        a.template topRows<own>() = system_.constraints();
      }
    }
    if constexpr (has_drift<S>()) b.template head<own>() = drift_of(system_, t, g);
    if constexpr (r > 0) a.template bottomRows<r>() = holonomic_differential(g);
  }
  void holonomic(const Element& g, Vec<r>& out) const {
    if constexpr (r > 0) out = system_.holonomic(g);
  }
  void force(double t, const Element& g, const Vec<n>& xi, Vec<n>& out) const {
    out.setZero();
    if constexpr (has_potential<S>()) out -= potential_differential(g);
    if constexpr (has_force<S>()) out += force_of(system_, t, g, xi);
    if constexpr (!constant_inertia()) out += inertia_differential(g, xi);
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
  /// A^T and I, and the rates of b - A xi and I xi at constant xi along the curve g tau(e xi), of
  /// which `moving` is the first-order jet; rows and I that are constant are left as they are.
  void dual_rates(const DualElement& moving, const Vec<n>& xi, Mat<n, k>& rows, Vec<k>& row_rate,
                  Mat<n, n>& inertia, Vec<n>& momentum_rate) const {
    const auto split = [&](const auto& from, int at) {
      for (int i = 0; i < from.rows(); ++i) {
        double rate = 0;
        for (int j = 0; j < n; ++j) {
          rows(j, at + i) = from(i, j).a;
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
    if constexpr (!constant_inertia()) {
      const MatT<Dual, n, n> moved = system_.inertia(moving);
      momentum_rate.setZero();
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
          inertia(i, j) = moved(i, j).a;
          momentum_rate[i] += moved(i, j).v[0] * xi[j];
        }
      }
    }
  }
#else
  static constexpr bool has_dual_rates() { return false; }
#endif

 private:
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

/// A system's formulas as Mechanics.
template <class S>
class TypedMechanics final : public Mechanics {
  using F = Formulas<S>;
  static constexpr int n = F::n, k = F::k, r = F::r;

 public:
  explicit TypedMechanics(const S& system) : formulas_(system) {}
  const F& formulas() const { return formulas_; }
  int dim() const override { return n; }
  int constraint_count() const override { return k; }
  int holonomic_rows() const override { return r; }
  bool constant_inertia() const override { return F::constant_inertia(); }
  bool constant_constraints() const override { return F::constant_constraints(); }
  bool autonomous() const override { return is_autonomous<S>(); }
  bool has_force() const override { return hamel::has_force<S>(); }
  bool has_drift() const override { return hamel::has_drift<S>(); }

  void inertia(const double* g, Matrix out) const override {
    Mat<n, n> i;
    formulas_.inertia(load(g), i);
    out = i;
  }
  HAMEL_FLATTEN void constraints(double t, const double* g, Matrix to_a,
                                 Vector to_b) const override {
    Mat<k, n> a;
    Vec<k> b;
    formulas_.constraints(t, load(g), a, b);
    if (to_a.outerStride() == k) Eigen::Map<Mat<k, n>>(to_a.data()) = a;  // sizes known: unrolled
    else to_a = a;
    Eigen::Map<Vec<k>>(to_b.data()) = b;
  }
  HAMEL_FLATTEN void holonomic(const double* g, Vector out) const override {
    Vec<r> phi;
    formulas_.holonomic(load(g), phi);
    out = phi;
  }
  HAMEL_FLATTEN void force(double t, const double* g, ConstVector xi, Vector to) const override {
    Vec<n> out;
    formulas_.force(t, load(g), Eigen::Map<const Vec<n>>(xi.data()), out);
    Eigen::Map<Vec<n>>(to.data()) = out;
  }
  void inertial_force(const double* g, ConstVector xi, Vector to) const override {
    Vec<n> out;
    formulas_.inertial_force(load(g), Eigen::Map<const Vec<n>>(xi.data()), out);
    to = out;
  }
  bool force_depends_on_velocity() const override { return hamel::has_force<S>(); }
  double power(double t, const double* g, ConstVector xi) const override {
    return formulas_.power(t, load(g), Eigen::Map<const Vec<n>>(xi.data()));
  }
  double potential(const double* g) const override { return formulas_.potential(load(g)); }

  // For the laws that compare differentials.
  auto potential_differential(const typename F::Element& g) const {
    return formulas_.potential_differential(g);
  }
  auto holonomic_differential(const typename F::Element& g) const {
    return formulas_.holonomic_differential(g);
  }
  auto inertia_differential(const typename F::Element& g, const Vec<n>& xi) const {
    return formulas_.inertia_differential(g, xi);
  }

 private:
  static typename F::Element load(const double* g) { return Packing<typename F::G>::load(g); }
  F formulas_;
};

template <class S>
std::shared_ptr<const Mechanics> MechanicsOf<S>::make(const S& system) {
  return std::make_shared<TypedMechanics<S>>(system);
}
template <class S>
std::shared_ptr<const Mechanics> MechanicsOf<S>::drive(const S& system,
                                                       std::shared_ptr<const Inputs> inputs) {
  return std::make_shared<TypedMechanics<WithInputs<S>>>(WithInputs<S>(system, std::move(inputs)));
}

}  // namespace hamel
