// The first guess of a step: the polynomial through up to six earlier solutions, continued.
//
// With backward differences D^0 x = x_k, D^j x = D^{j-1} x_k - D^{j-1} x_{k-1}, the polynomial of
// degree p - 1 through p solutions has the value D^0 + ... + D^{p-1} at the next step: it is summed
// as a solution is put in.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include <Eigen/Core>

namespace hamel {

template <class Unknown>
class Extrapolation {
 public:
  static constexpr int most = 6;

  /// sample: of the size of all that follow.
  explicit Extrapolation(const Unknown& sample) : value_(sample), work_(sample), next_(sample) {
    differences_.fill(sample);
  }
  int count() const { return count_; }
  void clear_history() { count_ = 0; }
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
  /// The value at the next step; count() > 0.
  void operator()(Unknown& out) const { out = value_; }
  void push(const Unknown& latest) {
    if (count_ == most) [[likely]]
      return put(latest, most);
    put(latest, ++count_);
  }

 private:
  // In registers where the size is known, else in place.
  using Local = std::conditional_t<Unknown::SizeAtCompileTime == Eigen::Dynamic, Unknown&, Unknown>;
  void put(const Unknown& latest, int count) {
    Local sum = value_, work = work_, next = next_;
    sum = latest;
    work = latest;
    for (int j = 0; j < count; ++j) {
      Unknown& difference = differences_[static_cast<std::size_t>(j)];
      if (j > 0) sum += work;
      next = work - difference;
      difference = work;
      work = next;
    }
    value_ = sum;
  }

  std::array<Unknown, most> differences_;
  Unknown value_, work_, next_;
  int count_ = 0;
};

}  // namespace hamel
