// The inputs of a run: torques and rates that a user gives as constants, as tables over time, or
// while it runs.
//
// A system states its inputs like its parameters, and what they add to its forces and drifts; where
// all are zero, nothing:
//   void inputs(auto& u) const;   u("torque", "N m", "on the handlebar", between(-5, 5)):
//                                 name, unit, meaning, range
//   force(t, g, xi, u)            n entries in the dual, added to force(t, g, xi)
//   drift(t, g, u)                k entries, added to b of A xi = b
// u[i] is the value of the i-th. A run without inputs is that of the system without them
// (with_inputs.hpp).
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/mechanics/input_table.hpp>

namespace hamel {

constexpr int kMostInputs = 32;
/// One value for each input, in the order of inputs(u), without heap.
using InputValues = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostInputs, 1>;

/// The inputs of one run, which owns them.
class Inputs {
 public:
  Inputs(std::vector<InputField> fields, std::vector<InputTable> tables);

  const std::vector<InputField>& fields() const { return fields_; }
  /// One for each field; no times and one value where it is constant.
  const std::vector<InputTable>& tables() const { return tables_; }
  /// A step from t to t + h begins. A table that is held has the value of the middle of the step
  /// all through it, so that round-off in the times of the nodes does not decide on which side of a
  /// jump they lie; one that is linear is in a step between two of its times the line through them,
  /// beyond them too: methods that differentiate b(t) by differences see no kink at their nodes.
  void enter(double t, double h);
  /// The values at a time of the step.
  InputValues at(double t) const;
  /// Their rates there, where they have one: of lines.
  InputValues slopes_at(double t) const;
  /// From now on constant.
  void set(std::size_t input, double value);
  /// Is there a table that may jump or bend?
  bool breaks() const { return breaks_; }
  /// The first time beyond t, in the direction of h, at which a held value jumps or a line bends;
  /// infinite where there is none.
  double next_break(double t, double h) const;
  /// Do the tables cover t, up to round-off?
  bool covers(double t) const {
    const double close = 1e-9 * (1 + std::abs(t));
    return t >= first_ - close && t <= last_ + close;
  }
  /// How often a value jumped or a table went on to another of its pieces.
  long changes() const { return changes_; }

 private:
  void find_cover();

  std::vector<InputField> fields_;
  std::vector<InputTable> tables_;
  std::vector<std::size_t> pieces_;  // of each table, between times piece and piece + 1
  std::vector<bool> smooth_;         // the step lies within it
  InputValues now_;                  // of constants and held tables
  double first_ = 0, last_ = 0;      // covered
  bool breaks_ = false;
  long changes_ = 0;
};

namespace detail {

// The visitor passed to a system's inputs().
struct InputReader {
  std::vector<InputField> inputs;
  void operator()(const char* name, const char* unit, const char* meaning = "",
                  const Range& range = {}) {
    inputs.push_back({name, unit, meaning, range});
  }
};

}  // namespace detail
}  // namespace hamel
