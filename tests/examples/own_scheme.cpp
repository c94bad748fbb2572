// A scheme of your own, compiled for groups of your choice and used by name beside the library's.
#include <algorithm>
#include <cmath>
#include <iostream>

#include <hamel/hamel.hpp>

// The reduced equations mu_bar' = E^T ad*_Omega I Omega, Omega = E mu_bar, by the implicit midpoint
// rule; the configuration follows by g_{k+1} = g_k tau(h Omega) with the mean velocity.
//   F(y) = 2 (y - mu_bar_k) - h E^T (ad_{E y})^T I E y = 0,   mu_bar_{k+1} = 2 y - mu_bar_k.
// E^T I E = Id makes the energy |mu_bar|^2/2, and y . E^T (ad_{E y})^T I E y = (I E y).[E y, E y] = 0:
// the energy is conserved. (Celledoni and others, Energy-preserving integrators and the structure of B-series.)
struct ReducedMidpoint {
  static std::string name() { return "reduced_midpoint"; }
  static std::string formula() {
    return "mu_{k+1} - mu_k = h E' ad*_W I W, W = E (mu_k + mu_{k+1})/2";
  }
  static std::string source() { return "implicit midpoint rule on the reduced equations"; }
  static constexpr bool adapted = true;  // stays in d: the kernels get E with columns in d
  static constexpr bool uses_s = false;
  static hamel::ClaimedOrder claimed_order(double /*s*/, bool symmetric_tau) {
    return {symmetric_tau ? 2 : 1, symmetric_tau};
  }

  template <class Problem, class Tau>
  class Step {
   public:
    using G = typename Problem::Group;
    using Element = typename G::template Element<double>;
    using Velocity = hamel::Vec<Problem::n>;
    using Unknown = typename Problem::Reduced;
    using Jacobian = typename Problem::ReducedMatrix;
    using Momentum = typename Problem::Reduced;

    Step(const Problem& problem, double /*s*/) : problem_(problem) {}
    void begin(const Momentum& mu, double h) {
      mu_ = mu;
      h_ = h;
    }
    Unknown guess() const { return mu_; }
    double scale_squared() const { return 4 * mu_.squaredNorm(); }
    Velocity xi(const Unknown& y) const { return h_ * problem_.velocity(y); }

    void residual(const Unknown& y, Unknown& f) const {
      const Velocity w = problem_.velocity(y), p = problem_.momentum(y);
      f = 2 * (y - mu_) - h_ * problem_.reduce(G::ad(w).transpose() * p);
    }
    void linearise(const Unknown& y, Unknown& f, Jacobian& j) const {
      residual(y, f);
      const Velocity w = problem_.velocity(y), p = problem_.momentum(y);
      // d (ad_w)^T p = coad(p) dw + (ad_w)^T dp
      j = -h_ * (problem_.reduce_both(G::coad(p)) + problem_.reduce_momentum(G::ad(w).transpose()));
      j.diagonal().array() += 2;
    }
    void finish(const Unknown& y, Element& increment, Momentum& mu) const {
      increment = Tau::tau(xi(y));
      mu = 2 * y - mu_;
    }

   private:
    Problem problem_;
    double h_ = 0;
    Momentum mu_;
  };
};

int main() {
  hamel::add_scheme<ReducedMidpoint, hamel::SO3, hamel::SE2>(hamel::registry());
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
