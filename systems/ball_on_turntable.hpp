// ball_on_turntable: a homogeneous ball that rolls without slipping on a turning table.
//
//   SO(3) x R^2, xi = (omega in the body, x', y'), table turning at Omega about the origin:
//   l = 1/2 I |omega|^2 + 1/2 m (x'^2 + y'^2),  with w = R omega in space:
//   x' - rho w_y = -Omega y,   y' + rho w_x = Omega x       (affine).
// The centre's velocity turns at the constant rate k = Omega I/(I + m rho^2) (2/7 of the table's
// for a solid ball, 2/5 for a shell), w_z is constant, and R follows from w. The moving energy E -
// Omega (m (x y' - y x') + I w_z) is conserved. Source: Earnshaw 1844; Weltner, Am. J. Phys. 47
// (1979); Fasso and Sansonetto 2016 (moving energy).
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/groups/dexp.hpp>
#include <hamel/systems/ball_on_plane.hpp>
#include <hamel/systems/reconstruction.hpp>

namespace hamel {

struct BallOnTurntable {
  using Group = ball_on_plane::Group;
  using Element = Group::Element<double>;
  double mass = 1.0;        // kg
  double radius = 0.5;      // m
  double moment = 0.1;      // kg m^2, 2/5 m rho^2
  double table_rate = 1.0;  // rad/s

  static std::string name() { return "ball_on_turntable"; }
  static std::string summary() { return "ball that rolls on a turning table (affine constraint)"; }
  static std::string formula() {
    return "SO(3)*R2, l = 1/2 I |w|^2 + 1/2 m |x'|^2, x' - rho w_y = -Omega y, y' + rho w_x = "
           "Omega x";
  }
  static std::string known() {
    return "everything: the velocity turns at Omega I/(I + m rho^2); invariants: spin about the "
           "vertical, moving energy";
  }
  static std::string source() { return "Earnshaw 1844; Weltner 1979; Fasso and Sansonetto 2016"; }
  static std::vector<std::string> shape() { return {"x", "y"}; }

  void fields(auto& f) {
    f("mass", mass, "kg", "total mass", positive);
    f("radius", radius, "m", "radius of the ball", positive);
    f("inertia", moment, "kg m^2", "moment about the centre", positive);
    f("table_rate", table_rate, "rad/s", "angular velocity of the table");
  }
  Mat<5, 5> inertia() const { return ball_on_plane::inertia(Vec<3>::Constant(moment), mass); }
  auto constraints(const auto& g) const { return ball_on_plane::contact_velocity(g, radius); }
  auto drift(const auto& g) const {
    const auto& x = g.template part<1>();
    using T = std::decay_t<decltype(x[0])>;
    return VecT<T, 2>(-table_rate * x[1], table_rate * x[0]);
  }
  Start start() const {
    return {.configuration = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0.8, 0},
            .velocity = {0.2, 1.5, 0.3, 0.75, 0.7},
            .momentum = {}};
  }

  /// (x, x', w in space) at t.
  struct Centre {
    Vec<2> x0, v0;
    double k, rate, radius, spin;
    Vec<2> velocity(double t) const {
      const double c = std::cos(k * t), s = std::sin(k * t);
      return {c * v0[0] - s * v0[1], s * v0[0] + c * v0[1]};
    }
    Vec<2> position(double t) const {
      return x0 + t * sinc(0.25 * k * k * t * t) * velocity(0.5 * t);  // a chord of the circle
    }
    Vec<3> omega(double t) const {
      const Vec<2> x = position(t), v = velocity(t);
      return {(rate * x[0] - v[1]) / radius, (v[0] + rate * x[1]) / radius, spin};
    }
  };
  auto exact(const Element& g0, const Vec<5>& xi0) const {
    const Mat<3, 3> r0 = g0.part<0>();
    const Vec<3> w0 = r0 * xi0.head<3>();
    const Centre centre{
        g0.part<1>(), xi0.tail<2>(), table_rate * moment / (moment + mass * radius * radius),
        table_rate,   radius,        w0[2]};
    // (R^T)' = R^T (-w^).
    const auto turning = [centre](double t) { return Vec<3>(-centre.omega(t)); };
    const double fastest = w0.norm() + std::abs(table_rate) * (1 + centre.x0.norm() / radius) + 1;
    Reconstruction<SO3, decltype(turning)> path(Mat<3, 3>(r0.transpose()), turning, 0.01 / fastest);
    return [centre, path](double t) mutable {
      const Mat<3, 3> r = path(t).first.transpose();
      Element g;
      g.part<0>() = r;
      g.part<1>() = centre.position(t);
      Vec<5> xi;
      xi << r.transpose() * centre.omega(t), centre.velocity(t);
      return std::pair{g, xi};
    };
  }
  void invariants(auto& add) const {
    add("spin about the vertical", [](const auto& g, const Vec<5>& xi) {
      return (g.template part<0>() * xi.template head<3>()).eval()[2];
    });
    add("moving energy", [*this](const auto& g, const Vec<5>& xi) {
      const auto& x = g.template part<1>();
      const double spin = (g.template part<0>() * xi.template head<3>()).eval()[2];
      return 0.5 * xi.dot(inertia() * xi) -
             table_rate * (mass * (x[0] * xi[4] - x[1] * xi[3]) + moment * spin);
    });
  }
  void draw(auto& scene) const { ball_on_plane::draw(scene, radius); }
};

}  // namespace hamel
