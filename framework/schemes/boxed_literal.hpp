// boxed_literal: the paper's boxes exactly as typeset, with iota* in front of both lines.
//
// Kept only so that the paper's figure can be reproduced. As printed the right side is t I Omega with
// xi = t Omega, so that the step size cancels, and the update carries the sign of the inverse:
//   E^T (dR_xi)^T mu_k = E^T I xi,   xi = E y  (no h),
//   mu_bar_{k+1} = E^T Ad_{tau(xi)^-1}^T mu_k,   g_{k+1} = g_k tau(xi).
// mu_k is the vector printed as (Pi_1, Pi_2, 0): the covector of d* without a part along the
// Euclidean complement of d, mu_k = E (E^T E)^-1 mu_bar_k. For a diagonal inertia that is I Omega.
// Not an approximation of anything: its first step is an O(1) jump whatever h is.
#pragma once

#include <hamel/framework/schemes/problem.hpp>
#include <hamel/framework/schemes/traits.hpp>
#include <hamel/framework/lie/trivialised.hpp>

#include <Eigen/LU>

namespace hamel {

struct BoxedLiteral {
  static std::string name() { return "boxed_literal"; }
  static std::string formula() {
    return "E'(dR_xi)' mu_k = E' I xi,  mu_{k+1} = E' Ad_{tau(xi)^-1}' mu_k  (h cancels)";
  }
  static std::string source() { return "Vivek, Martin de Diego, Banavar: the boxes as typeset"; }
  static constexpr bool adapted = true;
  static constexpr bool uses_s = false;
  static ClaimedOrder claimed_order(double /*s*/, bool /*symmetric_tau*/) { return {0, false}; }

  template <class Problem, class Tau>
  class Step {
   public:
    static constexpr int n = Problem::n;
    using G = typename Problem::Group;
    using Element = typename G::template Element<double>;
    using Unknown = typename Problem::Reduced;
    using Jacobian = typename Problem::ReducedMatrix;
    using Momentum = typename Problem::Reduced;

    Step(const Problem& problem, double /*s*/) : problem_(problem) {
      const Jacobian gram = problem.frame.transpose().lazyProduct(problem.frame);
      const Jacobian gram_inverse = gram.inverse();
      embedding_ = problem.frame.lazyProduct(gram_inverse);
    }

    void begin(const Momentum& mu, double /*h*/) {
      mu_ = mu;
      full_mu_ = embedding_.lazyProduct(mu);
    }
    Unknown guess() const { return mu_; }
    double scale_squared() const { return 4 * mu_.squaredNorm(); }
    Vec<n> xi(const Unknown& y) const { return problem_.velocity(y); }

    void residual(const Unknown& y, Unknown& f) const {
      f = problem_.reduce(Tau::dtau_right(xi(y)).transpose() * full_mu_) - y;
    }

    /// F and dF/dy.
    void linearise(const Unknown& y, Unknown& f, Jacobian& j) const {
      residual(y, f);
      j = problem_.reduce_both(At<Tau>(xi(y)).right_transpose_derivative(full_mu_));
      j.diagonal().array() -= 1;
    }

    void finish(const Unknown& y, Element& increment, Momentum& mu) const {
      increment = Tau::tau(xi(y));
      mu = problem_.reduce(G::Ad_transpose(G::inverse(increment), full_mu_));
    }

   private:
    Problem problem_;
    typename Problem::Frame embedding_;
    Momentum mu_;
    Vec<n> full_mu_;
  };
};

}  // namespace hamel
