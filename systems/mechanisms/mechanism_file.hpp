// A mechanism in a file: hamel run scooter.toml.
//
//   name = "scooter"         # left out: the file's
//   gravity = 9.81           # or three numbers, m/s^2 (left out: 9.81)
//   slope = 0.1              # rad: x points downhill (left out: level)
//   redundant = "drop"       # rows implied by others (left out: "refuse")
//   distribution = "stated"  # of loads that statics leaves open, by `share`; or "refuse" (left
//                            # out: "equal_compliance")
//   [parameters]             # to set, study and sweep; allowed in every number
//   wheelbase = 0.8          # or { value = 0.8, unit = "m", meaning = "...", least = 0 }
//   [[body]]                 # mass [kg]; at: its mass centre [m]; inertia: 3, 6 (upper triangle)
//   name = "deck"            # or 9 numbers [kg m^2], or the shape's: box = [x, y, z],
//   mass = 5                 # cylinder = [radius, length] with axis, sphere = radius
//   at = ["wheelbase/2", 0, 0.1]
//   [[joint]]                # kind: free planar hinge slider ball universal weld
//   kind = "planar"          # parent (left out: the ground), child, at, axis, axis2,
//   child = "deck"           # stiffness, rest, damping; held = true: locked where it starts;
//                            # friction [N m, N], stop = [low, high], restitution
//   [[wall]]                 # name; distance = "1 - way.position", not negative, of t too;
//                            # restitution; friction, with slip = "height.rate"
//   [[wheel]] [[roller]] [[blade]] [[ball]] [[point]] [[tube]] [[ellipsoid]]
//                            # name (left out: the body's), body, at; axle, radius, angle, crown;
//                            # along; semi_axes; friction, restitution, load [N], unilateral;
//                            # static_friction, tangential_restitution, share;
//                            # of a ball: on or inside = "body", whose sphere or cylinder it
//                            # touches instead of the ground
//   [[loop]]                 # name, a, b, at, axis
//   [[coupling]]             # name (left out: the joint's); joint, to, ratio, offset: joint =
//   joint = "left knuckle"   # ratio * to + offset; or formula = "...", of joint coordinates, or
//   to = "steer"             # rates = "...", linear in velocities: 0 where the coupling holds
//   [[prescribed]]           # joint; rate or angle = "0.3*sin(2*t)", where a run then starts;
//                            # left out: an input, steer.rate
//   [[spring]]               # name, a, b, from, to, stiffness, rest, damping
//   [[motor]]                # joint; effort = "-2*steer.angle - 0.1*steer.rate"; left out: an
//   joint = "steer"          # input, steer.torque, or lift.force of a slider, between `least`
//                            # and `most`
//   [[brake]]                # joint: dry friction up to an input, rear.brake, from `least` to
//   joint = "rear"           # `most`, N m or N
//   [[force]]                # name, body, at; along = ["1", 0, 0]; of_body = true
//   [[torque]]               # name (left out: the body's), body; along, of_body as of a force
//   [[sensor]]               # name (left out: the body's), body, at: columns tip.x .y .z .vx .vy
//   body = "deck"            # .vz .yaw .ax .ay .az .path
//   [[state]]                # name, rate: a scalar with this rate, linear in velocities with
//   name = "lag"             # coefficients of coordinates and states; unit
//   rate = "(v2/v1 - lag)*v1/0.3"
//   [outputs]                # columns by formulas of columns, parameters and each other
//   speed = { value = "sqrt(tip.vx^2 + tip.vy^2)", unit = "m/s", meaning = "..." }
//   [inputs]                 # what a run may be driven by; efforts and forces may use them
//   wind = { unit = "N", meaning = "...", least = -50, most = 50 }
//   [events]                 # zero at the event; direction +1, -1, or 0 for both ways
//   straight = { value = "steer.angle", meaning = "the fork is straight", direction = 0 }
//   [ground]                 # rate [rad/s], velocity [m/s]: the ground turns and moves; or
//   height = "0.1*sin(x)"    # z of the ground at rest, of x and y of the world
//   [start]                  # coordinates and velocities by name, and speed
//   speed = 2
//   [push]                   # velocities beside the speed of --speed: w1 = 0.1
//   start_arguments = ["speed"]
//                            # the numbers of --velocity, fewer than velocities
//
// Numbers may be formulas (io/expression.hpp) of the parameters; effort, along, rate and angle also
// of t, those of events, motors, forces and torques of coordinates (steer.angle, x) and velocities
// (steer.rate, v1), the latter two of inputs (wind, steer.torque). Parts may have any name; one
// with a blank, for example, is not allowed in a formula.
#pragma once

#include <string>

#include <hamel/framework/run/names/registry.hpp>
#include <hamel/systems/mechanisms/mechanism.hpp>

namespace hamel {

/// The system of a TOML text. options: hold, joints that are locked, "arm" where a run starts or
/// "arm=0.3" there. Throws ConfigError with every mistake, file, line and column.
SystemModel mechanism_from(const std::string& text, const std::string& origin,
                           const Parameters& given = {}, const NameOptions& options = {});

/// The registry entry of such a text: its texts, its parameters.
SystemInfo mechanism_info(const std::string& text, const std::string& origin);

}  // namespace hamel
