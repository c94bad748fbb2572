// Linear combinations of energy, spatial momenta and body velocities that motions keep. For
// analysis.cpp only, not installed.
#pragma once

#include <hamel/framework/analysis/analysis.hpp>

namespace hamel {

/// From the start of a run: motions with other velocities, from its end too, and longer ones. A
/// note counts those that were not followed to their end.
std::vector<Analysis::Conserved> find_conserved(const Registry& registry, const Config& start,
                                                const Eigen::MatrixXd& frame,
                                                const Geometry& geometry,
                                                std::vector<std::string>& notes);

}  // namespace hamel
