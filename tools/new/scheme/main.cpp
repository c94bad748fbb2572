// A run with my_name. With the name of a file, .csv, .h5 or .json, its states are written there.
#include <iostream>

#include "my_name.hpp"

int main(int argc, char** argv) {
  hamel::add_scheme<MyName>(hamel::registry());
  const auto result = hamel::simulate("falling_disk").scheme("my_name").step(1e-3).until(5).run();
  std::cout << result.report();
  if (argc > 1) result.write(argv[1]);
  return result ? 0 : 1;
}
