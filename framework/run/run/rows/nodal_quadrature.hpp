// The integral of a function that is known at the nodes of a run, of order 8: over each interval
// that of the polynomial through the last eight nodes, by divided differences, (M49). Steps may be
// of any sizes: behind steps far smaller than the last, fewer nodes are taken, so that errors of
// the values are not magnified. Not installed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace hamel {

class NodalQuadrature {
 public:
  static constexpr std::size_t kNodes = 8;

  void add(double t, double value) {
    if (count_ > 0 && t == times_[0]) return;  // two switches at one time
    const bool shares = joins(t);
    std::array<double, kNodes> differences{value}, times{t};
    for (std::size_t k = 1; k < kNodes && k <= count_; ++k) {
      times[k] = times_[k - 1];
      differences[k] = (differences[k - 1] - differences_[k - 1]) / (t - times[k]);
    }
    const double step = t - times_[0];
    even_ = std::abs(step - step_) <= 1e-6 * std::abs(step) ? even_ + 1 : 0;
    step_ = step;
    times_ = times;
    differences_ = differences;
    used_ = std::min(++count_, kNodes);
    if (count_ == 1) {
      first_ = t;
    } else if (shares) {
      integral_ = over(first_, t);  // again, with the polynomial through all of them
    } else {
      settled_ = true;
      if (even_ + 2 < kNodes)
        while (used_ > 2 && magnifies(times_, used_, times_[1])) --used_;
      integral_ += over(times_[1], t);
    }
    settled_ = settled_ || count_ == kNodes;
  }
  /// Will t be one more of the first nodes, which share one polynomial? If not, value(t) is to be
  /// requested before t is added where it is still needed.
  bool joins(double t) const {
    if (settled_) return false;
    std::array<double, kNodes> times{t};
    std::copy_n(times_.begin(), count_, times.begin() + 1);
    return !magnifies(times, count_ + 1, first_);
  }
  /// Further nodes do not change the integral up to the last one.
  bool settled() const { return settled_; }
  /// Is there one node alone, where the value is 0?
  bool rests() const { return count_ == 1 && differences_[0] == 0; }
  /// From the first node to t, between the last two nodes; before it is settled, to any t between
  /// the first and the last.
  double value(double t) const { return integral_ - over(t, times_[0]); }
  /// Up to the last node.
  double whole() const { return integral_; }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(times_, differences_, count_, used_, even_, step_, first_, integral_, settled_);
  }

 private:
  static constexpr std::array<double, 4> kPoints = {-0.8611363115940526, -0.3399810435848563,
                                                    0.3399810435848563, 0.8611363115940526};
  static constexpr std::array<double, 4> kWeights = {0.3478548451374538, 0.6521451548625461,
                                                     0.6521451548625461, 0.3478548451374538};

  // Is the sum of the magnitudes of the weights that the values at the nodes have in the integral
  // from `from` to times[0] more than 20 times its length? Equal steps: 4.67 times.
  static bool magnifies(const std::array<double, kNodes>& times, std::size_t nodes, double from) {
    const double half = 0.5 * (times[0] - from), middle = times[0] - half;
    std::array<double, kNodes> weights = {};
    for (std::size_t p = 0; p < kPoints.size(); ++p) {
      const double x = middle + half * kPoints[p];
      double before = kWeights[p];  // the product of x - times[j], j < i
      std::array<double, kNodes> bases;
      for (std::size_t i = 0; i < nodes; ++i) {
        bases[i] = before;
        before *= x - times[i];
      }
      double behind = 1;
      for (std::size_t i = nodes; i-- > 0;) {
        weights[i] += bases[i] * behind;
        behind *= x - times[i];
      }
    }
    double sum = 0;
    for (std::size_t i = 0; i < nodes; ++i) {
      double own = 1;
      for (std::size_t j = 0; j < nodes; ++j)
        if (j != i) own *= times[i] - times[j];
      sum += std::abs(weights[i] / own) / 2;
    }
    return sum > 20;
  }

  // Over the interval: Gauss-Legendre, exact for the polynomial's degree.
  double over(double from, double to) const {
    const double half = 0.5 * (to - from), middle = to - half;
    double sum = 0;
    for (std::size_t p = 0; p < kPoints.size(); ++p) {
      double value = 0;
      for (std::size_t k = used_; k-- > 0;)
        value = differences_[k] + (middle + half * kPoints[p] - times_[k]) * value;
      sum += kWeights[p] * value;
    }
    return half * sum;
  }

  // Newest first: t_n, t_{n-1}, ..., and P[t_n], P[t_n, t_{n-1}], ...; 0 where there are none yet.
  std::array<double, kNodes> times_{}, differences_{};
  std::size_t count_ = 0, used_ = 0, even_ = 0;  // so many steps of one size, step_
  double step_ = 0, first_ = 0, integral_ = 0;
  bool settled_ = false;
};

}  // namespace hamel
