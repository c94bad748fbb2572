// A run on my_name. With the name of a file, .csv, .h5 or .json, its states are written there.
#include <iostream>

#include "my_name.hpp"

struct Particle {  // l = 1/2 |xi|^2, xi3 = 0
  using Group = MyName;
  static std::string name() { return "particle_on_my_name"; }
  hamel::Mat<3, 3> inertia() const { return hamel::Mat<3, 3>::Identity(); }
  hamel::Mat<1, 3> constraints() const { return {0, 0, 1}; }
};

int main(int argc, char** argv) {
  hamel::add_group<MyName>(hamel::registry());
  const auto result = hamel::simulate(Particle{})
                          .start({.configuration = {1, 0, 0}, .velocity = {0.3, 0.4, 0}})
                          .retraction("exp")
                          .until(10)
                          .run();
  std::cout << result.report();
  if (argc > 1) result.write(argv[1]);
  return result ? 0 : 1;
}
