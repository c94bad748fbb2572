// A run of my_name.toml, in the folder where the program is started. With the name of a file, .csv,
// .h5 or .json, its states are written there.
#include <iostream>

#include <hamel/simulate.hpp>

int main(int argc, char** argv) {
  try {
    const auto result = hamel::simulate("my_name.toml").until(8).run();
    std::cout << result.report();
    if (argc > 1) result.write(argv[1]);
    return result ? 0 : 1;
  } catch (const hamel::ConfigError& error) {  // every mistake, with the nearest valid name
    std::cerr << error.what() << "\n";
    return 2;
  }
}
