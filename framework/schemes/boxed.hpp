// boxed: the paper's boxed formulas with the slips of method.md, section 6, repaired.
//
// s = 0 and nu = 0 in the cotangent lift, the known momentum barred, mu_k = I E mu_bar_k:
//   E^T (dR_xi)^T mu_k = E^T I xi / h = y,   xi = h E y,
//   mu_bar_{k+1} = E^T Ad_{tau(xi)}^T mu_k,   g_{k+1} = g_k tau(xi).
// What Ad^T carries out of d* is dropped, and with it the second order: the scheme has order 1.
#pragma once

#include <hamel/framework/schemes/problem.hpp>
#include <hamel/framework/schemes/traits.hpp>
#include <hamel/framework/lie/trivialised.hpp>

namespace hamel {

struct Boxed {
  static std::string name() { return "boxed"; }
  static std::string formula() {
    return "E'(dR_xi)' mu_k = E' I xi/h,  mu_{k+1} = E' Ad_{tau(xi)}' mu_k";
  }
  static std::string source() {
    return "Vivek, Martin de Diego, Banavar: the boxes, slips repaired (method.md, section 6)";
  }
  static constexpr bool adapted = true;
  static constexpr bool uses_s = false;
  static ClaimedOrder claimed_order(double /*s*/, bool /*symmetric_tau*/) { return {1, false}; }

  template <class Problem, class Tau>
  class Step {
   public:
    static constexpr int n = Problem::n;
    using G = typename Problem::Group;
    using Element = typename G::template Element<double>;
    using Unknown = typename Problem::Reduced;
    using Jacobian = typename Problem::ReducedMatrix;
    using Momentum = typename Problem::Reduced;

    Step(const Problem& problem, double /*s*/) : problem_(problem) {}

    void begin(const Momentum& mu, double h) {
      mu_ = mu;
      full_mu_ = problem_.momentum(mu);
      h_ = h;
    }
    Unknown guess() const { return mu_; }
    double scale_squared() const { return 4 * mu_.squaredNorm(); }
    Vec<n> xi(const Unknown& y) const { return h_ * problem_.velocity(y); }

    void residual(const Unknown& y, Unknown& f) const {
      f = problem_.reduce(Tau::dtau_right(xi(y)).transpose() * full_mu_) - y;
    }

    /// F and dF/dy.
    void linearise(const Unknown& y, Unknown& f, Jacobian& j) const {
      residual(y, f);
      j = h_ * problem_.reduce_both(At<Tau>(xi(y)).right_transpose_derivative(full_mu_));
      j.diagonal().array() -= 1;
    }

    void finish(const Unknown& y, Element& increment, Momentum& mu) const {
      increment = Tau::tau(xi(y));
      mu = problem_.reduce(G::Ad_transpose(increment, full_mu_));
    }

   private:
    Problem problem_;
    double h_ = 0;
    Momentum mu_;
    Vec<n> full_mu_;
  };
};

}  // namespace hamel
