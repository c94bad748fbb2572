// The accelerations of a system as recorded formulas of t, coordinates, velocities and inputs.
//
// In a frame of the admissible velocities found by elimination near a state
// (graph/elimination.hpp),
//   xi' = E y' + particular,   E^T I E y' = E^T (change - I particular),
// solved by L D L^T within the formulas: xi' of any xi, as metric.hpp gives it. Not installed.
#pragma once

#include <memory>
#include <vector>

#include <hamel/framework/graph/motion_terms.hpp>
#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {

struct MotionFormulas {
  std::shared_ptr<graph::Recording> recording;  // complete
  graph::MotionVariables variables;
  std::vector<graph::Number> rates;       // xi'
  std::vector<graph::Number> pivots;      // that may not vanish
  std::vector<graph::Number> admissible;  // xi by the independent ones
  std::vector<int> independent;           // of xi
};

/// ad* of a group, and its factors.
graph::GroupShape group_shape(const SystemModel& model, const Geometry& geometry);
/// The terms of a system at variables of the current recording, wherever it has them; g: any
/// element. Throws std::domain_error with the reason where it has none.
graph::MotionTerms recorded_terms(const SystemModel& model, const Mechanics& mechanics,
                                  const double* g, const graph::MotionVariables& at);

/// Near a place and velocity. inputs: of the recorded system, by name. Throws std::domain_error
/// with the reason where the system has no formulas, or more than 12 independent velocities.
MotionFormulas record_motion(const SystemModel& model, const Mechanics& mechanics,
                             const Geometry& geometry, const std::vector<double>& element,
                             const std::vector<double>& velocity);

}  // namespace hamel
