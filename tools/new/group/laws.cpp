// Holds my_name and its retraction to the laws of groups and of retractions.
#include <iostream>

#include <hamel/framework/check/group_laws.hpp>
#include <hamel/framework/check/retraction_laws.hpp>

#include "my_name.hpp"

int main() {
  bool good = true;
  for (const auto& laws : {hamel::check_group<MyName>(), hamel::check_retraction<MyNameExp>()}) {
    for (const hamel::LawResult& law : laws) {
      std::cout << law << "\n";
      good = good && law.passed();
    }
  }
  return good ? 0 : 1;
}
