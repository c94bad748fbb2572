// rattleback: half an ellipsoid that rolls on a plane on its round side and prefers one sense of
// spin.
//
//   SE(3), body frame at the mass centre with the axes of the ellipsoid, z up; xi = (omega, v).
//   l = 1/2 omega^T I omega + 1/2 m |v|^2 - m g z,  I = R3(delta) diag(I1, I2, I3) R3(delta)^T:
// the axes of inertia are turned by delta about e3 against those of the surface. The centre of the
// ellipsoid is at d e3. With gamma = R^T e_z, D = diag(a1, a2, a3), the contact lies at
//   r = d e3 - D^2 gamma / sqrt(gamma^T D^2 gamma)
// from the mass centre, and rests: v + omega x r = 0. Its horizontal parts are rows of A (along the
// axes x and y of space: R (v + omega x r)); the vertical one is the differential of the height of
// the contact,
//   phi = z + gamma . r = z + d gamma_3 - sqrt(gamma^T D^2 gamma) = 0.
// Spun in one sense the rattleback keeps spinning for long; spun in the other it starts to rattle
// and reverses. The energy is conserved. The default body is large and slow: it rocks at about 10
// rad/s and reverses within 20 s. The stone of Kane and Levinson (semi_axes 0.2, 0.03, 0.02; depth
// 0.01; inertia 2e-4, 1.6e-3, 1.7e-3; skew 0.0143) rocks at 100 rad/s. Source: Walker 1896; Kane
// and Levinson, Int. J. Non-Linear Mech. 17 (1982); Garcia and Hubbard 1988.
#pragma once

#include <cmath>
#include <string>

#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/systems/body_on_plane.hpp>
#include <hamel/systems/energy.hpp>
#include <hamel/systems/friction.hpp>

namespace hamel {

struct Rattleback {
  using Group = SE3;
  using Element = SE3::Element<double>;
  double mass = 1.0;                       // kg
  Vec<3> semi_axes = {0.4, 0.2, 0.2};      // m
  double depth = 0.075;                    // m, d
  Vec<3> moments = {0.012, 0.036, 0.040};  // kg m^2
  double skew = 0.4;                       // rad, delta
  double gravity = 9.81;                   // m/s^2
  ContactParameters ground = {};

  static std::string name() { return "rattleback"; }
  static std::string summary() { return "half ellipsoid with skewed inertia: reverses its spin"; }
  static std::string formula() {
    return "SE(3), l = 1/2 w' I w + 1/2 m |v|^2 - m g z, v + w x r = 0 at the contact, height of "
           "the contact holonomic";
  }
  static std::string known() { return "spins on one way, reverses the other; invariants: energy"; }
  static std::string source() { return "Walker 1896; Kane and Levinson 1982"; }

  void fields(auto& f) {
    f("mass", mass, "kg", "total mass", positive);
    f("semi_axes", semi_axes, "m", "semi-axes of the ellipsoid", positive);
    f("depth", depth, "m", "mass centre below the centre of the ellipsoid",
      between(0, semi_axes[2]));
    f("inertia", moments, "kg m^2", "principal moments about the mass centre", moments_of_inertia);
    f("skew", skew, "rad", "angle of the axes of inertia against those of the surface, about e3");
    f("gravity", gravity, "m/s^2", "acceleration of gravity", non_negative);
    ground.fields(f);
  }
  Mat<6, 6> inertia() const {
    const double c = std::cos(skew), s = std::sin(skew);
    const Mat<3, 3> turn{{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
    Mat<6, 6> i = Mat<6, 6>::Zero();
    i.topLeftCorner<3, 3>() = turn * moments.asDiagonal() * turn.transpose();
    i.diagonal().tail<3>().setConstant(mass);
    return i;
  }
  /// From the mass centre to the contact.
  auto contact(const auto& g) const {
    using std::sqrt;
    using T = body_on_plane::ScalarOf<decltype(g)>;
    VecT<T, 3> d, r;
    for (int i = 0; i < 3; ++i) d[i] = semi_axes[i] * g.rotation(2, i);
    const T scale = -1.0 / sqrt(d.dot(d));
    for (int i = 0; i < 3; ++i) r[i] = semi_axes[i] * d[i] * scale;
    r[2] += depth;
    return r;
  }
  auto frame(const auto& g) const { return body_on_plane::frame(contact(g)); }
  /// r' = (D^2 gamma (gamma' . D^2 gamma) / s^2 - D^2 gamma') / s, s^2 = gamma . D^2 gamma, gamma'
  /// = gamma x omega.
  Mat<3, 3> frame_rate(const Element& g, const Vec<6>& xi) const {
    const Vec<3> gamma = g.rotation.row(2).transpose(), rate = gamma.cross(xi.head<3>());
    Vec<3> d, moved;
    for (int i = 0; i < 3; ++i) {
      const double square = semi_axes[i] * semi_axes[i];
      d[i] = square * gamma[i];
      moved[i] = square * rate[i];
    }
    const double s2 = gamma.dot(d), part = rate.dot(d) / s2;
    return body_on_plane::frame(Vec<3>((part * d - moved) / std::sqrt(s2)));
  }
  auto constraints(const auto& g) const {
    using T = body_on_plane::ScalarOf<decltype(g)>;
    const VecT<T, 3> r = contact(g);
    MatT<T, 2, 6> a;
    for (int i = 0; i < 2; ++i) {
      a.row(i) = body_on_plane::contact_velocity(r, VecT<T, 3>(g.rotation.row(i).transpose()));
    }
    return a;
  }
  auto holonomic(const auto& g) const {
    using std::sqrt;
    const auto& r = g.rotation;
    using T = std::decay_t<decltype(r(0, 0))>;
    T square(0.0);
    for (int i = 0; i < 3; ++i) square += (semi_axes[i] * semi_axes[i]) * (r(2, i) * r(2, i));
    return VecT<T, 1>(g.translation[2] + depth * r(2, 2) - sqrt(square));
  }
  auto holonomic_differential(const auto& g) const {
    using T = body_on_plane::ScalarOf<decltype(g)>;
    return body_on_plane::contact_velocity(contact(g), VecT<T, 3>(g.rotation.row(2).transpose()));
  }
  auto potential(const auto& g) const { return mass * gravity * g.translation[2]; }
  Vec<6> potential_differential(const Element& g) const {
    return mass * gravity * body_on_plane::height_differential(g);
  }

  static std::vector<int> contacts() { return {2}; }
  void contacts(auto& add) const { ground.add_to(add, {.tangential = {0, 1}, .normal = 2}); }

  /// Level but for a tilt about its long axis, spinning about the vertical.
  Start spinning(double spin, double tilt) const {
    Element g = body_on_plane::leaning(tilt);
    g.translation[2] = -holonomic(g)[0];
    return body_on_plane::rolling(g, spin * g.rotation.row(2).transpose(), contact(g));
  }
  /// The sense of spin that reverses.
  Start start() const { return spinning(-1.5, 0.02); }

  void invariants(auto& add) const {
    if (ground.ideal()) add("energy", energy_of(*this));
  }
  void events(auto& add) const {
    add("reversed", "the spin about the vertical changes its sign", 0,
        [](double, const auto& g, const auto& xi) {
          return (g.rotation.row(2) * xi.template head<3>()).value();
        });
  }
  void draw(auto& scene) const {
    scene.floor();
    const auto place = [](const auto& g) { return Placement{g.translation, g.rotation}; };
    const double a = semi_axes[0], b = semi_axes[1];
    scene
        .body("rattleback", place,
              {shapes::ellipsoid({a, b, semi_axes[2]}, {.at = {0, 0, depth}}),
               shapes::line({{-a, 0, depth}, {a, 0, depth}}, {.color = "accent"})})
        .trail({a, 0, depth});
    const auto at = [body = *this](const auto& g) {
      return Placement{g.translation + g.rotation * body.contact(g), Mat<3, 3>::Identity()};
    };
    scene.body("contact", at, {shapes::sphere(0.03 * a, {.color = "dark"})}).trail();
  }
};

}  // namespace hamel
