// The first guess of a step: the polynomial through up to six earlier solutions, continued.
//
// With backward differences D^0 x = x_k, D^j x = D^{j-1} x_k - D^{j-1} x_{k-1}, the polynomial of
// degree p - 1 through p solutions has the value D^0 + ... + D^{p-1} at the next step: it is summed
// as a solution is put in.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace hamel {

template <class Unknown>
class Extrapolation {
 public:
  static constexpr int most = 6;

  /// sample: of the size of all that follow.
  explicit Extrapolation(const Unknown& sample) : value_(sample) { differences_.fill(sample); }
  int count() const { return count_ > 0 ? count_ : 0; }
  void clear_history() { count_ = 0; }
  /// The latest solution is the value, and the next one takes its place.
  void take_back() {
    if (count_ <= 0) return;
    value_ = differences_[0];
    for (std::size_t j = 1; j < static_cast<std::size_t>(count_); ++j)
      differences_[j - 1] -= differences_[j];
    count_ = count_ > 1 ? count_ - 1 : kTakenBack;
  }
  /// Is there a value?
  bool empty() const { return count_ == 0; }
  /// D^0, D^1, ..., of which count() are known.
  const std::array<Unknown, most>& differences() const { return differences_; }
  /// As where these differences were reached.
  template <class Differences>
  void restore(const Differences& differences, int count) {
    count_ = count;
    for (int j = 0; j < count; ++j) {
      differences_[static_cast<std::size_t>(j)] = differences[static_cast<std::size_t>(j)];
      if (j == 0) value_ = differences_[0];
      else value_ += differences_[static_cast<std::size_t>(j)];
    }
  }
  /// The value at the next step, where there is one.
  void operator()(Unknown& out) const { out = value_; }
  void push(const Unknown& latest) {
    if (count_ == most) [[likely]]
      return put(latest, most);
    count_ = count() + 1;
    put(latest, count_);
  }

 private:
  static constexpr int kTakenBack = -1;  // the only solution

  // As a whole where the size is known, else number by number: both stay in registers.
  void put(const Unknown& latest, int count) {
    if constexpr (Unknown::SizeAtCompileTime == Eigen::Dynamic) {
      std::array<double*, most> differences;
      for (std::size_t j = 0; j < most; ++j) differences[j] = differences_[j].data();
      for (Eigen::Index i = 0; i < latest.size(); ++i) {
        value_[i] =
            put(latest[i], count, [&](std::size_t j) -> double& { return differences[j][i]; });
      }
    } else {
      value_ = put(latest, count, [&](std::size_t j) -> Unknown& { return differences_[j]; });
    }
  }
  // The next value of a number, or of all, with differences(j).
  template <class Value, class Differences>
  [[gnu::always_inline]] static Value put(const Value& latest, int count,
                                          Differences&& differences) {
    Value sum = latest, work = latest;
    for (int j = 0; j < count; ++j) {
      Value& difference = differences(static_cast<std::size_t>(j));
      if (j > 0) sum += work;
      const Value next = work - difference;
      difference = work;
      work = next;
    }
    return sum;
  }

  std::array<Unknown, most> differences_;
  Unknown value_;
  int count_ = 0;
};

}  // namespace hamel
