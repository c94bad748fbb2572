// suslov_in_potential: the Suslov body in a uniform field.
//
//   SO(3), l = 1/2 Omega^T I Omega - w.gamma, gamma = R^T e_z, n.Omega = 0, n = e3.
// w = m g (body vector from the fixed point to the mass centre). The energy is conserved.
// Source: Kozlov 1988; Borisov and Mamaev, The dynamics of the Suslov problem (2011).
#pragma once

#include <string>

#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/groups/so3.hpp>
#include <hamel/systems/energy.hpp>

namespace hamel {

struct SuslovInPotential {
  using Group = SO3;
  Vec<6> moments = Vec<6>(Eigen::Map<const Vec<6>>(kMoments));  // kg m^2, upper triangle
  Vec<3> weight = {1, 0.5, 2};                                  // N m

  static std::string name() { return "suslov_in_potential"; }
  static std::string summary() { return "Suslov's body under gravity"; }
  static std::string formula() { return "SO(3), l = 1/2 Omega' I Omega - w.(R' e_z), Omega_3 = 0"; }
  static std::string known() { return "invariants: energy"; }
  static std::string source() { return "Kozlov 1988; Borisov and Mamaev 2011"; }

  void fields(auto& f) {
    f("inertia", moments, "kg m^2", "the 6 entries of the upper triangle", moments_of_inertia);
    f("weight", weight, "N m", "weight times the body vector to the mass centre");
  }
  Mat<3, 3> inertia() const {
    const auto& v = moments;
    return Mat<3, 3>{{v[0], v[1], v[2]}, {v[1], v[3], v[4]}, {v[2], v[4], v[5]}};
  }
  Mat<1, 3> constraints() const { return Mat<1, 3>{0, 0, 1}; }
  auto potential(const auto& r) const {
    return weight[0] * r(2, 0) + weight[1] * r(2, 1) + weight[2] * r(2, 2);
  }
  Start start() const { return {.configuration = {}, .velocity = {1, 0.5, 0}, .momentum = {}}; }
  void invariants(auto& add) const { add("energy", energy_of(*this)); }
  void draw(auto& scene) const {
    const Vec<3> to = weight.normalized();
    scene
        .body(
            "body",
            [](const auto& r) {
              return Placement{Vec<3>::Zero(), r};
            },
            {shapes::box({1.2, 0.8, 0.4}), shapes::arrow({to[0], to[1], to[2]}, {.color = "dark"}),
             shapes::arrow({0, 0, 1}, {.color = "accent"})})
        .trail({to[0], to[1], to[2]});
  }

 private:
  static constexpr double kMoments[6] = {2, 0.3, 0.5, 3, 0.4, 4};
};

}  // namespace hamel
