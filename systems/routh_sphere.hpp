// routh_sphere: a ball whose mass centre lies off its centre, on an axis of symmetry, rolling on a
// plane.
//
//   SO(3) x R^2, xi = (omega in the body, x', y' of the centre of the ball), mass centre at a e3,
//   l = 1/2 omega^T I omega + 1/2 m |(x', y', 0) + R (omega x a e3)|^2 - m g a gamma_3,
//   with w = R omega, gamma = R^T e_z:  x' = rho w_y,  y' = -rho w_x.
// The metric depends on R: it couples the rotation with the translation in space.
// Routh's sphere has I1 = I2. With r = -rho gamma - a e3 from the mass centre to the contact three
// functions are conserved there: the energy,
//   Jellett's omega^T I r   and   Routh's omega_3 sqrt(I1 I3 + m r^T I r).
// With three different moments it is Chaplygin's top, which keeps the energy and no other function
// in general. Source: Routh, Advanced Rigid Dynamics (1884), art. 243; Cushman, Routh's sphere,
// Rep. Math. Phys. 42 (1998); Borisov, Kazakov, Sataev, Regul. Chaotic Dyn. 19 (2014), on
// Chaplygin's top.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/systems/ball_on_plane.hpp>
#include <hamel/systems/energy.hpp>

namespace hamel {

struct RouthSphere {
  using Group = ball_on_plane::Group;
  using Element = Group::Element<double>;
  double mass = 1.0;         // kg
  double radius = 0.5;       // m
  double offset = 0.15;      // m, a
  double transverse = 0.12;  // kg m^2, I1, about the mass centre
  double asymmetry = 0;      // kg m^2, I2 - I1
  double axial = 0.08;       // kg m^2, I3
  double gravity = 9.81;     // m/s^2

  static std::string name() { return "routh_sphere"; }
  static std::string summary() { return "ball with its mass centre off the centre, on a plane"; }
  static std::string formula() {
    return "SO(3)*R2, l = 1/2 w' I w + 1/2 m |x' + R (w x a e3)|^2 - m g a gamma_3, "
           "x' = rho w_y, y' = -rho w_x (in space)";
  }
  static std::string known() {
    return "invariants: energy; Jellett's and Routh's where asymmetry is 0 (integrable)";
  }
  static std::string source() { return "Routh 1884, art. 243; Cushman 1998"; }
  static std::vector<std::string> shape() { return {"x", "y"}; }

  void fields(auto& f) {
    f("mass", mass, "kg", "total mass", positive);
    f("radius", radius, "m", "radius of the ball", positive);
    f("offset", offset, "m", "centre of the ball to mass centre, along the axis",
      between(-radius, radius));
    f("transverse_inertia", transverse, "kg m^2",
      "moment about e1, across the axis, about the mass centre", positive);
    f("asymmetry", asymmetry, "kg m^2",
      "moment about e2 minus that about e1 (Chaplygin's top; 0: Routh's sphere)",
      Range{.least = -transverse, .open = true});
    f("axial_inertia", axial, "kg m^2", "moment about the axis",
      axial_moment(transverse + asymmetry / 2));
    f("gravity", gravity, "m/s^2", "acceleration of gravity", non_negative);
  }
  // omega x a e3 = a (w2, -w1, 0).
  auto inertia(const auto& g) const {
    const auto& r = g.template part<0>();
    using T = std::decay_t<decltype(r(0, 0))>;
    MatT<T, 5, 5> i = MatT<T, 5, 5>::Zero();
    const double about_centre = transverse + mass * offset * offset;
    i.diagonal() << T(about_centre), T(about_centre + asymmetry), T(axial), T(mass), T(mass);
    for (int k = 0; k < 2; ++k) {
      i(0, 3 + k) = i(3 + k, 0) = -(mass * offset) * r(k, 1);
      i(1, 3 + k) = i(3 + k, 1) = (mass * offset) * r(k, 0);
    }
    return i;
  }
  /// Differential of m a (x' r_1 + y' r_2) . (w2, -w1, 0), r_i the rows of R: m a (w2, -w1, 0) x
  /// (x' r_1 + y' r_2).
  Vec<5> inertia_differential(const Element& g, const Vec<5>& xi) const {
    const Mat<3, 3>& r = g.part<0>();
    const Vec<3> along = r.topRows<2>().transpose().lazyProduct(xi.tail<2>());
    const Vec<3> across(xi[1], -xi[0], 0);
    Vec<5> d;
    d << mass * offset * across.cross(along), 0, 0;
    return d;
  }
  auto constraints(const auto& g) const { return ball_on_plane::contact_velocity(g, radius); }
  auto frame(const auto& g) const { return ball_on_plane::frame(g, radius); }
  auto frame_rate(const Element& g, const Vec<5>& xi) const {
    return ball_on_plane::frame_rate(g, xi, radius);
  }
  auto potential(const auto& g) const {
    return (mass * gravity * offset) * g.template part<0>()(2, 2);
  }
  /// The axis leaning by 0.5 rad, spinning.
  Start start() const {
    const double c = std::cos(0.5), s = std::sin(0.5);
    const Mat<3, 3> r{{1, 0, 0}, {0, c, -s}, {0, s, c}};
    const Vec<3> omega(0.5, 1.0, 4.0), w = r * omega;
    return {.configuration = {1, 0, 0, 0, c, -s, 0, s, c, 0, 0},
            .velocity = {omega[0], omega[1], omega[2], radius * w[1], -radius * w[0]},
            .momentum = {}};
  }
  void invariants(auto& add) const {
    add("energy", energy_of(*this));
    if (asymmetry != 0) return;
    const auto contact = [*this](const auto& g) {
      return Vec<3>(-radius * g.template part<0>().row(2).transpose() - offset * Vec<3>::UnitZ());
    };
    const Vec<3> moments(transverse, transverse, axial);
    add("Jellett", [=](const auto& g, const Vec<5>& xi) {
      return contact(g).dot(moments.cwiseProduct(xi.template head<3>()));
    });
    add("Routh", [=, *this](const auto& g, const Vec<5>& xi) {
      const Vec<3> r = contact(g);
      return xi[2] * std::sqrt(transverse * axial + mass * r.dot(moments.cwiseProduct(r)));
    });
  }
  void draw(auto& scene) const {
    ball_on_plane::draw(scene, radius, {shapes::arrow({0, 0, 1.3 * radius}, {.color = "accent"})},
                        {0, 0, offset});
  }
};

}  // namespace hamel
