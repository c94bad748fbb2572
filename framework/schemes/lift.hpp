// lift: the paper's definition D^{D*} = (iota* x iota*) o D^{T*} o T pi*, read literally.
//
// With z0 = -s xi, z1 = (1-s) xi, f_i = tau(z_i), the cotangent lift (method.md, section 2) is
//   (1)  mu = s dL_{z0}^T mu0 + (1-s) dL_{z1}^T mu1,     (2)  nu = Ad*_{f1^-1} mu1 - Ad*_{f0^-1} mu0.
// Carry both end momenta to the base point, m_i = Ad*_{f_i^-1} mu_i. Since Ad_f dL = dR, (1) is
//   mu = s dR_{z0}^T m0 + (1-s) dR_{z1}^T m1,  and nu = 0 gives m0 = m1 = m:
//   C m = I xi / h,   C = s dR_{z0}^T + (1-s) dR_{z1}^T.
// Unknown y with xi = h E y. The step solves E^T mu0 = mu_bar_k and returns mu_bar_{k+1} = E^T mu1,
//   mu0 = Ad_{f0}^T m,   mu1 = Ad_{f1}^T m,   g_{k+1} = g_k f0^-1 f1.
// At s = 0, and at every s for a one-parameter tau (exp: f0^-1 f1 = exp xi), mu0 = (dR_xi)^-T I xi/h.
// This is the discrete Lagrange-d'Alembert principle for L_d = h l(xi/h) (Cortes, Martinez 2001).
#pragma once

#include <hamel/framework/schemes/hamel_form.hpp>
#include <hamel/framework/schemes/problem.hpp>
#include <hamel/framework/schemes/traits.hpp>
#include <hamel/framework/lie/trivialised.hpp>

#include <Eigen/LU>

namespace hamel {

struct Lift {
  static std::string name() { return "lift"; }
  static std::string formula() {
    return "E'(dR_xi)^-T I xi/h = mu_k,  mu_{k+1} = E'(dL_xi)^-T I xi/h  (s = 0)";
  }
  static std::string source() { return "Vivek, Martin de Diego, Banavar: D^{D*}, read literally"; }
  static constexpr bool adapted = true;
  static constexpr bool uses_s = true;
  /// A symmetric tau gives order 2 for every s. The step is reversible at s = 1/2, and at s = 0 and 1 when
  /// tau is symmetric; between them only when tau(a xi) and tau(b xi) commute (exp, Cayley, polar), which
  /// is not claimed: tau_s(xi)^-1 = tau((1-s) xi)^-1 tau(-s xi) is tau_s(-xi) only then.
  static ClaimedOrder claimed_order(double s, bool symmetric_tau) {
    return {symmetric_tau || s == 0.5 ? 2 : 1, s == 0.5 || (symmetric_tau && (s == 0 || s == 1))};
  }

  /// The scheme on systems that are not left-invariant: general/lift.hpp.
  static std::unique_ptr<GeneralStep> general(const GeneralSetup& setup);
  static ClaimedOrder general_order(double s) { return {s == 0.5 ? 2 : 1, s == 0.5}; }

  template <class Problem, class Tau>
  class Step {
   public:
    static constexpr int n = Problem::n;
    using G = typename Problem::Group;
    using Element = typename G::template Element<double>;
    using Unknown = typename Problem::Reduced;
    using Jacobian = typename Problem::ReducedMatrix;
    using Momentum = typename Problem::Reduced;

    Step(const Problem& problem, double s)
        : problem_(problem), form_(problem), s_(s), one_sided_(s == 0 || Tau::one_parameter) {}

    void begin(const Momentum& mu, double h) {
      mu_ = mu;
      h_ = h;
    }
    Unknown guess() const { return mu_; }
    /// (|mu_bar| + |I xi/h|)^2, both of one length in the Hamel frame.
    double scale_squared() const { return 4 * mu_.squaredNorm(); }
    Vec<n> xi(const Unknown& y) const { return h_ * problem_.velocity(y); }

    /// F(y) = E^T mu0 - mu_bar.
    [[gnu::always_inline]] void residual(const Unknown& y, Unknown& f) const {
      if (one_sided_) [[likely]] {
        if constexpr (has_form) {
          f = form_(y, h_) - mu_;
        } else {
          f = problem_.reduce(Tau::dtau_right_inverse_transpose(xi(y), problem_.momentum(y))) - mu_;
        }
      } else {
        two_sided_residual(y, f);
      }
    }

    /// F and dF/dy.
    void linearise(const Unknown& y, Unknown& f, Jacobian& j) const {
      residual(y, f);
      const Vec<n> p = problem_.momentum(y), step = xi(y);
      if (one_sided_) {
        j = h_ * problem_.reduce_both(Tau::dtau_right_inverse_transpose_derivative(step, p)) +
            problem_.reduce_momentum_transposed(Tau::dtau_right_inverse(step));
        return;
      }
      // dm = C^-1 (I E dy - dC m),  dmu0 = Ad_{f0}^T dm + K(mu0) dL_{z0} dz0.
      const At<Tau> z0(-s_ * step), z1((1 - s_) * step);
      const Mat<n, n> c_inverse = inverse_of_c(z0, z1);
      const Vec<n> m = c_inverse * p;
      const Mat<n, n> dc_m = (1 - s_) * (1 - s_) * z1.right_transpose_derivative(m) -
                             s_ * s_ * z0.right_transpose_derivative(m);
      const Mat<n, n> pull = G::Ad(z0.f).transpose() * c_inverse;
      j = problem_.reduce_momentum(pull) -
          h_ * problem_.reduce_both(pull * dc_m + s_ * z0.pull_derivative(z0.pull(m)));
    }

    /// g_{k+1} = g_k increment, and mu_bar_{k+1}.
    [[gnu::always_inline]] void finish(const Unknown& y, Element& increment, Momentum& mu) const {
      if (one_sided_) [[likely]] {
        const Vec<n> step = xi(y);
        increment = Tau::tau(step);
        if constexpr (has_form) {
          mu = form_(y, -h_);
        } else {
          mu = problem_.reduce(Tau::dtau_left_inverse_transpose(step, problem_.momentum(y)));
        }
      } else {
        two_sided_finish(y, increment, mu);
      }
    }

   private:
    // Out of line, so that the one-sided loop stays small.
    [[gnu::noinline]] void two_sided_residual(const Unknown& y, Unknown& f) const {
      const Vec<n> step = xi(y);
      f = problem_.reduce(G::Ad_transpose(Tau::tau(Vec<n>(-s_ * step)), base(y, step))) - mu_;
    }
    [[gnu::noinline]] void two_sided_finish(const Unknown& y, Element& increment,
                                            Momentum& mu) const {
      const Vec<n> step = xi(y);
      const Element f1 = Tau::tau(Vec<n>((1 - s_) * step));
      increment = G::compose(G::inverse(Tau::tau(Vec<n>(-s_ * step))), f1);
      mu = problem_.reduce(G::Ad_transpose(f1, base(y, step)));
    }
    Vec<n> base(const Unknown& y, const Vec<n>& step) const {  // m = C^-1 I xi/h
      return base_momentum<Tau>(s_, step, problem_.momentum(y), Vec<n>::Zero());
    }
    Mat<n, n> inverse_of_c(const At<Tau>& z0, const At<Tau>& z1) const {
      const Mat<n, n> c = (s_ * z0.right + (1 - s_) * z1.right).transpose();
      return c.inverse();
    }

    static constexpr bool has_form = has_hamel_form<Problem, Tau>;
    struct NoForm {
      explicit NoForm(const Problem& /*problem*/) {}
    };

    Problem problem_;
    [[no_unique_address]] std::conditional_t<has_form, HamelForm<Problem, Tau>, NoForm> form_;
    double s_, h_ = 0;
    bool one_sided_;
    Momentum mu_;
  };
};

}  // namespace hamel
