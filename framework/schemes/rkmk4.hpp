// rkmk4: Runge-Kutta-Munthe-Kaas of order 4 on the equations of motion, explicit (runge_kutta.hpp).
//
// The coordinates are those of the algebra at the start of the step, g = g_0 tau(eta), in which
//   eta' = dL tau_eta^-1 xi.
// Without dL tau^-1 it would have order 2. Weakness: nothing is kept but the group: energy and holonomic rows
// drift, on a motion that goes on for ever like h^5 t (its error of order 4 averages out where the motion is
// reversible). Measured: tests/verification/baselines.cpp.
// Source: Munthe-Kaas, High order Runge-Kutta methods on manifolds (1998).
#pragma once

#include <hamel/framework/schemes/runge_kutta.hpp>

namespace hamel {

struct Rkmk4 : RungeKutta4Defaults {
  static std::string name() { return "rkmk4"; }
  static std::string formula() {
    return "RK4 for (eta, xi)' = (dL tau_eta^-1 xi, a(t, g_0 tau(eta), xi))";
  }
  static std::string source() { return "Munthe-Kaas 1998; Iserles et al. 2000"; }

  template <class P>
  class Step : public RungeKutta4<Step<P>, P, typename P::Vector> {
    using Base = RungeKutta4<Step<P>, P, typename P::Vector>;
    using typename Base::Element, typename Base::Vector;

   public:
    Step(const P& problem, double /*s*/) : Base(problem, problem.dim()), g0_(problem.element()) {}
    void start(const Element& g, Vector& eta) {
      g0_ = g;
      eta.setZero();
    }
    bool element(const Vector& eta, Element& g) const {
      if (!this->problem_.in_domain(eta)) return false;
      this->problem_.tau(eta, g);
      this->problem_.compose(g0_, g, g);
      return true;
    }
    void rate(const Vector& eta, const Element& /*g*/, const Vector& xi, Vector& out) const {
      this->problem_.dtau_left_inverse(eta, xi, out);
    }

   private:
    Element g0_;
  };
};

}  // namespace hamel
