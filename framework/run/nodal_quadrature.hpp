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
    if (count_ > kNodes) {
      integral_ += over(0);
      return;
    }
    integral_ = 0;  // again, with the polynomial through all of them
    for (std::size_t i = 1; i < count_; ++i) first_[i] = integral_ += over(count_ - 1 - i);
  }
  /// From the first node to the last.
  double value() const { return integral_; }
  /// From the first node to node i < kNodes; final once there are kNodes.
  double first(std::size_t i) const { return first_[i]; }

 private:
  // Over the interval that ends at times_[i]: Gauss-Legendre, exact for the polynomial's degree.
  double over(std::size_t i) const {
    constexpr std::array<double, 4> points = {-0.8611363115940526, -0.3399810435848563,
                                              0.3399810435848563, 0.8611363115940526};
    constexpr std::array<double, 4> weights = {0.3478548451374538, 0.6521451548625461,
                                               0.6521451548625461, 0.3478548451374538};
    const double half = 0.5 * (times_[i] - times_[i + 1]), middle = times_[i] - half;
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
  std::array<double, kNodes> times_{}, differences_{}, first_{};
  std::size_t count_ = 0;
  double integral_ = 0;
};

}  // namespace hamel
