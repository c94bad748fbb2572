// A Munthe-Kaas scheme with a mistake: eta' = xi, without dL tau^-1.
#pragma once

#include <string>

#include <hamel/framework/schemes/runge_kutta.hpp>

namespace hamel::verification {

template <class Scheme>
struct WithoutDtau : ExplicitDefaults {
  static std::string name() { return "without_dtau"; }
  static std::string formula() { return "(eta, xi)' = (xi, a)"; }
  static std::string source() { return "a mistake"; }
  static ClaimedOrder claim(double s, TauTraits tau, bool left_invariant) {
    return Scheme::claim(s, tau, left_invariant);
  }
  static const Tableau& tableau() { return Scheme::tableau(); }

  template <class P>
  class Step : public RungeKutta<Step<P>, P, typename P::Vector> {
    using Base = RungeKutta<Step<P>, P, typename P::Vector>;
    using typename Base::Element, typename Base::Vector;

   public:
    static constexpr bool rate_in_algebra = true;
    bool keeps_rows() const { return this->table_.estimates(); }
    Step(const P& problem, const Tableau& table)
        : Base(problem, table, problem.dim()), g0_(problem.element()) {}
    void start(const Element& g, Vector& eta) {
      g0_ = g;
      eta.setZero();
    }
    bool element(const Vector& eta, Element& g) const {
      this->problem_.tau(eta, g);
      this->problem_.compose(g0_, g, g);
      return true;
    }
    void rate(const Vector&, const Element&, const Vector& xi, Vector& out) const { out = xi; }

   private:
    Element g0_;
  };
};

}  // namespace hamel::verification
