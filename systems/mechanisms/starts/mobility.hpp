// Freedoms that the rows of a mechanism leave it, at the start and at poses that the rows let it
// reach. Prescribed rates that change, and inputs, count as free: they move their joints. Not
// installed.
#pragma once

#include <vector>

#include <hamel/systems/mechanisms/multibody.hpp>

namespace hamel::mechanisms {

struct Mobility {
  bool any = false;   // something
  bool root = true;   // the first planar or free root joint
  bool turns = true;  // that joint, by its angular velocities
};
/// g: an element on phi = 0. On ground that moves everything does. sticking: with contacts that may
/// slide not sliding.
Mobility mobility_at(const Multibody& system, const std::vector<double>& g, bool sticking = false);

/// Is the first planar or free root joint free to move at a pose, but at none of those near it that
/// the rows let it reach? The rank of the rows falls there.
bool moves_at_this_pose_alone(const Multibody& system, const std::vector<double>& g);

/// Contacts with an axle about which no joint that carries them turns, as drawn: counted as in
/// all_rows().
std::vector<size_t> wheels_that_cannot_roll(const Multibody& system);

/// The first planar or free joint on the ground; -1: there is none.
int vehicle_root(const Tree& tree);

}  // namespace hamel::mechanisms
