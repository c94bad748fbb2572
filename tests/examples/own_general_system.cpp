// A system whose constraint rows depend on the configuration: the nonholonomic particle, z' = y x',
// in a potential of the user's own. Registered, run by name and against its invariant x' sqrt(1 +
// y^2).
#include <hamel/hamel.hpp>

#include <cmath>
#include <iostream>

// [system]
struct Particle {
  using Group = hamel::Rn<3>;  // (x, y, z), xi its velocity
  double mass = 1;             // kg
  static std::string name() { return "my_particle"; }
  hamel::Mat<3, 3> inertia() const { return mass * hamel::Mat<3, 3>::Identity(); }
  hamel::Mat<1, 3> constraints(const hamel::Vec<3>& g) const { return {-g[1], 0, 1}; }
  // The last velocity by the others: spares explicit schemes the multipliers. May be left out.
  auto frame(const auto& g) const {
    using T = std::decay_t<decltype(g[1])>;
    return hamel::MatT<T, 1, 2>(g[1], T(0.0));
  }
  auto potential(const auto& g) const { return 1.0 - cos(g[1]); }  // found by argument: any scalar
  void invariants(auto& add) const {
    add("x' sqrt(1 + y^2)",
        [](const auto& g, const auto& xi) { return xi[0] * std::hypot(1, g[1]); });
  }
};
// [/system]

int main() {
  hamel::add_system<Particle>(hamel::registry());
  const auto simulation = hamel::simulate("my_particle")
                              .start({.configuration = {0, 0.5, 0}, .velocity = {1, 0.7, 0.5}})
                              .until(10);
  auto geometric = simulation, accurate = simulation;
  const auto result = geometric.compose("suzuki4").step(0.02).run();
  std::cout << result.report();
  const auto finer = accurate.tolerance({.relative = 1e-10}).run();  // dop853, in the frame
  std::cout << finer.report();
  return result && result.invariants[0].drift_max < 1e-6 && result.energy_error_max < 1e-6 &&
                 finer && finer.invariants[0].drift_max < 1e-9
             ? 0
             : 1;
}
