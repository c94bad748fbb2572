// A contact that may slide, open and strike, as data: the rows that a system states for it are rows
// of its A, on while the contact rolls.
//
// The gap is the holonomic row of `normal`, open where it is positive, whose multiplier is the
// normal reaction; the slip is the velocity of the rows of `tangential`, orthonormal directions in
// the tangent plane. Where a system has no height the normal reaction is a constant `load`.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hamel {

struct ContactLaw {
  std::string name = "contact";
  std::vector<int> tangential = {};    // rows of A, counted from 0: one (a blade) or two
  std::optional<int> normal = {};      // row of A, one of the holonomic rows
  double load = 0;                     // N, in place of a normal row
  std::optional<int> load_input = {};  // an input of the run, counted from 0, which adds to it
  double friction = 0;                 // mu, of Coulomb's law
  double static_friction = 0;          // while it rolls, where that is larger
  double restitution = 0;              // e, of Newton's law
  double tangential_restitution = 0;   // e_t: of the slip, as far as friction allows
  double share = 1;                    // of reactions that the motion leaves open; 0: none has one
  bool of_joint = false;               // dry friction of a joint, which slips and sticks

  bool has_normal() const { return normal.has_value(); }
  /// The coefficient up to which it rolls.
  double holding() const { return friction > static_friction ? friction : static_friction; }
  /// Names of the events in which it begins and ceases to slide.
  const char* slides_name() const { return of_joint ? "slips" : "slides"; }
  const char* rolls_name() const { return of_joint ? "sticks" : "rolls"; }
};

/// What a contact does; the numbers of the column <contact>.mode.
enum class ContactMode { open = 0, rolls = 1, slides = 2 };

}  // namespace hamel
