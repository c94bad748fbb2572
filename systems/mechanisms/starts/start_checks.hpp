// Requirements of a mechanism on the state that a run starts from. Not installed.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <hamel/systems/mechanisms/multibody.hpp>
#include <hamel/systems/mechanisms/starts/poses.hpp>
#include <hamel/systems/mechanisms/starts/starts.hpp>

namespace hamel::mechanisms {

// A signal of a part, and how messages call it.
struct Watched {
  std::string what;
  Signal value;
};

// A coordinate with a prescribed value.
struct Held {
  std::string what;
  size_t column;
  bool turns;  // a hinge
  std::function<double(double t)> value;
};

struct StartChecks {
  std::vector<RowLabel> rows;     // of all_rows(): those that are kept independent
  std::map<int, Repeat> dropped;  // of these: agree with those that are kept
  std::vector<Watched> signals;
  std::vector<Held> held;
};

/// Signals without a value, prescribed coordinates elsewhere, and rows that repeat or contradict
/// others, at (t, g, xi). system: driven by the inputs, which may be null.
std::vector<std::string> mistakes_at_start(const Multibody& system, const StartChecks& checks,
                                           const Inputs* inputs, double t, const double* g,
                                           std::span<const double> xi);

}  // namespace hamel::mechanisms
