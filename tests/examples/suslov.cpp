#include <hamel/simulate.hpp>

#include <iostream>

int main(int argc, char** argv) {
  auto result = hamel::simulate("suslov")       // a registered name
                    .set("inertia", {2, 3, 4})  // kg m^2
                    .start({.momentum = {1, 1, 0}})
                    .scheme("lift")
                    .s(0.5)
                    .retraction(argc > 1 ? argv[1] : "cayley")
                    .solver("newton", {.tolerance = 1e-13})
                    .step(0.01)   // s
                    .until(1800)  // s
                    .every(100)   // record one state in a hundred
                    .run();
  std::cout << result.report();  // one screen: status, drifts, error against the exact motion
  result.write("suslov.csv");    // every recorded state, also after a failure
  return result && result.exact_velocity_error_max < 1e-12 ? 0 : 1;
}
