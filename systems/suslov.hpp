// suslov: a rigid body whose angular velocity along a body-fixed axis n is forbidden.
//
//   SO(3),  l(Omega) = 1/2 Omega^T I Omega,  n . Omega = 0.
// With u1, u2, n a right-handed orthonormal frame, J = (u_i^T I u_j), k = (u_i^T I n), w the
// components of Omega on u1, u2, w~ = (-w2, w1):
//   J w' = p w~,  p = k.w;   q = k^T J^-1 w~;   p' = p q,  q' = -p^2 / det J.
// Hence, with A^2 = q0^2 + p0^2 / det J and sinh(A t0) = q0 sqrt(det J) / |p0|,
//   q = -A tanh A(t - t0),   p = sign(p0) sqrt(det J) A sech A(t - t0),
// and w from the linear system k.w = p, -b1 w2 + b2 w1 = q, b = J^-1 k. The motion is heteroclinic:
// it tends to the line p = 0. If k = 0 (n a principal axis) or p0 = 0, Omega is constant. Source:
// Suslov 1902; Fedorov, Kozlov, Various aspects of n-dimensional rigid body dynamics (1995).
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

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

  /// The reduced motion w(t), embedded as Omega(t): suslov.cpp. Numbers of no alignment, whatever a
  /// program is compiled with.
  class Velocity {
   public:
    Velocity(const Suslov& body, const double* omega0);
    Vec<3> operator()(double t) const {
      Vec<3> omega;
      at(t, omega.data());
      return omega;
    }
    /// A bound on the rates of the motion: |Omega| is bounded through the energy and the moments.
    double rate() const { return rate_; }
    bool constant() const { return a_ == 0; }

   private:
    void at(double t, double* omega) const;
    double frame_[6], solve_[4] = {}, w0_[2];  // 3 x 2, 2 x 2, column by column
    double root_det_ = 0, a_ = 0, at0_ = 0, rate_ = 0;
  };

  // (A template, so that it costs nothing where it is not called.)
  template <class V = Vec<3>>
  auto exact(const SO3::Element<double>& r0, const std::type_identity_t<V>& omega0) const {
    Velocity velocity(*this, omega0.data());
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
