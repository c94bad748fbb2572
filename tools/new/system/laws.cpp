// Holds my_name to the laws of a system.
#include <iostream>

#include <hamel/framework/check/system_laws.hpp>

#include "my_name.hpp"

int main() {
  bool good = true;
  for (const hamel::LawResult& law : hamel::check_system(MyName{})) {
    std::cout << law << "\n";
    good = good && law.passed();
  }
  return good ? 0 : 1;
}
