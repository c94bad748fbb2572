// lift on a general system (method.md, section 3; the left-invariant case is schemes/lift.hpp).
//
// Unknown v = xi/h. With z0 = -s xi, z1 = (1-s) xi, f_i = tau(z_i), base point g = g0 f0^-1, g1 = g f1,
//   p = I(g) v,   nu = h force(t + s h, g, v),   C = (s dR_{z0} + (1-s) dR_{z1})^T.
// Momenta carried to the base point, m_i = Ad*_{f_i^-1} mu_i, satisfy (trivialised.hpp)
//   (1)  s dR_{z0}^T m0 + (1-s) dR_{z1}^T m1 = p,     (2)  m1 - m0 = nu,
// hence m0 = C^-1 (p - (1-s) dR_{z1}^T nu), m1 = m0 + nu, mu_i = Ad_{f_i}^T m_i. The step solves
//   E(g0)^T (mu0 - I(g0) xi_0) = 0,    A(g) v = b(t + s h, g),   phi(g1) = 0 in place of its rows,
// as the one equation (*) of place.hpp, and xi_1 is the admissible velocity of mu1 at g1.
// This is the discrete Lagrange-d'Alembert principle for L_d(g0, g1) = h L(g, xi/h).
#pragma once

#include <limits>

#include <hamel/framework/general/place.hpp>
#include <hamel/framework/general/step.hpp>

namespace hamel {

template <int N>
class GeneralLift final : public GeneralStep {
  using Z = Sized<N>;
  using Vector = typename Z::Vector;

 public:
  explicit GeneralLift(const GeneralSetup& setup);
  int size() const override { return n_; }
  void begin(const Node& node, double h) override;
  void guess(Unknown& x) const override { x = xi0_; }
  double scale_squared() const override { return scale_squared_; }
  void residual(const Unknown& x, Unknown& f) const override;
  bool finish(const Unknown& x, Node& next) const override;

 private:
  void evaluate(const Unknown& x) const;

  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> system_;
  int n_;
  double s_, t_ = 0, h_ = 0, scale_squared_ = 0;
  Eigen::VectorXd g0_;
  Vector xi0_, target_;
  // Work: places at g0 and g1, and what the last x determined. Allocated once.
  mutable Place<N> start_, end_;
  mutable Eigen::VectorXd end_g_;  // what end_ is for, and when
  mutable double end_time_ = std::numeric_limits<double>::quiet_NaN();
  mutable Eigen::VectorXd f0_, f1_, base_, g1_;
  mutable Vector v_, z0_, z1_, step_, p_, nu_, m_, mu_, r_;
  mutable typename Z::Matrix inertia_;
  mutable typename Z::Rows a_;
  mutable typename Z::Few b_, rows_, phi_;
};

}  // namespace hamel
