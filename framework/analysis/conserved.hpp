// Linear combinations of energy, spatial momenta and body velocities that motions keep. For
// analysis.cpp only, not installed.
#pragma once

#include <hamel/framework/analysis/analysis.hpp>

namespace hamel {

/// From the configuration of a first run: motions with other velocities, from its end too, and
/// longer ones.
std::vector<Analysis::Conserved> find_conserved(const Registry& registry, const Result& first,
                                                const Eigen::MatrixXd& frame,
                                                const Geometry& geometry);

}  // namespace hamel
