// snakeboard: a board on two steered axles, run by swinging a rotor.
//
//   SE(2) x T^3, xi = (omega, v1, v2, psi', front', back'), origin at the centre, axles at +-l e1:
//   l = 1/2 m (v1^2 + v2^2) + 1/2 J omega^2 + 1/2 J_0 (omega + psi')^2
//     + 1/2 J_1 ((omega + front')^2 + (omega + back')^2),
//   -sin(front) v1 + cos(front) (v2 + l omega) = 0,   -sin(back) v1 + cos(back) (v2 - l omega) = 0,
// and the rider's motion prescribes the rotor and the axles (affine rows):
//   psi = psi_a sin(Omega t),   front = front_0 + phi_a sin(Omega t),
//   back = back_0 - phi_a sin(Omega t),
// and whatever rates the inputs add to these three. Without them:
// the rows of the axles leave one direction X(front, back) in se(2). With N = diag(J + J_0 + 2 J_1,
// m, m) and X^T N X = 1 the motion is (omega, v) = sigma X and, as [X, X] = 0, a quadrature:
//   sigma' = -X_omega q',   q = J_0 psi' + J_1 (front' + back').
// For front = -back = phi and J + J_0 + 2 J_1 = m l^2, X sqrt(m) = (sin(phi)/l, cos(phi), 0): the
// equations u = S cos(phi), l theta' = S sin(phi), m S' = -(J_0/l) psi'' sin(phi) of Ostrowski.
// Source: Lewis, Ostrowski, Murray and Burdick, Nonholonomic mechanics and locomotion: the
// snakeboard (1994).
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/groups/so2.hpp>
#include <hamel/systems/reconstruction.hpp>

namespace hamel {

struct Snakeboard {
  using Group = Product<SE2, SO2, SO2, SO2>;
  using Element = Group::Element<double>;
  double mass = 6.0;                // kg
  double half_length = 0.2;         // m, l
  double board_inertia = 0.108;     // kg m^2, J
  double rotor_inertia = 0.12;      // kg m^2, J_0
  double axle_inertia = 0.006;      // kg m^2, J_1
  double rotor_amplitude = 0.7;     // rad, psi_a
  double steering_amplitude = 0.3;  // rad, phi_a
  double frequency = 2.0;           // rad/s, Omega

  static std::string name() { return "snakeboard"; }
  static std::string summary() { return "board on steered axles, run by swinging a rotor"; }
  static std::string formula() {
    return "SE(2)*T3, l = 1/2 m |v|^2 + 1/2 J w^2 + 1/2 J_0 (w + psi')^2 + 1/2 J_1 ((w + front')^2 "
           "+ (w + back')^2), no slip across either axle, psi', front', back' prescribed";
  }
  static std::string known() {
    return "(omega, v) by a quadrature, the path by another, both at round-off";
  }
  static std::string source() { return "Lewis, Ostrowski, Murray and Burdick 1994"; }
  static std::vector<std::string> shape() { return {"rotor", "front", "back"}; }

  void fields(auto& f) {
    f("mass", mass, "kg", "total mass", positive);
    f("half_length", half_length, "m", "centre to axle", positive);
    f("board_inertia", board_inertia, "kg m^2", "moment of the board about the centre",
      non_negative);
    f("rotor_inertia", rotor_inertia, "kg m^2", "moment of the rotor", positive);
    f("axle_inertia", axle_inertia, "kg m^2", "moment of each axle about its steering axis",
      non_negative);
    f("rotor_amplitude", rotor_amplitude, "rad", "swing of the rotor");
    f("steering_amplitude", steering_amplitude, "rad", "swing of the axles, against each other");
    f("frequency", frequency, "rad/s", "of both");
  }
  void inputs(auto& u) const {
    u("rotor_rate", "rad/s", "of the rotor, beside its swing");
    u("front_rate", "rad/s", "of the front axle, beside its swing");
    u("back_rate", "rad/s", "of the back axle, beside its swing");
  }
  Vec<5> drift(double /*t*/, const Element& /*g*/, const InputValues& u) const {
    Vec<5> b;
    b << 0, 0, u[0], u[1], u[2];
    return b;
  }
  Mat<6, 6> inertia() const {
    Mat<6, 6> i = Mat<6, 6>::Zero();
    i.diagonal() << whole(), mass, mass, rotor_inertia, axle_inertia, axle_inertia;
    for (int k = 3; k < 6; ++k) i(0, k) = i(k, 0) = i(k, k);
    return i;
  }
  auto constraints(const auto& g) const {
    const auto &front = g.template part<2>(), &back = g.template part<3>();
    using T = std::decay_t<decltype(front.c)>;
    MatT<T, 5, 6> a = MatT<T, 5, 6>::Zero();
    a(0, 0) = half_length * front.c;
    a(1, 0) = -half_length * back.c;
    for (int i = 0; i < 2; ++i) {
      a(i, 1) = i == 0 ? -front.s : -back.s;
      a(i, 2) = i == 0 ? front.c : back.c;
    }
    for (int i = 0; i < 3; ++i) a(2 + i, 3 + i) = T(1.0);
    return a;
  }
  template <class T>
  VecT<T, 5> drift(const T& t, const auto& /*g*/) const {
    const VecT<T, 3> rates = prescribed(t).rates;
    VecT<T, 5> b;
    b << T(0.0), T(0.0), rates[0], rates[1], rates[2];
    return b;
  }

  /// The rider's motion: psi, front, back since t = 0, and their rates; q'.
  template <class T>
  struct Rider {
    VecT<T, 3> turned, rates;
    T momentum_rate;
  };
  template <class T>
  Rider<T> prescribed(const T& t) const {
    using std::cos;
    using std::sin;
    const T s = sin(frequency * t), c = frequency * cos(frequency * t);
    const Vec<3> swing(rotor_amplitude, steering_amplitude, -steering_amplitude);
    Rider<T> out;
    for (int i = 0; i < 3; ++i) {
      out.turned[i] = swing[i] * s;
      out.rates[i] = swing[i] * c;
    }
    out.momentum_rate = -(rotor_inertia * rotor_amplitude * frequency * frequency) * s;
    return out;
  }

  /// At rest on the ground, or running forwards, while the rider swings; axles at +-steering.
  Start running(double speed, double steering = 0) const {
    const Vec<3> rates = prescribed(0.0).rates;
    return {.configuration = {0, 0, 0, 0, steering, -steering},
            .velocity = {speed * std::tan(steering) / half_length, speed, 0, rates[0], rates[1],
                         rates[2]},
            .momentum = {}};
  }
  Start start() const { return running(0); }

  /// X at (front, back), X^T N X = 1.
  Vec<3> direction(double front, double back) const {
    const Vec<3> x(std::sin(front - back), 2 * half_length * std::cos(front) * std::cos(back),
                   half_length * std::sin(front + back));
    return x / std::sqrt(x.dot(Vec<3>(whole(), mass, mass).cwiseProduct(x)));
  }
  /// sigma by Gauss-Legendre of order 6, kept where it was evaluated last.
  auto exact(const Element& g0, const Vec<6>& xi0) const {
    const auto x = [board = *this, front = g0.part<2>().angle(),
                    back = g0.part<3>().angle()](double t) {
      const Vec<3> turned = board.prescribed(t).turned;
      return board.direction(front + turned[1], back + turned[2]);
    };
    const double sigma0 = x(0).dot(Vec<3>(whole(), mass, mass).cwiseProduct(xi0.head<3>()));
    const double longest = 0.02 / std::max(1e-9, std::abs(frequency));
    auto velocity = [x, longest, board = *this, sigma = sigma0, time = 0.0](double t) mutable {
      const double count = std::ceil(std::abs(t - time) / longest), h = (t - time) / count;
      const auto rate = [&](double at) { return -x(at)[0] * board.prescribed(at).momentum_rate; };
      for (double k = 0; k < count; ++k) {
        const double middle = time + (k + 0.5) * h, c = std::sqrt(0.15) * h;
        sigma += h / 18 * (5 * rate(middle - c) + 8 * rate(middle) + 5 * rate(middle + c));
      }
      time = t;
      Vec<6> xi;
      xi << sigma * x(t), board.prescribed(t).rates;
      return xi;
    };
    const double fastest = std::abs(frequency) + xi0.norm() + 1;
    return Reconstruction<Group, decltype(velocity)>(g0, velocity, 0.01 / fastest);
  }
  void draw(auto& scene) const {
    scene.from_above();
    // Turned by an angle about the point at x on the board.
    const auto at = [](const auto& g, double x, double angle, double z) {
      const auto& board = g.template part<0>();
      const Vec<2> p = board.translation + board.rotation.rotate(Vec<2>(x, 0));
      return planar(p[0], p[1], board.angle() + angle, z);
    };
    const double l = half_length;
    scene
        .body("board", [at](const auto& g) { return at(g, 0, 0, 0.05); },
              {shapes::box({2 * l, 0.05, 0.02})})
        .trail();
    scene.body("rotor",
               [at](const auto& g) { return at(g, 0, g.template part<1>().angle(), 0.08); },
               {shapes::box({0.05, 1.6 * l, 0.03}, {.color = "accent"})});
    const BodyShape axle = shapes::box({0.04, 0.8 * l, 0.03}, {.color = "dark"});
    scene.body("front axle",
               [at, l](const auto& g) { return at(g, l, g.template part<2>().angle(), 0.02); },
               {axle});
    scene.body("back axle",
               [at, l](const auto& g) { return at(g, -l, g.template part<3>().angle(), 0.02); },
               {axle});
  }

 private:
  double whole() const { return board_inertia + rotor_inertia + 2 * axle_inertia; }
};

}  // namespace hamel
