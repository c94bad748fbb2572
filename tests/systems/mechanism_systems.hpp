// Registered systems, put together by parts with the same parameters and the same coordinates.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <hamel/systems/ball_on_turntable.hpp>
#include <hamel/systems/chaplygin_sleigh.hpp>
#include <hamel/systems/differential_drive.hpp>
#include <hamel/systems/falling_disk.hpp>
#include <hamel/systems/knife_edge_on_incline.hpp>
#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/n_trailer.hpp>
#include <hamel/systems/roller_racer.hpp>
#include <hamel/systems/rolling_ball.hpp>
#include <hamel/systems/routh_sphere.hpp>
#include <hamel/systems/segway.hpp>
#include <hamel/systems/snakeboard.hpp>

namespace hamel::by_parts {

inline Mechanism sleigh(const ChaplyginSleigh& s) {
  Mechanism m("sleigh");
  const auto body =
      m.body("body", {.mass = s.mass, .at = {s.offset, 0, 0}, .inertia = {0, 0, s.moment}});
  m.planar("ice", body);
  m.blade("blade", body, {});
  return m;
}

inline Mechanism drive(const DifferentialDrive& s) {
  Mechanism m("drive");
  const double r = s.wheel_radius;
  const auto cart =
      m.body("cart", {.mass = s.mass, .at = {s.offset, 0, r}, .inertia = {0, 0, s.moment}});
  m.planar("floor", cart);
  for (const double side : {-1.0, 1.0}) {
    const std::string name = side < 0 ? "right" : "left";
    const Point at = {0, side * s.half_track, r};
    const auto wheel = m.body(name, {.mass = 0, .at = at, .inertia = {0, s.wheel_inertia, 0}});
    m.hinge(name, cart, wheel, {.at = at, .axis = {0, 1, 0}});
    m.wheel(name, wheel, {.at = at, .radius = r});
  }
  m.redundant("drop");
  return m;
}

inline Mechanism segway(const Segway& s) {
  Mechanism m("segway by parts");
  const double r = s.wheel_radius;
  m.body("axle", {.mass = 0, .at = {0, 0, r}});
  m.body("rider", {.mass = s.mass,
                   .at = {0, 0, r + s.height},
                   .inertia = {s.moments[0], s.moments[1], s.moments[2]}});
  m.planar("floor", "axle");
  for (const double side : {-1.0, 1.0}) {
    const std::string name = side < 0 ? "right" : "left";
    const Point at = {0, side * s.half_track, r};
    m.body(name, {.mass = s.wheel_mass,
                  .at = at,
                  .inertia = {s.wheel_diameter, s.wheel_inertia, s.wheel_diameter}});
    m.hinge(name, "axle", name, {.at = at, .axis = {0, 1, 0}});
    m.wheel(name, name, {.at = at, .radius = r});
  }
  m.hinge("pitch", "axle", "rider", {.at = {0, 0, r}, .axis = {0, 1, 0}});
  m.redundant("drop");
  m.gravity({0, 0, -s.gravity});
  return m;
}

inline Mechanism train(const NTrailer& s) {
  Mechanism m("train");
  m.body("car", {.mass = s.mass, .inertia = {0, 0, s.moment}});
  m.planar("road", "car");
  m.blade("axle 0", "car", {});
  std::string ahead = "car";
  double x = 0;
  int i = 0;
  for (const double length : s.each_length()) {
    const std::string name = fmt::format("trailer {}", ++i);
    m.body(name,
           {.mass = s.trailer_mass, .at = {x - length, 0, 0}, .inertia = {0, 0, s.trailer_moment}});
    m.hinge(fmt::format("hitch {}", i), ahead, name, {.at = {x, 0, 0}});
    x -= length;
    m.blade(fmt::format("axle {}", i), name, {.at = {x, 0, 0}});
    ahead = name;
  }
  return m;
}

inline Mechanism racer(const RollerRacer& s) {
  Mechanism m("racer");
  m.body("rear", {.mass = s.mass, .inertia = {0, 0, s.moment}});
  m.body("front", {.mass = 0, .at = {s.rear_length, 0, 0}, .inertia = {0, 0, s.front_moment}});
  m.planar("floor", "rear");
  m.hinge("steer", "rear", "front", {.at = {s.rear_length, 0, 0}, .stiffness = s.stiffness});
  m.blade("rear", "rear", {});
  m.blade("front", "front", {.at = {s.rear_length - s.front_length, 0, 0}});
  m.motor("steer",
          [s](const SignalInput& now) { return s.torque * std::cos(s.frequency * now.t); });
  return m;
}

inline Mechanism snakeboard(const Snakeboard& s) {
  Mechanism m("snakeboard by parts");
  const double l = s.half_length;
  m.body("board", {.mass = s.mass, .inertia = {0, 0, s.board_inertia}});
  m.body("rotor", {.mass = 0, .inertia = {0, 0, s.rotor_inertia}});
  m.planar("floor", "board");
  m.hinge("psi", "board", "rotor", {});
  const auto rate = [s](double amplitude) {
    return [a = amplitude * s.frequency, w = s.frequency](double t) { return a * std::cos(w * t); };
  };
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "front" : "back";
    const Point at = {side * l, 0, 0};
    m.body(name, {.mass = 0, .at = at, .inertia = {0, 0, s.axle_inertia}});
    m.hinge(name, "board", name, {.at = at});
    m.blade(name + " axle", name, {.at = at});
    m.prescribe(name, rate(side * s.steering_amplitude));
  }
  m.prescribe("psi", rate(s.rotor_amplitude));
  return m;
}

/// Numbers of a matrix R D R^T, row after row.
inline std::vector<double> turned(const Mat<3, 3>& r, const Vec<3>& d) {
  const Mat<3, 3> m = r * d.asDiagonal() * r.transpose();
  std::vector<double> out;
  for (int i = 0; i < 9; ++i) out.push_back(0.5 * (m(i / 3, i % 3) + m(i % 3, i / 3)));
  return out;
}

/// Drawn where the system starts, with its axis at theta to the vertical: its rotation there is the
/// identity.
inline Mechanism disk(const FallingDisk& s, double theta) {
  Mechanism m("disk by parts");
  const auto g = body_on_plane::leaning(theta, s.radius * std::sin(theta));
  const Vec<3> axis = g.rotation.col(2);
  const Point centre = {0, 0, g.translation[2]};
  m.body("disk", {.mass = s.mass,
                  .at = centre,
                  .inertia = turned(g.rotation,
                                    {s.diametral_inertia, s.diametral_inertia, s.axial_inertia})});
  m.free("space", "disk", {.at = centre});
  m.wheel("disk", "disk", {.at = centre, .axle = {axis[0], axis[1], axis[2]}, .radius = s.radius});
  m.gravity({0, 0, -s.gravity});
  return m;
}

inline Mechanism ball(const RollingBall& s) {
  Mechanism m("ball by parts");
  m.body("ball",
         {.mass = s.mass, .at = {0, 0, s.radius}, .inertia = {s.moment, s.moment, s.moment}});
  m.free("space", "ball", {.at = {0, 0, s.radius}});
  m.ball("ball", "ball", {.at = {0, 0, s.radius}, .radius = s.radius});
  return m;
}

inline Mechanism turntable(const BallOnTurntable& s) {
  Mechanism m = ball({.mass = s.mass, .radius = s.radius, .moment = s.moment});
  m.ground(s.table_rate);
  return m;
}

inline Mechanism incline(const KnifeEdgeOnIncline& s) {
  Mechanism m = sleigh({.mass = s.mass, .moment = s.moment, .offset = 0});
  m.gravity({s.gravity * std::sin(s.slope), 0, -s.gravity * std::cos(s.slope)});
  return m;
}

inline Mechanism routh(const RouthSphere& s) {
  Mechanism m("Routh's sphere by parts");
  m.body("ball", {.mass = s.mass,
                  .at = {0, 0, s.radius + s.offset},
                  .inertia = {s.transverse, s.transverse + s.asymmetry, s.axial}});
  m.free("space", "ball", {.at = {0, 0, s.radius}});
  m.ball("ball", "ball", {.at = {0, 0, s.radius}, .radius = s.radius});
  m.gravity({0, 0, -s.gravity});
  return m;
}

}  // namespace hamel::by_parts
