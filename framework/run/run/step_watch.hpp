// A watch over chosen steps that shrink until a run would not end. Not installed.
//
// Steps creep where, over a thousand of them in a row, they advance by less than 1e-6 of the run
// each, and by less than 1e-3 of what a step of the same run has advanced before: a run whose steps
// are small from its start, since it is long or stiff, does not creep.
#pragma once

#include <algorithm>
#include <cmath>

namespace hamel {

class StepWatch {
 public:
  StepWatch() = default;
  /// span: of the run.
  StepWatch(double t, double span) : last_(t), span_(std::abs(span)) {}

  /// So many steps may be taken before the next look().
  long until_next() const { return window_ - since_; }
  void count(long steps) { since_ += steps; }
  /// After more steps, at a time; true where they creep.
  bool look(long steps, double t) {
    since_ += steps;
    if (since_ < window_) return false;
    const double each = std::abs(t - last_) / static_cast<double>(since_);
    const bool small = each < 1e-6 * span_ && each < 1e-3 * largest_;
    small_ = small ? small_ + since_ : 0;
    largest_ = std::max(largest_, each);
    window_ = std::min(2 * window_, kWindow);  // a run may begin with few large steps
    last_ = t;
    since_ = 0;
    return small_ >= 4 * kWindow;
  }

 private:
  static constexpr long kWindow = 256;

  double last_ = 0, span_ = 0, largest_ = 0;
  long window_ = 1, since_ = 0, small_ = 0;
};

}  // namespace hamel
