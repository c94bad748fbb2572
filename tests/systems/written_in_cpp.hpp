// Systems of tests/examples/*.toml as C++ structs: what the files are held to and timed against.
#pragma once

#include <cmath>
#include <string>

#include <hamel/hamel.hpp>

namespace hamel {

// particle_in_potential.toml
struct Particle {
  using Group = Rn<2>;
  double mass = 1.5, friction = 0.05, lambda = 0.8;
  static std::string name() { return "particle"; }
  Mat<2, 2> inertia() const { return mass * Mat<2, 2>::Identity(); }
  auto potential(const auto& g) const {
    const auto &x = g[0], &y = g[1];
    return 0.5 * (x * x + y * y) + lambda * (x * x * y - y * y * y / 3.0);
  }
  Vec<2> force(const auto& /*g*/, const Vec<2>& xi) const { return -friction * xi; }
  void inputs(auto& u) const { u("push", "N", "along x"); }
  Vec<2> force(double /*t*/, const auto& /*g*/, const Vec<2>& /*xi*/, const InputValues& u) const {
    return {u[0], 0};
  }
  static Start start() {
    return {.configuration = {0.1, -0.2}, .velocity = {0.3, 0.2}, .momentum = {}};
  }
};

// scooter_by_rows.toml
struct Scooter {
  using Group = Product<SE2, SO2>;
  double m = 70, moment = 2, b = 0.35, w = 0.9, fork = 0.05, gravity = 9.81, slope = 0.02, k = 1.5,
         c = 0.1, drag = 2;
  static std::string name() { return "scooter"; }
  Mat<4, 4> inertia() const {
    return Mat<4, 4>{{moment + m * b * b + fork, 0, m * b, fork},
                     {0, m, 0, 0},
                     {m * b, 0, m, 0},
                     {fork, 0, 0, fork}};
  }
  Mat<2, 4> constraints(const Group::Element<double>& q) const {
    const auto& steer = q.part<1>();
    return Mat<2, 4>{{0, 0, 1, 0}, {w * steer.c, -steer.s, steer.c, 0}};
  }
  Vec<4> potential_differential(const Group::Element<double>& q) const {
    const auto& deck = q.part<0>();
    const double f = m * gravity * std::sin(slope), cos = std::cos(deck.angle()),
                 sin = std::sin(deck.angle());
    return {f * b * sin, -f * cos, f * sin, k * q.part<1>().angle()};
  }
  double potential(const Group::Element<double>& q) const {
    const auto& deck = q.part<0>();
    const double steer = q.part<1>().angle();
    return -m * gravity * std::sin(slope) * (deck.translation[0] + b * std::cos(deck.angle())) +
           0.5 * k * steer * steer;
  }
  Vec<4> force(const Group::Element<double>& /*q*/, const Vec<4>& xi) const {
    return {0, -drag * xi[1], 0, -c * xi[3]};
  }
  void inputs(auto& u) const { u("torque", "N m", "on the fork"); }
  Vec<4> force(double /*t*/, const auto& /*q*/, const Vec<4>& /*xi*/, const InputValues& u) const {
    return {0, 0, 0, u[0]};
  }
  Start start() const {
    return {.configuration = {0.3, 0, 0, 0.2},
            .velocity = {1.5 * std::tan(0.2) / w, 1.5, 0, 0},
            .momentum = {}};
  }
};

}  // namespace hamel
