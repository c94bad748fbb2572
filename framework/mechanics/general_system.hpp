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
//   frame(g)                                     k x m: the last k velocities by the first m
//                                                (framed_equations.hpp)
// Written as templates on the element (`const auto& g`), potential, holonomic and inertia are
// differentiated automatically (ceres::Jet, seeded along g tau(eta)). By hand, where speed counts:
//   potential_differential(g)   n entries, <dV, eta> = d/de V(g tau(e eta))
//   holonomic_differential(g)   r x n
//   inertia_differential(g, xi) n entries, 1/2 d(xi^T I(g) xi)
//   frame_rate(g, xi)           k x m, the rate of frame(g) along g tau(e xi)
// check/system_laws.hpp compares the two. constraints(g) and holonomic_differential(g) as templates
// spare the explicit schemes six evaluations for dA/dt.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/mechanics/formulas.hpp>
#include <hamel/framework/mechanics/framed_equations.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>
#include <hamel/framework/mechanics/system.hpp>
#include <hamel/framework/mechanics/with_inputs.hpp>

namespace hamel {

/// A system's formulas as Mechanics.
template <class S>
class TypedMechanics final : public Mechanics {
  using F = Formulas<S>;
  static constexpr int n = F::n, k = F::k, r = F::r;
  struct NoFrame {
    explicit NoFrame(const F& /*formulas*/) {}
  };
  template <class Own, bool framed>
  struct Frames {
    using type = FramedEquations<Own>;
  };
  template <class Own>
  struct Frames<Own, false> {
    using type = NoFrame;
  };
  using Framed = typename Frames<F, F::framed()>::type;

 public:
  explicit TypedMechanics(const S& system) : formulas_(system), framed_(formulas_) {}
  const F& formulas() const { return formulas_; }
  const auto& framed_equations() const { return framed_; }
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
  bool exact_rates() const override { return F::has_dual_rates(); }
  // By one dual number, where the formulas are ones over any scalar.
  void rates(const Geometry& geometry, double t, const double* g, ConstVector xi, Vector rows,
             Vector momentum) const override {
    if constexpr (F::has_dual_rates()) {
      const Vec<n> along(xi);
      Mat<k, n> a;
      Mat<n, n> inertia;
      Vec<k> row_rate;
      Vec<n> momentum_rate = Vec<n>::Zero();
      formulas_.dual_rates(element_along<typename F::Dual, typename F::G>(load(g), along), along, a,
                           row_rate, inertia, momentum_rate);
      rows = row_rate;
      momentum = momentum_rate;
    } else {
      Mechanics::rates(geometry, t, g, xi, rows, momentum);
    }
  }
  int framed_size() const override { return F::framed() ? n - k : 0; }
  void expand(const double* g, ConstVector x, Vector to) const override {
    if constexpr (F::framed()) {
      Vec<n> xi;
      Framed::expand(formulas_, load(g), Eigen::Map<const Vec<n>>(x.data()), xi);
      Eigen::Map<Vec<n>>(to.data()) = xi;
    }
  }
  void framed_motion(double t, const double* g, ConstVector x, Vector to_xi,
                     Vector to_rate) const override {
    if constexpr (F::framed()) {
      Vec<n> xi, rate;
      framed_(formulas_, t, load(g), Eigen::Map<const Vec<n>>(x.data()), xi, rate);
      Eigen::Map<Vec<n>>(to_xi.data()) = xi;
      Eigen::Map<Vec<n>>(to_rate.data()) = rate;
    }
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
  [[no_unique_address]] Framed framed_;
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
