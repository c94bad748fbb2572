// falling_disk: a thin disk that rolls on a plane without slipping, free to lean and fall.
//
//   SE(3), body frame at the centre with axis e3, plane z = 0, z up; xi = (omega, v) of the centre.
//   l = 1/2 A (w1^2 + w2^2) + 1/2 C w3^2 + 1/2 m |v|^2 - m g z.
// With gamma = R^T e_z and r = -rho (gamma - gamma_3 e3)/|...| from the centre to the contact, the
// contact rests: v + omega x r = 0. Its two horizontal parts are rows of A; the vertical one is the
// differential of
//   phi = z - rho sqrt(gamma_1^2 + gamma_2^2) = 0.
// Steady motions (theta axis to vertical, alpha precession rate about the vertical, w3 the spin
// about the axis):
//   (C + m rho^2) w3 alpha sin(theta) = A alpha^2 sin(theta) cos(theta) - m g rho cos(theta).
// Upright rolling is stable when w3^2 > A m g rho / (C (C + m rho^2)); upright spinning when
// w^2 > m g rho / (A + m rho^2).
// With friction the contact slides, opens and strikes (mechanics/contact_law.hpp).
// Source: Neimark and Fufaev, Dynamics of Nonholonomic Systems (1972), ch. V; O'Reilly, Nonlinear
// Dyn. 10 (1996).
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/systems/body_on_plane.hpp>
#include <hamel/systems/energy.hpp>
#include <hamel/systems/friction.hpp>

namespace hamel {

struct FallingDisk {
  using Group = SE3;
  using Element = SE3::Element<double>;
  double mass = 1.0;                  // kg
  double radius = 0.5;                // m
  double axial_inertia = 0.125;       // kg m^2, C
  double diametral_inertia = 0.0625;  // kg m^2, A
  double gravity = 9.81;              // m/s^2
  ContactParameters ground = {};

  static std::string name() { return "falling_disk"; }
  static std::string summary() { return "thin disk that rolls on a plane and may fall"; }
  static std::string formula() {
    return "SE(3), l = 1/2 A (w1^2 + w2^2) + 1/2 C w3^2 + 1/2 m |v|^2 - m g z, v + w x r = 0 at "
           "the contact, height of the contact holonomic";
  }
  static std::string known() {
    return "steady motions, stability of upright rolling and spinning; invariants: energy";
  }
  static std::string source() { return "Neimark and Fufaev 1972, ch. V; O'Reilly 1996"; }

  void fields(auto& f) {
    f("mass", mass, "kg", "total mass", positive);
    f("radius", radius, "m", "radius of the disk", positive);
    f("axial_inertia", axial_inertia, "kg m^2", "moment about the axis",
      axial_moment(diametral_inertia));
    f("diametral_inertia", diametral_inertia, "kg m^2", "moment about a diameter", positive);
    f("gravity", gravity, "m/s^2", "acceleration of gravity", non_negative);
    ground.fields(f);
  }
  Mat<6, 6> inertia() const {
    Vec<6> d;
    d << diametral_inertia, diametral_inertia, axial_inertia, mass, mass, mass;
    return d.asDiagonal();
  }

  // The vertical, seen from the body, gamma = (h c, h s, gamma_3): the contact is at -rho (c, s, 0)
  // from the centre.
  template <class T>
  struct Contact {
    VecT<T, 3> gamma;
    T h, c, s;
    explicit Contact(const SE3::Element<T>& g) : gamma(g.rotation.row(2).transpose()) {
      using std::sqrt;
      h = sqrt(gamma[0] * gamma[0] + gamma[1] * gamma[1]);
      const T inverse = 1.0 / h;
      c = gamma[0] * inverse;
      s = gamma[1] * inverse;
    }
  };
  auto contact(const auto& g) const {
    using T = body_on_plane::ScalarOf<decltype(g)>;
    const Contact<T> at(g);
    return VecT<T, 3>(-radius * at.c, -radius * at.s, T(0.0));
  }
  auto frame(const auto& g) const { return body_on_plane::frame(contact(g)); }
  /// r' = -rho (c, s)' = -rho a (-s, c), a h = c gamma_2' - s gamma_1', gamma' = gamma x omega.
  Mat<3, 3> frame_rate(const Element& g, const Vec<6>& xi) const {
    const Contact<double> at(g);
    const double turn = xi[2] - at.gamma[2] * (at.c * xi[0] + at.s * xi[1]) / at.h;  // -a
    return body_on_plane::frame(Vec<3>(-radius * turn * at.s, radius * turn * at.c, 0));
  }
  /// Rows (r x u, u) of body_on_plane.hpp, multiplied out: u = (-s, c, 0), where it rolls, and
  /// u = gamma x (-s, c, 0) = (-gamma_3 c, -gamma_3 s, h).
  auto constraints(const auto& g) const {
    using T = body_on_plane::ScalarOf<decltype(g)>;
    const Contact<T> at(g);
    const T zero(0.0), lever = radius * at.h, &tilt = at.gamma[2];
    MatT<T, 2, 6> a;
    a << zero, zero, T(-radius), -at.s, at.c, zero,  //
        -lever * at.s, lever * at.c, zero, -tilt * at.c, -tilt * at.s, at.h;
    return a;
  }
  auto holonomic(const auto& g) const {
    using std::sqrt;
    const auto &r31 = g.rotation(2, 0), &r32 = g.rotation(2, 1);
    using T = std::decay_t<decltype(r31)>;
    return VecT<T, 1>(g.translation[2] - radius * sqrt(r31 * r31 + r32 * r32));
  }
  auto holonomic_differential(const auto& g) const {
    using T = body_on_plane::ScalarOf<decltype(g)>;
    const Contact<T> at(g);
    const T zero(0.0), lever = radius * at.gamma[2];
    MatT<T, 1, 6> d;
    d << -lever * at.s, lever * at.c, zero, at.gamma[0], at.gamma[1], at.gamma[2];
    return d;
  }
  auto potential(const auto& g) const { return mass * gravity * g.translation[2]; }
  Vec<6> potential_differential(const Element& g) const {
    return mass * gravity * body_on_plane::height_differential(g);
  }

  static std::vector<int> contacts() { return {2}; }
  void contacts(auto& add) const { ground.add_to(add, {.tangential = {0, 1}, .normal = 2}); }

  /// At x = y = 0 with the axis at theta from the vertical and rolling without slip with body rates
  /// omega.
  Start rolling(double theta, const Vec<3>& omega) const {
    const Element g = body_on_plane::leaning(theta, radius * std::sin(theta));
    return body_on_plane::rolling(g, omega, contact(g));
  }
  Start start() const { return rolling(1.3, {0.1, 0.4, 5}); }
  /// Upright.
  Start at_speed(double v) const { return rolling(0.5 * std::numbers::pi, {0, 0, v / radius}); }

  void invariants(auto& add) const {
    if (ground.ideal()) add("energy", energy_of(*this));
  }
  void events(auto& add) const {
    add("fallen", "the centre is lower than a tenth of the radius", -1,
        [rho = radius](double, const auto& g, const auto&) {
          return g.translation[2] - 0.1 * rho;
        });
  }
  void draw(auto& scene) const {
    scene.floor();
    scene
        .body("disk",
              [](const auto& g) {
                return Placement{g.translation, g.rotation};
              },
              {shapes::cylinder(radius, 0.04 * radius)})
        .trail();
    const auto touches = [disk = *this](const auto& g) {
      return Placement{g.translation + g.rotation * disk.contact(g), Mat<3, 3>::Identity()};
    };
    scene.body("contact", touches, {shapes::sphere(0.05 * radius, {.color = "dark"})}).trail();
  }
};

}  // namespace hamel
