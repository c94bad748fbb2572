// heisenberg_particle: a free particle on the Heisenberg group with z' = (x y' - y x')/2.
//
//   Heisenberg group, xi = (x', y', z' - (x y' - y x')/2), l = 1/2 m |xi|^2, xi_3 = 0.
// xi is constant: the paths are one-parameter subgroups, straight lines in the (x, y) plane. (The
// vakonomic equations have helices instead.)
// Source: Bloch, Nonholonomic Mechanics and Control (2003), section 1.8.
#pragma once

#include <string>

#include <hamel/framework/mechanics/system.hpp>
#include <hamel/groups/heisenberg.hpp>
#include <hamel/systems/reconstruction.hpp>

namespace hamel {

struct HeisenbergParticle {
  using Group = Heisenberg;
  double mass = 1.0;  // kg

  static std::string name() { return "heisenberg_particle"; }
  static std::string summary() { return "free particle with z' = (x y' - y x')/2"; }
  static std::string formula() { return "Heisenberg group, l = 1/2 m |xi|^2, xi_3 = 0"; }
  static std::string known() { return "everything: xi is constant, straight lines"; }
  static std::string source() { return "Bloch 2003, section 1.8"; }

  void fields(auto& f) { f("mass", mass, "kg", "mass", positive); }
  Mat<3, 3> inertia() const { return Vec<3>::Constant(mass).asDiagonal(); }
  Mat<1, 3> constraints() const { return Mat<1, 3>{0, 0, 1}; }
  Start start() const {
    return {.configuration = {0.3, -0.2, 0}, .velocity = {1, 0.5, 0}, .momentum = {}};
  }
  auto exact(const Vec<3>& g0, const Vec<3>& xi0) const {
    return one_parameter_motion<Heisenberg>(g0, xi0);
  }
  void invariants(auto& add) const {
    add("xi1", [](const auto& /*g*/, const Vec<3>& xi) { return xi[0]; });
    add("xi2", [](const auto& /*g*/, const Vec<3>& xi) { return xi[1]; });
  }
  void draw(auto& scene) const {
    scene.body("particle", [](const auto& g) { return Placement{g}; }, {shapes::sphere(0.1)})
        .trail();
  }
};

}  // namespace hamel
