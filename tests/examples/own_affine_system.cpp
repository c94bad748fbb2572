// A system whose constraint depends on the configuration and is affine: a skate on a turning table,
// held to its centre by a spring. Nothing but physics is stated; the gradient of V is automatic.
#include <hamel/hamel.hpp>

#include <cmath>
#include <iostream>

// [system]
struct SkateOnTurntable {
  using Group = hamel::SE2;  // xi = (omega, v1, v2), the blade along e1
  double mass = 1, inertia_about_blade = 0.1, table_rate = 0.5,
         spring = 2;  // kg, kg m^2, rad/s, N/m
  static std::string name() { return "skate_on_turntable"; }
  hamel::Mat<3, 3> inertia() const {
    return hamel::Vec<3>(inertia_about_blade, mass, mass).asDiagonal();
  }
  // The blade does not slip across the table, which moves with rate e_z x position below it.
  auto constraints() const { return hamel::Mat<1, 3>{0, 0, 1}; }
  hamel::Vec<1> drift(double /*t*/, const auto& g) const {
    const auto& x = g.translation;
    const double c = std::cos(g.angle()), s = std::sin(g.angle());
    return hamel::Vec<1>(table_rate * (c * x[0] + s * x[1]));  // (-y, x).e2, e2 = (-s, c)
  }
  auto potential(const auto& g) const { return 0.5 * spring * g.translation.squaredNorm(); }
  void fields(auto& f) {
    f("table_rate", table_rate, "rad/s");
    f("spring", spring, "N/m");
  }
};
// [/system]

int main() {
  const auto run = [](double h) {
    return hamel::simulate(SkateOnTurntable{})
        .start({.configuration = {0.3, 1, 0}, .velocity = {0.8, 0.5, 0}})
        .step(h)
        .until(4)
        .run();
  };
  const auto coarse = run(0.02), fine = run(0.01), finest = run(0.005);
  std::cout << fine.report();
  const auto apart = [](const hamel::Result& a, const hamel::Result& b) {
    return std::hypot(a.last.coordinates[1] - b.last.coordinates[1],
                      a.last.coordinates[2] - b.last.coordinates[2]);
  };
  const double order = std::log2(apart(coarse, fine) / apart(fine, finest));
  std::cout << "order " << order << "\n";
  return finest && std::abs(order - 2) < 0.05 && finest.constraint_max < 1e-11 ? 0 : 1;
}
