// rk4_projected: classical RK4 in the coordinates of the trajectory file, projected
// (runge_kutta.hpp): the method that a user would write by hand.
//
// The coordinates are the columns q(g) of the element (nine for a rotation), in which
//   q' = d/de q(g tau(e xi)) at e = 0.
// Between the stages they leave the group; the element is the one nearest to them. Weakness: no
// structure but what the projections put back; energy and holonomic rows drift as those of rkmk4
// (rkmk4.hpp). Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, IV.4 (projection
// methods).
#pragma once

#include <hamel/framework/schemes/runge_kutta.hpp>

namespace hamel {

struct Rk4Projected : ExplicitDefaults {
  static std::string name() { return "rk4_projected"; }
  static std::string formula() {
    return "RK4 for (q, xi)' in the coordinates q of the element, then projected to group and rows";
  }
  static std::string source() {
    return "what a user would write by hand; Hairer, Lubich, Wanner IV.4";
  }

  static ClaimedOrder claim(double /*s*/, TauTraits /*tau*/, bool /*left_invariant*/) {
    return {4, false};
  }
  static const Tableau& tableau() { return classical_rk4(); }

  template <class P>
  class Step : public RungeKutta<Step<P>, P, Eigen::VectorXd> {
    using Base = RungeKutta<Step<P>, P, Eigen::VectorXd>;
    using typename Base::Element, typename Base::Vector;
    using Coordinates = Eigen::VectorXd;

   public:
    static constexpr bool rate_in_algebra = false;
    static constexpr bool keeps_rows() { return false; }
    Step(const P& problem, const Tableau& table) : Base(problem, table, problem.columns()) {}
    void start(const Element& g, Coordinates& q) { this->problem_.coordinates(g, q.data()); }
    bool element(const Coordinates& q, Element& g) const {
      if (!q.allFinite()) return false;
      this->problem_.nearest({q.data(), static_cast<size_t>(q.size())}, g);
      return this->problem_.defect(g) < 1e-6;  // else too far from any
    }
    void rate(const Coordinates& /*q*/, const Element& g, const Vector& xi,
              Coordinates& out) const {
      out.setZero();
      differentiate_along(this->problem_, g, xi, shift_, moved_, [&](double, double weight) {
        this->problem_.coordinates(moved_, q_.data());
        out += weight * q_;
      });
    }

   private:
    mutable Vector shift_ = Vector::Zero(this->problem_.dim());
    mutable Element moved_ = this->problem_.element();
    mutable Coordinates q_ = Coordinates(this->problem_.columns());
  };
};

}  // namespace hamel
