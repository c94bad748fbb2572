// Units of a system's own, so that nothing depends on those that a user chose.
#pragma once

#include <vector>

#include <hamel/framework/mechanics/components.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>

namespace hamel {

/// Sizes of displacements: 1 for angles, for lengths the radius of gyration of the system at g; 0
/// for lengths of a system without angles, and for other components.
std::vector<double> own_scales(const std::vector<Component>& components, const Mechanics& mechanics,
                               const double* g);

/// The same; 1 for all where any component has none.
std::vector<double> natural_units(const std::vector<Component>& components,
                                  const Mechanics& mechanics, const double* g);

}  // namespace hamel
