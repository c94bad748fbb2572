// Numbers that turn with one angle, by harmonics: what a link that turns about an axis fixed in its
// root carries, seen from the root. A moment of inertia is of second order in cos and sin, the
// rotation of a twist of first.
//   x = a_0 + a_1 c + a_2 s + a_3 (c^2 - s^2) + a_4 2 c s
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include <hamel/framework/lie/types.hpp>

namespace hamel::mechanisms {

template <int count, int order>
class TurnedNumbers {
  static_assert(order == 1 || order == 2);

 public:
  /// at(angle): the numbers there. Exact for what is of this order: the sum over 2 order + 1
  /// equally spaced angles is that of the Fourier coefficients.
  template <class At>
  void find(At&& at) {
    for (Vec<count>& a : terms_) a.setZero();
    for (int k = 0; k < samples; ++k) {
      const double angle = 2 * std::numbers::pi * k / samples;
      const Vec<count> x = at(angle) / samples;
      terms_[0] += x;
      for (int j = 1; j <= order; ++j) {
        terms_[static_cast<size_t>(2 * j - 1)] += 2 * std::cos(j * angle) * x;
        terms_[static_cast<size_t>(2 * j)] += 2 * std::sin(j * angle) * x;
      }
    }
  }
  Vec<count> at(double c, double s) const {
    if constexpr (order == 1) return terms_[0] + c * terms_[1] + s * terms_[2];
    else {
      return terms_[0] + c * terms_[1] + s * terms_[2] + (c * c - s * s) * terms_[3] +
             (2 * c * s) * terms_[4];
    }
  }

 private:
  static constexpr int samples = 2 * order + 1;
  std::array<Vec<count>, samples> terms_;
};

}  // namespace hamel::mechanisms
