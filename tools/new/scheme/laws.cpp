// Holds my_name to what it claims on all registered systems: order, constraints, group, reversal.
#include <iostream>

#include <hamel/framework/check/scheme_laws.hpp>

#include "my_name.hpp"

int main() {
  int held = 0, failed = 0;
  for (const hamel::LawResult& law : hamel::check_scheme<MyName>(hamel::registry())) {
    if (!law.passed()) std::cout << law << "\n";
    ++(law.passed() ? held : failed);
  }
  std::cout << held << " laws hold, " << failed << " fail\n";
  return held > 0 && failed == 0 ? 0 : 1;
}
