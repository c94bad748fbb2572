// A run of my_name. With the name of a file, .csv, .h5 or .json, its states are written there.
#include <iostream>

#include "my_name.hpp"

int main(int argc, char** argv) {
  const auto result = hamel::simulate(MyName{}).until(10).run();
  std::cout << result.report();
  if (argc > 1) result.write(argv[1]);
  return result ? 0 : 1;
}
