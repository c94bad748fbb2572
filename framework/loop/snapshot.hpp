// Observable data of a run: states with their measurements, and counts of its solves.
// Standard-library types only.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <hamel/framework/loop/status.hpp>

namespace hamel {

/// A step that failed and was rescued.
struct Fallback {
  long step = 0;
  double time = 0;  // at its beginning
  std::string action;
};

/// Running totals over the steps taken.
struct SolverStats {
  long iterations = 0;
  long evaluations = 0;
  int iterations_max = 0;  // over one step
  double residual_max = 0;
  long rejected = 0;  // steps taken again, smaller
  long fallbacks = 0;
  std::vector<Fallback> first_fallbacks;  // at most 20
};

/// Parts of a state beside its time and its velocity.
struct StateParts {
  bool coordinates = true, element = true;
  bool momentum = true, energy = true;
  bool measures = true;  // from constraint_rates on
};

/// A state with its measurements. Parts that were not found are empty, their numbers of no use.
struct Snapshot {
  long step = 0;
  double time = 0;
  std::vector<double> coordinates;  // of g
  // g as its Geometry lays it out (counts of turns are integers); empty of a state by hand.
  std::vector<double> element;
  std::vector<double> velocity;  // nodal body velocity, n
  std::vector<double> momentum;  // nodal body momentum, n
  double energy = 0;
  std::vector<double>
      constraint_rates;     // A v of the last step, v recovered from the configurations; k
  double constraint = 0;    // |A v - b|, holonomic rows left out
  double holonomic = 0;     // max |phi(g)|
  double group_defect = 0;  // how far g is from the group
  double rotation = 0;      // of the last substep, radians; NaN: the group has none
  double time_offset = 0;   // from the velocity of constraint_rates to the state, s
  int iterations = 0;       // of the last step, all substeps
  double residual = 0;      // relative, the largest of the last step's substeps
};

/// States of a run as numbers alone, one after the other, from which a kernel of the same problem
/// measures each later (Kernel::measure).
struct StateLog {
  static constexpr std::size_t kStep = 0, kTime = 1;  // within the numbers of a state
  static constexpr std::size_t kNumbers = 7;          // before the velocity and both elements

  long every = 1;  // so many steps
  std::size_t width = 0;
  std::vector<double> numbers;
  bool flawed = false;  // the state that came last is none, and is left out

  std::size_t size() const { return width == 0 ? 0 : numbers.size() / width; }
  /// Room for one more.
  double* append(std::size_t of) {
    width = of;
    const std::size_t at = numbers.size();
    numbers.resize(at + of);
    return numbers.data() + at;
  }
  std::span<const double> state(std::size_t i) const {
    return std::span(numbers).subspan(i * width, width);
  }
  bool has(long step) const {
    return size() > 0 && state(size() - 1)[kStep] == static_cast<double>(step);
  }
};

}  // namespace hamel
