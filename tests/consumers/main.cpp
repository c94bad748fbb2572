// A user's program: the builder by name, and a system of their own.
#include <iostream>

#include <hamel/hamel.hpp>

struct ChaplyginSleigh {  // v2 = 0 at the blade
  using Group = hamel::SE2;
  double m = 1.0, J = 0.1, a = 0.2;  // kg, kg m^2, m
  auto inertia() const {
    return hamel::Mat<3, 3>{{J + m * a * a, 0, m * a}, {0, m, 0}, {m * a, 0, m}};
  }
  auto constraints() const { return hamel::Mat<1, 3>{0, 0, 1}; }
  void fields(auto& f) {
    f("m", m, "kg");
    f("J", J, "kg m^2");
    f("a", a, "m");
  }
};

int main() {
  const auto named = hamel::simulate("suslov").step(0.01).until(1).run();
  std::cout << named.report();
  const auto own = hamel::simulate(ChaplyginSleigh{.a = 0.3})
                       .start({.velocity = {0.9, 1, 0}})
                       .step(0.01)
                       .until(1)
                       .run();
  std::cout << own.report();
  return named && own ? 0 : 1;
}
