// veselova: a rigid body whose angular velocity along a direction fixed in space is forbidden.
//
//   SO(3), l = 1/2 omega^T I omega, omega.gamma = 0 with gamma = R^T e_z.
// Conserved: the energy, and |K|^2 with K = I omega - (I omega.gamma) gamma (K turns in the body
// only). Source: Veselova 1986; Veselov and Veselova 1988; Fedorov and Jovanovic 2004.
#pragma once

#include <string>

#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/groups/so3.hpp>

namespace hamel {

struct Veselova {
  using Group = SO3;
  using Element = SO3::Element<double>;
  Vec<3> moments = {1.0, 2.0, 2.5};  // kg m^2

  static std::string name() { return "veselova"; }
  static std::string summary() { return "rigid body with one forbidden direction fixed in space"; }
  static std::string formula() { return "SO(3), l = 1/2 w' I w, w.(R' e_z) = 0"; }
  static std::string known() { return "invariants: energy, |I w - (I w.gamma) gamma|^2"; }
  static std::string source() { return "Veselova 1986; Fedorov and Jovanovic 2004"; }

  void fields(auto& f) { f("inertia", moments, "kg m^2", "principal moments", moments_of_inertia); }
  Mat<3, 3> inertia() const { return moments.asDiagonal(); }
  auto constraints(const auto& r) const { return r.row(2).eval(); }
  Start start() const { return {.configuration = {}, .velocity = {1, 0.6, 0}, .momentum = {}}; }
  void invariants(auto& add) const {
    add("energy", [d = moments](const auto& /*r*/, const Vec<3>& w) {
      return 0.5 * w.dot(d.cwiseProduct(w));
    });
    add("|K|^2", [d = moments](const auto& r, const Vec<3>& w) {
      const Vec<3> gamma = r.row(2).transpose(), momentum = d.cwiseProduct(w);
      return momentum.squaredNorm() - std::pow(momentum.dot(gamma), 2);
    });
  }
  void draw(auto& scene) const {
    scene
        .body("body",
              [](const auto& r) {
                return Placement{Vec<3>::Zero(), r};
              },
              {shapes::box({1.2, 0.8, 0.4}), shapes::arrow({1, 0, 0}, {.color = "accent"})})
        .trail({1, 0, 0});
  }
};

}  // namespace hamel
