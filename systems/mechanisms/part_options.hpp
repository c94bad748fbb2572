// The data of the parts of a mechanism (mechanism.hpp). Standard-library types only.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/mechanics/parameters.hpp>
#include <hamel/framework/mechanics/point.hpp>
#include <hamel/systems/mechanisms/signal.hpp>

namespace hamel {

using mechanisms::Signal;       // SignalInput -> number
using mechanisms::SignalInput;  // t, coordinates, velocity, inputs

/// The name of the ground where a body's is expected.
inline const std::string kWorld = "ground";

struct BodyOptions {
  double mass = std::numeric_limits<double>::quiet_NaN();  // kg, to be given, 0 too
  Point at = {0, 0, 0};                                    // m, the mass centre
  std::vector<double> inertia =
      {};  // kg m^2: 3 moments, or 6 of the upper triangle, or 9; left out: of the shape
  Point box = {0, 0, 0};              // m, edges; at most one shape
  std::vector<double> cylinder = {};  // m, radius and length, about `axis`
  double sphere = 0;                  // m, radius
  Point axis = {0, 0, 1};             // of the cylinder
};
struct JointOptions {
  Point at = {0, 0, 0};  // m, a point of the joint
  Point axis = {0, 0, 1};
  Point axis2 = {0, 1, 0};  // of a universal joint, on the child
  double stiffness = 0, rest = 0,
         damping = 0;      // N m/rad, rad, N m s/rad; of a slider N/m, m, N s/m
  Parameters values = {};  // what this kind of joint has beside them, by name
  // Dry friction of a hinge or slider, N m or N, with which it sticks; ends of its motion, rad or
  // m, with the restitution of the impacts there.
  std::optional<double> friction = {}, restitution = {};
  std::vector<double> stop = {};  // low, high
};
/// A contact of any kind (mechanisms/README.md).
struct ContactOptions {
  Point at = {0, 0, 0};    // m, its centre or point
  Parameters values = {};  // of its fields, by name: {{"radius", {0.3}}}
  // Coulomb's friction, with which it may slide, and open where its height may change; without, it
  // is ideal.
  std::optional<double> friction = {}, restitution = {};
  std::optional<double> load = {};      // N, where its height cannot change; left out: of statics
  std::optional<bool> unilateral = {};  // may it open? As its friction and height have it
  // Friction while it rolls, not less than friction; restitution of the slip; the part of the loads
  // that it has where they are `stated` (Mechanism::distribution).
  std::optional<double> static_friction = {}, tangential_restitution = {}, share = {};
  // For a ball: the body whose sphere or cylinder it touches, on or inside it; neither: the ground.
  std::string on = {}, inside = {};
};
struct WheelOptions {
  Point at = {0, 0, 0};    // m, its centre
  Point axle = {0, 1, 0};  // to the left, so that it rolls ahead at positive rates
  double radius = 0;       // m
  double angle = 0;        // rad, of a roller's rollers against the plane of the wheel
  // As in ContactOptions.
  std::optional<double> friction = {}, restitution = {}, load = {};
  std::optional<bool> unilateral = {};
  std::optional<double> static_friction = {}, tangential_restitution = {}, share = {};
  std::string on = {}, inside = {};  // as there, of a ball
};
struct BladeOptions {
  Point at = {0, 0, 0};     // m
  Point along = {1, 0, 0};  // the direction in which it slides
  // As in ContactOptions.
  std::optional<double> friction = {}, restitution = {}, load = {};
  std::optional<bool> unilateral = {};
  std::optional<double> static_friction = {}, tangential_restitution = {}, share = {};
};
struct PointOptions {
  Point at = {0, 0, 0};  // m
  // As in ContactOptions.
  std::optional<double> friction = {}, restitution = {}, load = {};
  std::optional<bool> unilateral = {};
  std::optional<double> static_friction = {}, tangential_restitution = {}, share = {};
};
/// A wall that coordinates of hinges and sliders run against. It may move: see Mechanism::time.
struct WallOptions {
  std::string distance = {};  // a formula of coordinates and t, not negative
  double restitution = 0;
  Parameters constants = {};  // names that the formulas may use
  // Coulomb's, and what slips along it, linear in velocities, one at the point of contact: a
  // distance has no point.
  std::optional<double> friction = {};
  std::string slip = {};
};
struct LoopOptions {
  Point at = {0, 0, 0};    // m
  Point axis = {0, 0, 0};  // of a hinge; 0: a ball joint
};
/// An equation of joints, one of these three. Coordinates are those of hinges and sliders, and t.
struct CouplingOptions {
  std::string joint = {}, to = {};  // joint = ratio * to + offset
  double ratio = 1, offset = 0;
  std::string formula = {};   // of coordinates, 0 where the equation holds
  std::string rates = {};     // the same, linear in velocities, with coefficients of coordinates
  Parameters constants = {};  // names that the formula may use
};
struct SpringOptions {
  Point from = {0, 0, 0}, to = {0, 0, 0};  // m, its ends as drawn
  double stiffness = 0;                    // N/m
  std::optional<double> rest = {};         // m; left out: its length as drawn
  double damping = 0;                      // N s/m
};
struct ForceOptions {
  Point at = {0, 0, 0};        // m
  Signal along[3] = {};        // N, along x, y, z of the world
  bool of_body = false;        // along those of the body as drawn
  bool time_dependent = true;  // may `along` use t? If not, there are steady motions
};
struct TorqueOptions {
  Signal along[3] = {};        // N m, about x, y, z of the world
  bool of_body = false;        // about those of the body as drawn
  bool time_dependent = true;  // as of a force
};
/// A scalar whose rate is a formula linear in velocities, with coefficients of coordinates and
/// states: a lag, the integral of a controller. It has no inertia and acts on nothing by itself.
struct StateOptions {
  std::string rate = {};      // "(sideslip - lag)*v1/0.3"; terms without a velocity are allowed
  std::string unit = "1";     // of the state
  Parameters constants = {};  // names that the formula may use
};
struct OutputOptions {
  std::string unit = {}, meaning = {};
};

}  // namespace hamel
