// From a system's struct to Mechanics: formulas as stated, their differentials by automatic differentiation.
//
// A system whose inertia, constraint or forces depend on the configuration states, beside Group:
//   inertia() or inertia(g)                      n x n
//   constraints(), constraints(g) or (t, g)      k x n rows A
//   drift(), drift(g) or drift(t, g)             b, k entries: A xi = b (left out: 0)
//   holonomic(g)                                 phi, r entries: phi = 0; its differential joins A
//   potential(g)                                 V, a number
//   force(g, xi) or force(t, g, xi)              f, n entries in the dual (controls, friction)
// Written as templates on the element (`const auto& g`), potential, holonomic and inertia are differentiated
// automatically (ceres::Jet, seeded along g tau(eta)). By hand, where speed counts:
//   potential_differential(g)   n entries, <dV, eta> = d/de V(g tau(e eta))
//   holonomic_differential(g)   r x n
//   inertia_differential(g, xi) n entries, 1/2 d(xi^T I(g) xi)
// check/system_laws.hpp compares the two.
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

template <class S>
class TypedMechanics final : public Mechanics {
  using G = typename S::Group;
  using Element = typename G::template Element<double>;
  static constexpr int n = G::dim;
  static constexpr int r = holonomic_count<S>();
  static constexpr int own = constraint_count<S>();  // rows of A that are no differential

 public:
  explicit TypedMechanics(const S& system) : system_(system) {}
  int dim() const override { return n; }
  int rows() const override { return own + r; }
  int holonomic_rows() const override { return r; }
  bool constant_inertia() const override {
    return requires(const S& s) { s.inertia(); };
  }

  bool constant_constraints() const override {
    constexpr bool rows = own == 0 || requires(const S& s) { s.constraints(); };
    return r == 0 && rows && (!has_drift<S>() || has_constant_drift<S>());
  }

  void inertia(const double* g, Matrix out) const override {
    if constexpr (requires(const S& s) { s.inertia(); }) out = system_.inertia();
    else out = system_.inertia(load(g));
  }

  [[gnu::flatten]] void constraints(double t, const double* at, Matrix to_a,
                                    Vector to_b) const override {
    const Element g = load(at);
    constexpr int k = own + r;
    Mat<k, n> a;
    Vec<k> b = Vec<k>::Zero();
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
    if (to_a.outerStride() == k) Eigen::Map<Mat<k, n>>(to_a.data()) = a;  // sizes known: unrolled
    else to_a = a;
    Eigen::Map<Vec<k>>(to_b.data()) = b;
  }

  [[gnu::flatten]] void holonomic(const double* g, Vector out) const override {
    if constexpr (r > 0) out = system_.holonomic(load(g));
  }

  [[gnu::flatten]] void force(double t, const double* at, ConstVector velocity,
                              Vector to) const override {
    const Element g = load(at);
    const Vec<n> xi = Eigen::Map<const Vec<n>>(velocity.data());
    Vec<n> out = Vec<n>::Zero();
    if constexpr (has_potential<S>()) out -= potential_differential(g);
    if constexpr (has_force<S>()) out += force_of(system_, t, g, xi);
    if constexpr (!requires(const S& s) { s.inertia(); }) out += inertia_differential(g, xi);
    Eigen::Map<Vec<n>>(to.data()) = out;
  }

  double potential(const double* g) const override {
    if constexpr (has_potential<S>()) return system_.potential(load(g));
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

 private:
  static Element load(const double* g) { return Packing<G>::load(g); }
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

template <class S>
std::shared_ptr<const Mechanics> MechanicsOf<S>::make(const S& system) {
  return std::make_shared<TypedMechanics<S>>(system);
}

}  // namespace hamel
