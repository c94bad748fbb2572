// Plan of an ensemble: what all members have in common, checked before anything runs. Not
// installed.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/ensemble/feedback.hpp>
#include <hamel/framework/ensemble/kept.hpp>
#include <hamel/framework/ensemble/vary.hpp>
#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/run/run/own_system.hpp>
#include <hamel/framework/run/run/simulation.hpp>

namespace hamel::ensemble {

/// Reads the files of the system and of inputs, where their texts are not there yet. ConfigError.
void read_data(EnsembleConfig& config);

/// Run of the ensemble's system: one of the program, of its text, or a registered one.
Simulation simulation(const Registry& registry, const EnsembleConfig& config, const Config& run);

/// Plan that all threads share: an ensemble without mistakes.
class Plan {
 public:
  /// Completes the configuration. ConfigError with all mistakes.
  Plan(const Registry& registry, EnsembleConfig& config);

  const Registry& registry;
  const EnsembleConfig& config;
  /// The run of all members, its rows left out, its events those of the formulas too.
  Config base;
  Config resolved;           // as it is run
  std::vector<double> rows;  // the times of its rows; empty: every so many nodes
  std::optional<Variations> variations;
  std::optional<KeptFormulas> kept;
  std::optional<FeedbackFormulas> feedback;
  std::shared_ptr<const Geometry> geometry;
  std::vector<Field> fields;  // with the values that all have in common
  /// Where members run in lanes: compiled for their system and scheme, steps of one size, and all
  /// that is kept of nodes; else null.
  const LaneInfo* lanes = nullptr;
  /// The reason where a function of the program keeps members out of lanes; else "".
  std::string alone;

  Simulation simulation(const Config& run) const {
    return ensemble::simulation(registry, config, run);
  }
  /// Does each member have a system of its own, or another start at speed?
  bool builds_each() const;
  bool varies_start() const;

 private:
  void complete(EnsembleConfig& from, std::vector<std::string>& mistakes);
  bool give_inputs(const SystemModel& system);
  const LaneInfo* find_lanes(const Run& run);
  void check_trajectories(std::vector<std::string>& mistakes) const;
  void check_unused(std::vector<std::string>& mistakes) const;
};

}  // namespace hamel::ensemble
