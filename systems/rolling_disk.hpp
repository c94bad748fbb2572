// rolling_disk: an upright disk that rolls on a plane without slipping.
//
//   SE(2) x SO(2), xi = (omega, v1, v2, phi'), e1 along the rolling direction:
//   l = 1/2 J_yaw omega^2 + 1/2 m (v1^2 + v2^2) + 1/2 J_spin phi'^2,   v1 = R phi',  v2 = 0.
// omega and phi' are constant, so the motion is one-parameter, g(t) = g0 exp(t xi): the contact
// point runs on a circle of radius R phi'/omega. Source: Bloch, Nonholonomic Mechanics and Control
// (2003), section 1.4.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include <hamel/framework/mechanics/system.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/groups/so2.hpp>
#include <hamel/systems/reconstruction.hpp>

namespace hamel {

struct RollingDisk {
  using Group = Product<SE2, SO2>;
  double mass = 1.0;            // kg
  double radius = 0.5;          // m
  double spin_inertia = 0.125;  // kg m^2, about the axle
  double yaw_inertia = 0.0625;  // kg m^2, about the vertical

  static std::string name() { return "rolling_disk"; }
  static std::string summary() { return "upright disk that rolls on a plane"; }
  static std::string formula() {
    return "SE(2)*SO(2), l = 1/2 J_yaw w^2 + 1/2 m |v|^2 + 1/2 J_spin phi'^2, v1 = R phi', v2 = 0";
  }
  static std::string known() {
    return "everything: omega and phi' are constant, the contact point runs on a circle of radius "
           "R phi'/omega";
  }
  static std::string source() { return "Bloch 2003, section 1.4"; }
  static std::vector<std::string> shape() { return {"roll"}; }

  void fields(auto& f) {
    f("mass", mass, "kg", "total mass", positive);
    f("radius", radius, "m", "radius of the disk", positive);
    f("spin_inertia", spin_inertia, "kg m^2", "moment about the axle", axial_moment(yaw_inertia));
    f("yaw_inertia", yaw_inertia, "kg m^2", "moment about the vertical", positive);
  }
  Mat<4, 4> inertia() const { return Vec<4>(yaw_inertia, mass, mass, spin_inertia).asDiagonal(); }
  Mat<2, 4> constraints() const { return Mat<2, 4>{{0, 1, 0, -radius}, {0, 0, 1, 0}}; }
  Start start() const {
    return {.configuration = {}, .velocity = {0.7, 2 * radius, 0, 2}, .momentum = {}};
  }
  template <class V = Vec<4>>
  auto exact(const Group::Element<double>& g0, const std::type_identity_t<V>& xi0) const {
    return one_parameter_motion<Group>(g0, xi0);
  }
  void invariants(auto& add) const {
    add("yaw rate omega", [](const auto& /*g*/, const Vec<4>& xi) { return xi[0]; });
    add("spin rate phi'", [](const auto& /*g*/, const Vec<4>& xi) { return xi[3]; });
  }
  void draw(auto& scene) const {
    scene.floor();
    scene
        .body("disk",
              [r = radius](const auto& g) {
                const auto& contact = g.template part<0>();
                const double roll = g.template part<1>().angle();
                Placement p = planar(contact, r);
                // The axle (e3 of the disk) lies along e2 of the heading; it rolls towards e1.
                const double c = std::cos(roll), s = std::sin(roll);
                p.rotation = p.rotation * Mat<3, 3>{{s, c, 0}, {0, 0, 1}, {c, -s, 0}};
                return p;
              },
              {shapes::cylinder(radius, 0.05 * radius)})
        .trail({0, 0, 0});
  }
};

}  // namespace hamel
