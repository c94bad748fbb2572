// The error that a step may make, in the units of what it is compared with.
#pragma once

namespace hamel {

/// rtol and atol of a run; both 0 where the steps are not chosen by their error.
struct ErrorScale {
  double relative = 0, absolute = 0;

  bool chooses_steps() const { return relative > 0 || absolute > 0; }
  /// Of a number of this size: absolute + relative size.
  double at(double size) const { return absolute + relative * size; }
};

}  // namespace hamel
