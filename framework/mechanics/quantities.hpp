// Numbers that are measured along a run, as its files call them.
#pragma once

#include <array>

namespace hamel {

/// A number that is measured, as files call it.
struct Quantity {
  const char *name, *unit, *meaning;
  const char* title = "";  // in reports; "" where they leave it out
};

// At each state.
inline constexpr Quantity kTime = {"t", "s", "time"};
inline constexpr Quantity kEnergy = {"energy", "J", "kinetic and potential"};
inline constexpr Quantity kIterations = {"iterations", "1", "of the last step's solver"};
inline constexpr Quantity kEnergyError = {
    "energy_error", "1", "(E - E0) / |E0|; where work is done (E - E0 - work) / max |E| so far",
    "energy error"};
inline constexpr Quantity kWork = {"work", "J", "of forces and moving constraints", "work done"};
inline constexpr Quantity kConstraint = {
    "constraint", "columns of xi", "|A xi/h - b|, from the configurations", "constraint residual"};
inline constexpr Quantity kHolonomic = {"holonomic", "columns of g", "|phi(g)|",
                                        "holonomic residual"};
inline constexpr Quantity kRotation = {"rotation_per_step", "rad",
                                       "how far a substep turns, from the configurations",
                                       "rotation per step"};
inline constexpr Quantity kGroupDefect = {"group_defect", "1", "distance from the group",
                                          "group defect"};
inline constexpr Quantity kResidual = {"residual", "1", "|F| / scale"};
inline constexpr Quantity kReactionPower = {"reaction_power", "W", "lambda . A v"};
inline constexpr Quantity kExactError = {"exact_error", "columns of g",
                                         "distance from the exact motion"};
inline constexpr Quantity kExactVelocityError = {"exact_velocity_error", "columns of xi",
                                                 "distance from the exact velocity"};

/// The columns that a run may have beside coordinates, velocities, momenta and reactions.
inline constexpr std::array kMeasuredColumns = {
    kTime,     kEnergy,    kEnergyError, kConstraint,    kGroupDefect, kIterations,
    kResidual, kHolonomic, kWork,        kReactionPower, kExactError,  kExactVelocityError};

}  // namespace hamel
