// my_name: a sledge on a plane, whose runner does not slip sideways. Your system in its place: all
// members that a system may have are listed in hamel's systems/README.md.
//
//   SE(2), xi = (omega, v1, v2) at the runner; the mass centre is `offset` ahead of it:
//   l = 1/2 moment omega^2 + 1/2 mass (v1^2 + (v2 + offset omega)^2),  v2 = 0.
#pragma once

#include <string>

#include <hamel/hamel.hpp>

struct MyName {
  using Group = hamel::SE2;
  double mass = 1, moment = 0.1, offset = 0.2;  // kg, kg m^2 about the mass centre, m

  static std::string name() { return "my_name"; }
  hamel::Mat<3, 3> inertia() const {
    const double arm = mass * offset;
    return hamel::Mat<3, 3>{{moment + arm * offset, 0, arm}, {0, mass, 0}, {arm, 0, mass}};
  }
  hamel::Mat<1, 3> constraints() const { return {0, 0, 1}; }
  hamel::Start start() const {
    return {.configuration = {0, 0, 0}, .velocity = {2, 0.5, 0}, .momentum = {}};
  }
  void fields(auto& f) {
    f("mass", mass, "kg");
    f("moment", moment, "kg m^2");
    f("offset", offset, "m");
  }
  void draw(auto& scene) const {
    scene.from_above();
    scene
        .body("sledge", [](const auto& g) { return hamel::planar(g, 0.05); },
              {hamel::shapes::box({0.6, 0.3, 0.1}, {.at = {offset, 0, 0}})})
        .trail();
  }
};
