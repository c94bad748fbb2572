// Inputs as formulas of the state, evaluated at equal distances in time and held between. Not
// installed.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/ensemble/kept.hpp>
#include <hamel/framework/run/run/run.hpp>

namespace hamel::ensemble {

class FeedbackFormulas {
 public:
  /// Adds to mistakes what cannot be read, and inputs that the system has not.
  FeedbackFormulas(const EnsembleConfig& config, const SystemModel& system,
                   const Variations& variations, std::vector<std::string>& mistakes);
  bool any() const { return !formulas_.empty(); }
  void begin(long member) { constants_.begin(member); }
  /// Sets the inputs by the state of the run. ConfigError where one is out of its range.
  void act(Run& run);

 private:
  StateNames states_;
  MemberConstants constants_;
  std::vector<std::pair<std::string, StateNumber>> formulas_;
  StateParts parts_ = kNoParts;  // of a state, that they need
  std::vector<double> work_;
};

}  // namespace hamel::ensemble
