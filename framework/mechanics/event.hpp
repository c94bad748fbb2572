// An event of a system, as data. Standard-library types only.
#pragma once

#include <functional>
#include <span>
#include <string>

namespace hamel {

/// A function of the state that is zero at an event.
struct Event {
  std::string name, meaning;
  int direction = 0;  // in which it crosses zero as time runs on: +1, -1, or 0 for both
  std::function<double(double t, std::span<const double> coordinates,
                       std::span<const double> velocity)>
      value = {};
};

}  // namespace hamel
