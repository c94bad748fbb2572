// The first guess of a step: the polynomial through up to six earlier solutions, continued.
//
// With backward differences D^0 x = x_k, D^j x = D^{j-1} x_k - D^{j-1} x_{k-1}, the polynomial of
// degree p - 1 through p solutions has the value D^0 + ... + D^{p-1} at the next step.
#pragma once

#include <array>
#include <cstddef>

namespace hamel {

template <class Unknown>
class Extrapolation {
 public:
  static constexpr int most = 6;

  /// sample: of the size of all that follow.
  explicit Extrapolation(const Unknown& sample) : work_(sample), next_(sample) {
    differences_.fill(sample);
  }
  int count() const { return count_; }
  void forget() { count_ = 0; }
  /// The value at the next step; count() > 0.
  void operator()(Unknown& out) const {
    out = differences_[0];
    for (int j = 1; j < count_; ++j) out += differences_[static_cast<std::size_t>(j)];
  }
  void push(const Unknown& latest) {
    if (count_ < most) ++count_;
    work_ = latest;
    for (int j = 0; j < count_; ++j) {
      Unknown& difference = differences_[static_cast<std::size_t>(j)];
      next_ = work_ - difference;
      difference = work_;
      work_ = next_;
    }
  }

 private:
  std::array<Unknown, most> differences_;
  Unknown work_, next_;
  int count_ = 0;
};

}  // namespace hamel
