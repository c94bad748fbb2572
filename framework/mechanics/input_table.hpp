// An input of a system and its values over time, as data. Standard-library types only.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/io/export.hpp>
#include <hamel/framework/mechanics/parameters.hpp>

namespace hamel {

/// One input of a system, as its inputs() states it.
struct InputField {
  std::string name, unit, meaning;
  Range range;
};

/// An input over time: linear between its times, or held from each time to the next. Times
/// increase.
struct HAMEL_API InputTable {
  std::vector<double> times, values;
  bool hold = false;
  bool operator==(const InputTable&) const = default;
  /// The value at t, on a jump the one behind it; before and behind the times the first and the
  /// last.
  double at(double t) const;
};

}  // namespace hamel
