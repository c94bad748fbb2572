// The forces of a mechanism: gravity, springs, dampers, motors, given forces.
//
//   gravity   V = -sum m a . x, a the acceleration of gravity, of any direction
//   spring    V = 1/2 k (l - l_0)^2, f = -c l', c its damper; l the distance of two points, or the
//             coordinate of a hinge or slider
//   motor     f on one velocity of a joint, a signal
//   force     three signals, at a point of a body, along the axes of the world or of the body as
//             drawn
//   torque    the same, a couple on a body
#pragma once

#include <string>
#include <vector>

#include <hamel/systems/mechanisms/signal.hpp>
#include <hamel/systems/mechanisms/tree.hpp>

namespace hamel::mechanisms {

struct Spring {
  std::string name;
  int joint = -1;  // a link, whose hinge or slider it acts on; else between two points
  int a = kGround, b = kGround;
  Vec3 at_a = Vec3::Zero(), at_b = Vec3::Zero();  // as drawn
  double stiffness = 0, rest = 0, damping = 0;    // N/m, m, N s/m; N m/rad, rad, N m s/rad
};
struct Motor {
  std::string name;
  int dof = 0;
  Signal effort;                // N m or N
  bool time_dependent = false;  // may it use t?
};
struct Force {
  std::string name;
  int link = 0;
  Vec3 at = Vec3::Zero();       // as drawn
  bool couple = false;          // a torque [N m], at no point
  bool of_body = false;         // along the axes of the body
  bool time_dependent = false;  // may along use t?
  Signal along[3];              // N or N m
};

struct Forces {
  Vec3 gravity = {0, 0, -9.81};  // m/s^2
  std::vector<Spring> springs;
  std::vector<Motor> motors;
  std::vector<Force> forces;

  /// Is there a force beside the potential?
  bool any() const;
  bool damped() const;
  /// Is one of them of t?
  bool time_dependent() const;
  bool has_signals() const { return !motors.empty() || !forces.empty(); }
};

}  // namespace hamel::mechanisms
