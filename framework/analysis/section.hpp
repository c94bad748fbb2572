// Poincare sections: the states in which motions cross an event (`hamel section`).
//
//   hamel::SectionRequest request{.event = "theta=0", .direction = 1, .count = 500};
//   hamel::Section section = hamel::section(hamel::simulate("suslov_in_potential"), request);
//   section.points.csv();
//
// The map from one crossing to the next is that of the reduced motion where the event does not
// depend on the symmetries. Crossings are located to 1e-12 of a step on the dense output of the
// scheme (run/events.hpp); the error of a long motion is that of its steps. Source: Henon, On the
// numerical computation of Poincare maps, Physica D 5 (1982), who integrates to the section
// instead.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/io/export.hpp>
#include <hamel/framework/io/table.hpp>
#include <hamel/framework/run/run/simulation.hpp>

namespace hamel {

class Registry;

struct SectionRequest {
  std::string event = {};          // of the system by name, or a formula: "theta=0"
  int direction = 0;               // +1: its function grows in time, -1: it falls, 0: both
  long count = 100;                // points of each start
  std::vector<Start> starts = {};  // none: that of the simulation
  /// J; the velocity of each start is multiplied by a positive number that gives it this energy.
  std::optional<double> energy = {};
  /// Duration in s after which a start is given up; none: after a million steps without a crossing.
  std::optional<double> longest = {};
};

/// Motion of a section.
struct SectionOrbit {
  Start start;               // as it was run
  double energy = 0;         // there, J
  double energy_change = 0;  // the largest at its points, J
  long found = 0;            // points
  double time = 0;           // reached, s
  std::string reason;        // "" where all points were found
};

struct Section {
  /// Rows, one for each point: start (from 1), n (from 1), t, the columns of the element, the
  /// components of xi, energy.
  Table points;
  std::vector<SectionOrbit> orbits;
  bool complete = false;  // all points of all starts
};

/// Runs each start until it has crossed the event count times. progress: the fraction done. stop:
/// ends it, with the points so far. ConfigError before anything runs: no such event, a direction
/// that the event does not have, a count below 1, an energy that a start cannot have.
HAMEL_API Section section(const Simulation& simulation, const SectionRequest& request,
                          const std::function<void(double)>& progress = {},
                          const std::atomic<bool>* stop = nullptr);

/// The starts of this configuration's system in a CSV file: a header with columns of the element
/// (all or none) and components of xi, by name or number, as `hamel section -o` writes them; other
/// columns are left out. ConfigError, with the line.
HAMEL_API std::vector<Start> read_starts(const std::string& path, const Registry& registry,
                                         const Config& config);

}  // namespace hamel
