// From an exact body velocity xi(t) to the exact configuration: g' = g xi(t), to round-off.
//
// Sixth-order Magnus with three Gauss-Legendre points (Blanes, Casas, Oteo, Ros, The Magnus
// expansion and some of its applications, Phys. Rep. 470 (2009), eq. 252-253), applied to (g^-1)' =
// -xi g^-1:
//   a1 = h x2,  a2 = sqrt(15)/3 h (x3 - x1),  a3 = 10/3 h (x3 - 2 x2 + x1),  x_i = -xi(t + c_i h),
//   C1 = [a1, a2],  C2 = -1/60 [a1, 2 a3 + C1],
//   W = a1 + a3/12 + 1/240 [-20 a1 - a3 + C1, a2 + C2],   g(t + h) = g(t) exp(-W).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <hamel/groups/exp.hpp>
#include <hamel/groups/product_retraction.hpp>

namespace hamel {

/// velocity: t -> Vec<n>. Called with |t| increasing; step: the longest step that is at round-off,
/// about 0.02 over the fastest rate of the motion. Where the velocity does not change any more, as
/// at the end of a heteroclinic motion, steps grow to kStretch times that.
template <class G, class Velocity>
class Reconstruction {
 public:
  using Element = typename G::template Element<double>;
  static constexpr int n = G::dim;

  Reconstruction(const Element& g, Velocity velocity, double step)
      : g_(g), velocity_(std::move(velocity)), step_(step) {}

  /// Not finite where that would take more than kMost steps in all, some seconds.
  static constexpr double kMost = 5e7;
  std::pair<Element, Vec<n>> operator()(double t) {
    while (t_ != t) {
      const double whole = t - t_, count = std::ceil(std::abs(whole) / (stretch_ * step_));
      if (!(taken_++ + count <= kMost)) {
        const Vec<n> none = Vec<n>::Constant(std::numeric_limits<double>::quiet_NaN());
        return {G::compose(g_, Exp<G>::tau(none)), none};
      }
      const bool steady = advance(t_, whole / count);
      t_ = count == 1 ? t : t_ + whole / count;
      stretch_ = steady ? std::min(2 * stretch_, kStretch) : 1;
    }
    return {g_, velocity_(t)};
  }

 private:
  static constexpr double kStretch = 64;

  // Is the velocity constant along it, but for round-off?
  bool advance(double t, double h) {
    const double c = std::sqrt(15.0) / 10;
    const Vec<n> x1 = -velocity_(t + (0.5 - c) * h), x2 = -velocity_(t + 0.5 * h),
                 x3 = -velocity_(t + (0.5 + c) * h);
    const Vec<n> a1 = h * x2, a2 = std::sqrt(15.0) / 3 * h * (x3 - x1),
                 a3 = 10.0 / 3 * h * (x3 - 2 * x2 + x1);
    const Vec<n> c1 = G::ad(a1) * a2;
    const Vec<n> c2 = -(G::ad(a1) * Vec<n>(2 * a3 + c1)) / 60;
    const Vec<n> w = a1 + a3 / 12 + G::ad(Vec<n>(-20 * a1 - a3 + c1)) * Vec<n>(a2 + c2) / 240;
    g_ = G::normalise(G::compose(g_, Exp<G>::tau(Vec<n>(-w))));
    return a2.norm() + a3.norm() <= 1e-14 * a1.norm();
  }

  Element g_;
  Velocity velocity_;
  double step_, stretch_ = 1, t_ = 0, taken_ = 0;
};

/// The motion with constant body velocity: g(t) = g0 exp(t xi).
template <class G>
auto one_parameter_motion(const typename G::template Element<double>& g0, const Vec<G::dim>& xi) {
  return [g0, xi](double t) {
    return std::pair{G::compose(g0, Exp<G>::tau(Vec<G::dim>(t * xi))), xi};
  };
}

}  // namespace hamel
