// A mechanism recorded over the numbers of a state (mechanism_programs.hpp).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <hamel/framework/graph/elimination.hpp>
#include <hamel/systems/mechanisms/programs/mechanism_programs.hpp>
#include <hamel/systems/mechanisms/programs/row_formulas.hpp>

namespace hamel::mechanisms {

using graph::Frame;
using graph::Sample;

class RecordedMechanism {
 public:
  using Numbers = std::vector<Number>;

  explicit RecordedMechanism(const MechanismParts& parts);
  ~RecordedMechanism() { recording_->end(); }
  RecordedMechanism(const RecordedMechanism&) = delete;
  RecordedMechanism& operator=(const RecordedMechanism&) = delete;
  /// Current while this object lives; complete behind it.
  const std::shared_ptr<graph::Recording>& recording() const { return recording_; }

  RowInputs row_inputs() const { return {g, xi, feet, coupled, closures, rates, gaps}; }
  /// Rates of all inputs along the motion, xi held: 0 where nothing moves them.
  Numbers number_rates() const;
  /// db/dt - (dA/dt) xi along the motion, xi held.
  Numbers row_rates() const;
  /// out += -dV of the springs; the forces beside the potential.
  void add_spring_forces(Numbers& out) const;
  void add_given_forces(Numbers& out) const;
  Number spring_potential() const;

 private:
  const MechanismParts& parts_;
  const std::shared_ptr<graph::Recording> recording_ = std::make_shared<graph::Recording>();

 public:
  // In the order of a state.
  const Numbers g, xi, signals, feet, coupled, closures, rates, slopes, gaps;
  const BodyFormulas bodies;
  const std::vector<RecordedRow> rows;  // those that are kept

 private:
  Numbers inputs(const char* name, size_t count);
  Numbers foot_rates() const;
};

/// The state, and places to either side of it: entries that vanish at one of them are no pivots.
std::vector<std::vector<double>> states_near(const MechanismParts& parts,
                                             std::span<const double> state);

/// A frame of A xi' = c near a state. Throws std::domain_error where the rows depend on each other.
Frame find_frame(const MechanismParts& parts, const RecordedMechanism& mechanism,
                 std::span<const double> state, std::vector<Number> c);

}  // namespace hamel::mechanisms
