// A number that changes as a mechanism moves: a torque, a force. Standard-library types only.
#pragma once

#include <functional>
#include <span>

namespace hamel::mechanisms {

/// The variables that a signal may depend on.
struct SignalInput {
  double t = 0;
  std::span<const double> coordinates;  // of the element, as in the CSV
  std::span<const double> velocity;     // xi
  std::span<const double> inputs;       // of the run, in the order of the system; none: all zero
};
using Signal = std::function<double(const SignalInput&)>;

}  // namespace hamel::mechanisms
