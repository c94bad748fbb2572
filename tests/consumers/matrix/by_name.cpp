// A user's program that runs a system by name, and another unit of it that uses Eigen on its own account.
#include <cstdio>

#include <hamel/hamel.hpp>

double second_unit(int n);  // n, by Eigen's ways

int main() {
  bool good = true;
  for (const char* name : {"suslov", "falling_disk", "se2*so2"}) {
    try {
      const auto result = hamel::simulate(name).step(0.01).until(1).run();
      good = good && static_cast<bool>(result);
      std::printf("%s", name);
      for (const double x : result.last.velocity) std::printf(" %.17g", x);
      std::printf("\n");
    } catch (const hamel::ConfigError& error) {  // the library's exception, caught here
      good = good && name == std::string("se2*so2") && error.mistakes().size() == 1;
    }
  }
  return good && second_unit(40) == 40 ? 0 : 1;
}
