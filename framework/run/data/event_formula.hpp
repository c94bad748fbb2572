// Events of a state by formulas. Not installed.
//
//   "x^2 + y^2 = radius^2"   where both sides are equal, in either direction
//   "theta > 1.5"            where the left one becomes larger;  "theta < 1.5", smaller
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/io/expression.hpp>
#include <hamel/framework/mechanics/output_formulas.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {

/// The numbers of a state that formulas of events may use: t, the coordinates and the velocity
/// under these names, the columns of sensors but accelerations, and outputs of all these.
class StateVariables {
 public:
  using Value = std::function<double(double t, std::span<const double> coordinates,
                                     std::span<const double> velocity)>;

  StateVariables(const SystemModel& system, std::vector<std::string> names);
  const std::vector<std::string>& names() const { return names_; }
  /// The value of a formula over names().
  Value value(Expression formula) const;
  using Recorded = std::function<graph::Number(const graph::Number& t,
                                               std::span<const graph::Number> coordinates,
                                               std::span<const graph::Number> velocity)>;
  /// The formula in the current recording; empty where it takes what a sensor measures.
  Recorded recorded(Expression formula) const;
  /// The message of a mistake in a formula: of an output which is no function of a state, why.
  std::string explain(const std::string& message) const;

 private:
  // Which of the names a formula needs, and the outputs among them, in order.
  std::pair<std::vector<bool>, std::vector<ReadyOutput>> needs(const Expression& formula) const;
  struct Measured {  // by a sensor
    Sensor sensor;
    std::size_t first, count;  // among the names
  };
  std::vector<std::string> names_;
  std::size_t own_;  // the first of them, of t, coordinates and velocity
  std::vector<Measured> sensors_;
  std::vector<ReadyOutput> outputs_;
  std::vector<std::string> left_out_;  // outputs
};

/// The event of a text with =, < or > between two formulas of t, the system's coordinates and
/// velocities (quantity_names.hpp), sensors, outputs, and its parameters (those of several numbers
/// with the number behind: inertia1). None where the text has no such sign, or where something is
/// wrong with it, which goes to mistakes.
std::optional<Event> event_of_formula(const SystemModel& system, const std::string& text,
                                      std::vector<std::string>& mistakes);

}  // namespace hamel
