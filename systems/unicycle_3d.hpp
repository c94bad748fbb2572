// unicycle_3d: a body in space that turns freely and moves only along its own first axis.
//
//   SE(3), xi = (omega, v), mass centre at the origin: l = 1/2 omega^T I omega + 1/2 m |v|^2,
//   v2 = v3 = 0.
// v1 is constant and omega moves as a free top: omega' = I^-1 (I omega x omega).
// Source: Bloch, Nonholonomic Mechanics and Control (2003), chapter 5 (left-invariant systems).
#pragma once

#include <string>

#include <hamel/framework/mechanics/system.hpp>
#include <hamel/groups/se3.hpp>

namespace hamel {

struct Unicycle3d {
  using Group = SE3;
  double mass = 1.0;                 // kg
  Vec<3> moments = {0.5, 1.0, 1.3};  // kg m^2

  static std::string name() { return "unicycle_3d"; }
  static std::string summary() { return "body in space that moves only along its own first axis"; }
  static std::string formula() { return "SE(3), l = 1/2 w' I w + 1/2 m |v|^2, v2 = v3 = 0"; }
  static std::string known() {
    return "v1 is constant, omega is a free top; invariants: v1, rotational energy, |I omega|^2";
  }
  static std::string source() { return "Bloch 2003, chapter 5"; }

  void fields(auto& f) {
    f("mass", mass, "kg", "total mass", positive);
    f("inertia", moments, "kg m^2", "principal moments", moments_of_inertia);
  }
  Mat<6, 6> inertia() const {
    Vec<6> d;
    d << moments, mass, mass, mass;
    return d.asDiagonal();
  }
  Mat<2, 6> constraints() const {
    Mat<2, 6> a = Mat<2, 6>::Zero();
    a(0, 4) = a(1, 5) = 1;
    return a;
  }
  Start start() const {
    return {.configuration = {}, .velocity = {0.8, 1.1, -0.3, 1, 0, 0}, .momentum = {}};
  }
  void invariants(auto& add) const {
    add("v1", [](const auto& /*g*/, const Vec<6>& xi) { return xi[3]; });
    add("rotational energy", [d = moments](const auto& /*g*/, const Vec<6>& xi) {
      return 0.5 * xi.template head<3>().dot(d.cwiseProduct(xi.template head<3>()));
    });
    add("|I omega|^2", [d = moments](const auto& /*g*/, const Vec<6>& xi) {
      return d.cwiseProduct(xi.template head<3>()).squaredNorm();
    });
  }
  void draw(auto& scene) const {
    scene
        .body("body",
              [](const auto& g) {
                return Placement{g.translation, g.rotation};
              },
              {shapes::box({0.6, 0.3, 0.15}), shapes::arrow({0.7, 0, 0}, {.color = "accent"})})
        .trail();
  }
};

}  // namespace hamel
