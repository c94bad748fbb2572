// A scheme of your own, used by name beside the library's on every left-invariant system.
#include <algorithm>
#include <cmath>
#include <iostream>

#include <hamel/hamel.hpp>

// The equations of motion I xi' = ad*_xi I xi + A^T lambda by the implicit midpoint rule; the
// configuration follows by g_{k+1} = g_k tau(h w) with the mean velocity w = (xi_k + xi_{k+1})/2,
// which is the unknown:
//   E^T ( 2 I (w - xi_k) - h ad*_w I w ) = 0,   A w = 0,   xi_{k+1} = 2 w - xi_k.
// (ad*_w I w).w = I w.[w, w] = 0: the energy is kept. (Celledoni and others, Energy-preserving
// integrators and the structure of B-series.)
struct ReducedMidpoint : hamel::SchemeDefaults {
  static std::string name() { return "reduced_midpoint"; }
  static std::string formula() { return "I (xi_1 - xi_0) = h ad*_w I w + A' lambda, w the mean"; }
  static std::string source() { return "implicit midpoint rule on the reduced equations"; }
  static constexpr bool left_invariant_only = true;
  static hamel::ClaimedOrder claim(double /*s*/, hamel::TauTraits tau, bool /*left_invariant*/) {
    return {tau.symmetric ? 2 : 1, tau.symmetric};
  }

  template <class P>
  class Step {
   public:
    using Problem = P;
    using Unknown = typename P::State;
    using Jacobian = typename P::StateMatrix;
    using Node = hamel::Node<P>;

    Step(const P& problem, double /*s*/) : problem_(problem) {}
    int size() const { return problem_.state_size(); }
    void begin(const Node& node, double h) {
      from_ = &node;
      h_ = h;
      place_.set(problem_, node.t, node.g);  // I and A there
      problem_.momentum(place_.inertia, node.x, mu0_);
    }
    void guess(Unknown& x) const { x = from_->x; }
    double scale_squared() const { return 4 * std::pow(place_.size(mu0_), 2); }
    void expand(Unknown& z) const { place_.expand(z); }
    void residual(const Unknown& x, Unknown& f) const {
      problem_.velocity(x, w_);
      problem_.momentum(place_.inertia, x, mu_);
      problem_.ad_transpose(w_, mu_, r_);
      r_ = 2 * (mu_ - mu0_) - h_ * r_;
      rows_ = place_.a * w_;
      place_.assemble(r_, rows_, f);  // 0 where r is a reaction and A w = 0
    }
    bool finish(const Unknown& x, Node& next) const {
      problem_.velocity(x, w_);
      w_ *= h_;
      if (!problem_.in_domain(w_)) return false;
      problem_.tau(w_, f_);
      next.t = from_->t + h_;
      problem_.compose(from_->g, f_, next.g);
      next.x = 2 * x - from_->x;
      return true;
    }

   private:
    P problem_;
    mutable typename P::Metric place_{problem_};
    const Node* from_ = nullptr;
    double h_ = 0;
    mutable typename P::Vector w_{problem_.dim()}, mu_ = w_, r_ = w_;
    typename P::Vector mu0_ = w_;
    mutable typename P::Multipliers rows_{problem_.constraint_count()};
    mutable typename P::Element f_ = problem_.element();
  };
};

int main() {
  hamel::add_scheme<ReducedMidpoint>(hamel::registry());
  auto suslov =
      hamel::simulate("suslov")
          .set("inertia", {2, 0.3, 0.5, 3, 0.4, 4})
          .start({.velocity = {1, 0.5, 0}})
          .solver("newton", {.tolerance = 1e-15})  // energy is conserved as far as F = 0 is solved
          .until(20);
  double error[2], energy = 0;
  for (const double step : {0.02, 0.01}) {
    const auto result = suslov.scheme("reduced_midpoint").step(step).run();
    error[step < 0.015] = result.exact_error_final;
    energy = std::max(energy, result.energy_error_max);
    if (step < 0.015) std::cout << result.report();
  }
  const auto lift = suslov.scheme("lift").run();
  const double order = std::log2(error[0] / error[1]);
  std::cout << "order " << order << ", energy error " << energy
            << " (lift: " << lift.energy_error_max << "), configuration error " << error[1]
            << " (lift: " << lift.exact_error_final << ")\n";
  const bool good = std::abs(order - 2) < 0.05 && energy < 1e-12;
  if (!good) std::cerr << "own_scheme: expected order 2 and the energy kept to 1e-12\n";
  return good ? 0 : 1;
}
