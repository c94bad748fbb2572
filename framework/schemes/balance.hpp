// balance: the paper's printed inverse map with barred momenta, balanced on d at the base point.
//
// The end momenta are embedded, mu0 = I E mu_bar_k and mu1 = I E mu_bar_{k+1}; unknowns (y, w) with
// xi = h E y and w = mu_bar_{k+1}. With z0 = -s xi, z1 = (1-s) xi, f_i = tau(z_i), m_i = Ad*_{f_i^-1} mu_i:
//   F1 = E^T ( s dL_{z0}^T mu0 + (1-s) dL_{z1}^T mu1 ) - y,        (1) of method.md, section 2, on d
//   F2 = E^T ( m1 - m0 ),                                         (2) with nu = 0, on d
//   g_{k+1} = g_k f0^-1 f1.
// Derivatives: (c) and (d) of framework/lie/trivialised.hpp.
#pragma once

#include <hamel/framework/schemes/problem.hpp>
#include <hamel/framework/schemes/traits.hpp>
#include <hamel/framework/lie/trivialised.hpp>

namespace hamel {

struct Balance {
  static std::string name() { return "balance"; }
  static std::string formula() {
    return "E'(s dL_{-s xi}' mu_k + (1-s) dL_{(1-s)xi}' mu_{k+1} - I xi/h) = 0,  "
           "E'(Ad*_{f1^-1} mu_{k+1} - Ad*_{f0^-1} mu_k) = 0";
  }
  static std::string source() {
    return "Vivek, Martin de Diego, Banavar: the printed inverse map, both equations on d";
  }
  static constexpr bool adapted = true;
  static constexpr bool uses_s = true;
  static ClaimedOrder claimed_order(double s, bool /*symmetric_tau*/) {
    return {s == 0.5 ? 2 : 1, s == 0.5};
  }

  /// The scheme on systems that are not left-invariant: general/balance.hpp.
  static std::unique_ptr<GeneralStep> general(const GeneralSetup& setup);
  static ClaimedOrder general_order(double s) { return {s == 0.5 ? 2 : 1, s == 0.5}; }

  template <class Problem, class Tau>
  class Step {
   public:
    static constexpr int n = Problem::n;
    static constexpr int M = Problem::m_at_compile_time;
    static constexpr int N = M == kRunTime ? kRunTime : 2 * M;
    using G = typename Problem::Group;
    using Element = typename G::template Element<double>;
    using Unknown = Eigen::Matrix<double, N, 1, 0, 2 * Problem::max_m, 1>;
    using Jacobian = Eigen::Matrix<double, N, N, 0, 2 * Problem::max_m, 2 * Problem::max_m>;
    using Momentum = typename Problem::Reduced;

    Step(const Problem& problem, double s) : problem_(problem), s_(s) {}

    void begin(const Momentum& mu, double h) {
      mu_ = mu;
      h_ = h;
    }
    Unknown guess() const {
      Unknown x(2 * problem_.m());
      x.head(directions()) = mu_;
      x.tail(directions()) = mu_;
      return x;
    }
    double scale_squared() const { return 4 * mu_.squaredNorm(); }
    Vec<n> xi(const Unknown& x) const { return h_ * problem_.velocity(x.head(directions())); }

    void residual(const Unknown& x, Unknown& f) const {
      const Ends e(*this, x);
      fill(x, e, f);
    }

    /// F and its derivative in (y, w).
    void linearise(const Unknown& x, Unknown& f, Jacobian& j) const {
      const Ends e(*this, x);
      fill(x, e, f);
      const auto m = directions();
      const Mat<n, n> push1 = G::Ad(G::inverse(e.z1.f)).transpose();
      j.resize(2 * problem_.m(), 2 * problem_.m());
      j.topLeftCorner(m, m) =
          h_ * problem_.reduce_both((1 - s_) * (1 - s_) * e.z1.left_transpose_derivative(e.m1) -
                                    s_ * s_ * e.z0.left_transpose_derivative(e.m0));
      j.topLeftCorner(m, m).diagonal().array() -= 1;
      j.topRightCorner(m, m) = (1 - s_) * problem_.reduce_momentum(e.z1.right.transpose() * push1);
      j.bottomLeftCorner(m, m) = h_ * problem_.reduce_both((1 - s_) * e.z1.push_derivative(e.m1) +
                                                           s_ * e.z0.push_derivative(e.m0));
      j.bottomRightCorner(m, m) = problem_.reduce_momentum(push1);
    }

    void finish(const Unknown& x, Element& increment, Momentum& mu) const {
      const Vec<n> step = xi(x);
      increment =
          G::compose(G::inverse(Tau::tau(Vec<n>(-s_ * step))), Tau::tau(Vec<n>((1 - s_) * step)));
      mu = x.tail(directions());
    }

   private:
    // The retraction at both ends, and the end momenta carried to the base point.
    struct Ends {
      At<Tau> z0, z1;
      Vec<n> m0, m1;
      Ends(const Step& step, const Unknown& x)
          : z0(-step.s_ * step.xi(x)),
            z1((1 - step.s_) * step.xi(x)),
            m0(z0.push(step.problem_.momentum(step.mu_))),
            m1(z1.push(step.problem_.momentum(x.tail(step.directions())))) {}
    };
    void fill(const Unknown& x, const Ends& e, Unknown& f) const {
      const Vec<n> average =
          s_ * (e.z0.right.transpose() * e.m0) + (1 - s_) * (e.z1.right.transpose() * e.m1);
      f.head(directions()) = problem_.reduce(average) - x.head(directions());
      f.tail(directions()) = problem_.reduce(e.m1 - e.m0);
    }
    // m, known at compile time where it is.
    auto directions() const { return Eigen::fix<M>(problem_.m()); }

    Problem problem_;
    double s_, h_ = 0;
    Momentum mu_;
  };
};

}  // namespace hamel
