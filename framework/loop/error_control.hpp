// Steps of explicit pairs, chosen by the error.
//
// A step of size h whose estimate err (1 at the tolerance, O(h^k)) is above 1 is taken again; the
// next one is
//   h clip(0.85 err^-a err_before^b, 0.2, 5),   a = 0.7/k,  b = 0.4/k,
// which does not grow after a rejection, (M45). Source: Hairer, Norsett, Wanner, Solving Ordinary
// Differential Equations I, II.4 (PI control: Gustafsson).
#pragma once

#include <cmath>

#include <hamel/framework/loop/status.hpp>

namespace hamel {

class ErrorControl {
 public:
  explicit ErrorControl(int estimated_order)
      : alpha_(0.7 / estimated_order), beta_(0.4 / estimated_order) {}

  struct Taken {
    Reason reason;
    long rejected;  // steps before it
    bool whole;     // it ends at the limit
  };
  /// A step of size h, and of the time left at most: taken again, smaller, until its error is good.
  /// h is then the size of the next. take_step() returns the error of a step of size h; one above 1
  /// leaves the state alone.
  template <class TakeStep>
  Taken take(double& h, double left, double smallest, TakeStep&& take_step) {
    constexpr int most = 100;
    for (int tries = 0; tries < most; ++tries) {
      const double wanted = h;
      const bool whole = std::abs(h) >= std::abs(left);
      if (whole) h = left;
      if (accept(take_step(), h)) {
        if (whole && std::abs(h) < std::abs(wanted)) h = wanted;
        return {Reason::converged, tries, whole};
      }
      if (std::abs(h) < smallest) return {Reason::too_small, tries + 1, false};
    }
    return {Reason::too_many, most, false};
  }

 private:
  // Is a step of size h with this error good? Changes h to the next one, or to that of the
  // repetition.
  bool accept(double error, double& h) {
    if (!(error <= 1)) {
      rejected_ = true;
      h *= std::isfinite(error) ? std::fmax(0.2, 0.85 * std::pow(error, -alpha_)) : 0.2;
      return false;
    }
    error = std::fmax(error, 1e-10);
    const double most = rejected_ ? 1 : 5;
    h *=
        std::fmin(most, std::fmax(0.2, 0.85 * std::pow(error, -alpha_) * std::pow(before_, beta_)));
    before_ = std::fmax(error, 1e-4);
    rejected_ = false;
    return true;
  }

  double alpha_, beta_, before_ = 1e-4;
  bool rejected_ = false;
};

}  // namespace hamel
