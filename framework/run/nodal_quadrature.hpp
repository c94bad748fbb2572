// The integral of a function that is known at the nodes of a run, of order 8: over each interval that of the
// polynomial through the last eight nodes, by divided differences, (M49). Steps may be of any sizes. Not installed.
#pragma once

#include <array>
#include <cstddef>

namespace hamel {

class NodalQuadrature {
 public:
  static constexpr std::size_t kNodes = 8;

  void add(double t, double value) {
    std::array<double, kNodes> differences{value}, times{t};
    for (std::size_t k = 1; k < kNodes && k <= count_; ++k) {
      times[k] = times_[k - 1];
      differences[k] = (differences[k - 1] - differences_[k - 1]) / (t - times[k]);
    }
    times_ = times;
    differences_ = differences;
    ++count_;
    if (count_ > kNodes) integral_ += over(times_[1], t);
    else
      integral_ =
          count_ > 1 ? over(first_, t) : 0;  // again, with the polynomial through all of them
    if (count_ == 1) first_ = t;
  }
  std::size_t count() const { return count_; }
  /// From the first node to t, between the last two nodes; before there are kNodes + 1, to any t between the first and the last.
  double value(double t) const { return integral_ - over(t, times_[0]); }

  template <class Archive>
  void carry(Archive& archive) {
    archive(times_, differences_, count_, first_, integral_);
  }

 private:
  // Over the interval: Gauss-Legendre, exact for the polynomial's degree.
  double over(double from, double to) const {
    constexpr std::array<double, 4> points = {-0.8611363115940526, -0.3399810435848563,
                                              0.3399810435848563, 0.8611363115940526};
    constexpr std::array<double, 4> weights = {0.3478548451374538, 0.6521451548625461,
                                               0.6521451548625461, 0.3478548451374538};
    const double half = 0.5 * (to - from), middle = to - half;
    double sum = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
      double value = 0;
      for (std::size_t k = kNodes; k-- > 0;)
        value = differences_[k] + (middle + half * points[p] - times_[k]) * value;
      sum += weights[p] * value;
    }
    return half * sum;
  }

  // Newest first: t_n, t_{n-1}, ..., and P[t_n], P[t_n, t_{n-1}], ...; 0 where there are none yet.
  std::array<double, kNodes> times_{}, differences_{};
  std::size_t count_ = 0;
  double first_ = 0, integral_ = 0;
};

}  // namespace hamel
