// A watch over chosen steps that shrink until a run would not end. Not installed.
//
// Steps creep where, over a thousand tries in a row, they advance by less than 1e-6 of the run
// each, and by less than 1e-3 of what a step of the same run has advanced before: a run whose steps
// are small from its start, since it is long or stiff, does not creep. Nor do steps that grow
// again: the slip of a contact that has just begun is stiff as long as it is small.
#pragma once

#include <algorithm>
#include <cmath>

namespace hamel {

class StepWatch {
 public:
  StepWatch() = default;
  /// span: of the run.
  StepWatch(double t, double span) : last_(t), span_(std::abs(span)) {}

  /// So many tries may be made before the next look().
  long until_next() const { return window_ - since_; }
  void count(long tries, long rejected) {
    since_ += tries;
    rejected_ += rejected;
  }
  /// Was a third of the last tries rejected? Where the tolerance is below round-off no size of a
  /// step is good for long.
  bool rejects() const { return last_tries_ >= kFew && 3 * last_rejected_ > last_tries_; }
  /// The size of earlier steps, where later ones have been below 1e-2 of it for a thousand tries;
  /// else 0. They do not creep yet, but a reason may be known.
  double shrunk_from() const { return shrunk_ >= 4 * kWindow ? largest_ : 0; }
  /// At a time, after the tries that were counted; true where they creep.
  bool look(double t) {
    if (since_ < window_) return false;
    const double each = std::abs(t - last_) / static_cast<double>(since_);
    const bool shrunk = each < 1e-2 * largest_,
               small = each < 1e-3 * largest_ && each < 1e-6 * span_;
    shrunk_ = shrunk ? shrunk_ + since_ : 0;
    const bool grows = each > kGrows * of_small_;
    small_ = small && !grows ? small_ + since_ : 0;
    of_small_ = small ? std::max(of_small_, each) : 0;
    largest_ = std::max(largest_, each);
    window_ = std::min(2 * window_, kWindow);  // a run may begin with few large steps
    last_ = t;
    last_rejected_ = rejected_;
    last_tries_ = since_;
    since_ = rejected_ = 0;
    return small_ >= 4 * kWindow;
  }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(last_, largest_, window_, since_, small_, of_small_, shrunk_, rejected_, last_rejected_,
            last_tries_);
  }

 private:
  static constexpr long kWindow = 256, kFew = 32;
  static constexpr double kGrows = 1.05;  // of the largest steps since they are small

  double last_ = 0, span_ = 0, largest_ = 0, of_small_ = 0;
  long window_ = 1, since_ = 0, small_ = 0, shrunk_ = 0, rejected_ = 0, last_rejected_ = 0,
       last_tries_ = 0;
};

}  // namespace hamel
