// A system of your own states its physics, nothing else. Run by object, by name, and compiled
// whole.
#include <algorithm>
#include <cmath>
#include <iostream>

#include <hamel/hamel.hpp>

// [the system: at most 15 lines]
struct Arrow {  // a body in space, free to turn, that flies along its own axis e1: v2 = v3 = 0
  using Group = hamel::SE3;
  hamel::Vec<3> moments = {1, 2, 3};  // kg m^2
  double mass = 2;                    // kg
  static std::string name() { return "arrow"; }
  hamel::Mat<6, 6> inertia() const {  // l = 1/2 w.Jw + 1/2 m |v|^2,  xi = (w, v)
    return (hamel::Vec<6>() << moments, mass, mass, mass).finished().asDiagonal();
  }
  auto constraints() const { return hamel::Mat<2, 6>{{0, 0, 0, 0, 1, 0}, {0, 0, 0, 0, 0, 1}}; }
  void fields(auto& f) {
    f("moments", moments, "kg m^2");
    f("mass", mass, "kg");
  }
};
// [end]

int main() {
  const hamel::Start start = {.velocity = {1, 0.2, -0.4, 0.5, 0, 0}};
  hamel::add_system<Arrow>(hamel::registry());  // for the run by name
  const auto by_object = hamel::simulate(Arrow{.mass = 3}).start(start).step(0.01).until(10).run();
  const auto by_name =
      hamel::simulate("arrow").set("mass", 3).start(start).step(0.01).until(10).run();
  const auto compiled =
      hamel::simulate<hamel::Lift, hamel::Cayley>(Arrow{.mass = 3}).start(start).until(10).run();
  std::cout << compiled.report();

  double apart = 0, drift = 0;
  for (size_t i = 0; i < 6; ++i) {
    apart = std::max({apart, std::abs(by_object.last.velocity[i] - by_name.last.velocity[i]),
                      std::abs(compiled.last.velocity[i] - by_name.last.velocity[i])});
  }
  // v1 is constant, and the rotation is that of a free body.
  for (double v1 : compiled.trajectory.column("xi4")) drift = std::max(drift, std::abs(v1 - 0.5));
  std::cout << "three ways apart by " << apart << ", v1 moves by " << drift << "\n";
  const bool good = by_object && by_name && compiled && apart < 1e-11 && drift < 1e-11;
  if (!good) std::cerr << "own_system: expected both below 1e-11\n";
  return good ? 0 : 1;
}
