// What a scheme says of itself, as data that the tests measure.
#pragma once

#include <string>

namespace hamel {

/// The order a scheme claims on left-invariant systems, and whether its step is time-reversible.
struct ClaimedOrder {
  int order;        // 0: not an approximation at all
  bool reversible;  // a step with h, then one with -h, returns to the start
};

}  // namespace hamel
