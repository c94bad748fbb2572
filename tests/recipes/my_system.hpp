// A free particle on MyGroup: l = 1/2 mass |xi|^2.
#pragma once

#include <string>

#include <hamel/framework/mechanics/system.hpp>
#include <hamel/groups/my_map.hpp>

namespace hamel {

struct MySystem {
  using Group = MyGroup;
  double mass = 1;  // kg
  static std::string name() { return "my_system"; }
  Mat<2, 2> inertia() const { return mass * Mat<2, 2>::Identity(); }
  void fields(auto& f) { f("mass", mass, "kg"); }
  Start start() const { return {.configuration = {}, .velocity = {0.3, 0.4}, .momentum = {}}; }
};

}  // namespace hamel
