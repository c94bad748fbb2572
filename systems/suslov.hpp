// suslov: a rigid body whose angular velocity along a body-fixed axis n is forbidden.
//
//   SO(3),  l(Omega) = 1/2 Omega^T I Omega,  n . Omega = 0.
// With u1, u2, n a right-handed orthonormal frame, J = (u_i^T I u_j), k = (u_i^T I n), w the
// components of Omega on u1, u2, w~ = (-w2, w1):
//   J w' = p w~,  p = k.w;   q = k^T J^-1 w~;   p' = p q,  q' = -p^2 / det J.
// Hence, with A^2 = q0^2 + p0^2 / det J and sinh(A t0) = q0 sqrt(det J) / |p0|,
//   q = -A tanh A(t - t0),   p = sign(p0) sqrt(det J) A sech A(t - t0),
// and w from the linear system k.w = p, -b1 w2 + b2 w1 = q, b = J^-1 k. The motion is heteroclinic: it
// tends to the line p = 0. If k = 0 (n a principal axis) or p0 = 0, Omega is constant.
// Source: Suslov 1902; Fedorov, Kozlov, Various aspects of n-dimensional rigid body dynamics (1995).
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include <hamel/framework/mechanics/system.hpp>
#include <hamel/groups/so3.hpp>
#include <hamel/systems/energy.hpp>
#include <hamel/systems/reconstruction.hpp>

namespace hamel {

struct Suslov {
  using Group = SO3;
  std::vector<double> moments = {1, 10, 100};  // kg m^2
  Vec<3> normal = {0, 0, 1};                   // the forbidden axis

  static std::string name() { return "suslov"; }
  static std::string summary() { return "rigid body with one forbidden body axis"; }
  static std::string formula() { return "SO(3), l = 1/2 Omega' I Omega, n.Omega = 0"; }
  static std::string known() {
    return "Omega in closed form (heteroclinic, sech and tanh; constant when n is a principal "
           "axis), "
           "R by quadrature at round-off; invariants: energy";
  }
  static std::string source() { return "Suslov 1902; Fedorov and Kozlov 1995"; }

  void fields(auto& f) {
    f("inertia", moments, "kg m^2", "3 principal moments, 6 of the upper triangle, or 9 row-major",
      moments_of_inertia);
    f("normal", normal, "1", "the forbidden body axis (any length)");
  }

  Mat<3, 3> inertia() const {
    const auto& v = moments;
    switch (v.size()) {
      case 3: return Vec<3>(v[0], v[1], v[2]).asDiagonal();
      case 6: return Mat<3, 3>{{v[0], v[1], v[2]}, {v[1], v[3], v[4]}, {v[2], v[4], v[5]}};
      case 9: return Mat<3, 3>{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}};
      default:
        throw std::invalid_argument("inertia: got " + std::to_string(v.size()) +
                                    " values, expected 3, 6 or 9");
    }
  }
  Mat<1, 3> constraints() const {
    if (!(normal.norm() > 0)) throw std::invalid_argument("normal: the zero vector is no axis");
    return normal.normalized().transpose();
  }
  Start start() const {  // the paper's: Pi_0 = (1, 1, 0), projected onto d* for another axis
    return {.configuration = {}, .velocity = {}, .momentum = {1, 1, 0}};
  }

  /// The reduced motion w(t), embedded as Omega(t).
  class Velocity {
   public:
    Velocity(const Suslov& body, const Vec<3>& omega0) {
      const Vec<3> n = body.normal.normalized();
      frame_.col(0) = n.unitOrthogonal();
      frame_.col(1) = n.cross(frame_.col(0));
      const Mat<3, 3> inertia = body.inertia();
      const Mat<2, 2> j = frame_.transpose() * inertia * frame_;
      const Vec<2> k = frame_.transpose() * (inertia * n), b = j.inverse() * k;
      w0_ = frame_.transpose() * omega0;
      spread_ = std::sqrt(j.norm() * j.inverse().norm());
      const double p0 = k.dot(w0_), q0 = b[1] * w0_[0] - b[0] * w0_[1];
      if (std::abs(p0) <= 1e-15 * inertia.norm() * w0_.norm()) return;  // constant
      root_det_ = std::copysign(std::sqrt(j.determinant()), p0);
      a_ = std::hypot(q0, p0 / root_det_);
      at0_ = std::asinh(q0 * std::sqrt(j.determinant()) / std::abs(p0));
      solve_ = Mat<2, 2>{{k[0], k[1]}, {b[1], -b[0]}}.inverse();
    }
    Vec<3> operator()(double t) const {
      if (a_ == 0) return frame_ * w0_;
      const double x = a_ * t - at0_;
      const Vec<2> pq = {root_det_ * a_ / std::cosh(x), -a_ * std::tanh(x)};
      return frame_ * (solve_ * pq);
    }
    /// A bound on the rates of the motion: |Omega| is bounded through the energy and the moments.
    double rate() const { return a_ + spread_ * w0_.norm(); }
    bool constant() const { return a_ == 0; }

   private:
    Mat<3, 2> frame_;
    Mat<2, 2> solve_ = Mat<2, 2>::Zero();
    Vec<2> w0_;
    double root_det_ = 0, a_ = 0, at0_ = 0, spread_ = 1;
  };

  auto exact(const SO3::Element<double>& r0, const Vec<3>& omega0) const {
    Velocity velocity(*this, omega0);
    Reconstruction<SO3, Velocity> path(r0, velocity, 0.02 / std::max(velocity.rate(), 1e-9));
    auto steady = one_parameter_motion<SO3>(r0, omega0);
    return [velocity, path, steady](double t) mutable {
      return velocity.constant() ? steady(t) : path(t);
    };
  }

  void invariants(auto& add) const { add("kinetic energy", energy_of(*this)); }
  void draw(auto& scene) const {
    const Vec<3> n = normal.normalized();
    scene
        .body("body",
              [](const auto& r) {
                return Placement{Vec<3>::Zero(), r};
              },
              {shapes::box({1.2, 0.8, 0.4}), shapes::arrow({1.0, 0, 0}, {.color = "dark"}),
               shapes::arrow({n[0], n[1], n[2]}, {.color = "accent"})})
        .trail({1.0, 0, 0});
  }
};

}  // namespace hamel
