// lift on a general system (method.md, section 3; the left-invariant case is schemes/lift.hpp).
//
// Unknown v = xi/h. With z0 = -s xi, z1 = (1-s) xi, f_i = tau(z_i), base point g = g0 f0^-1, g1 = g f1,
//   p = I(g) v,   nu = h force(t + s h, g, v),   C = (s dR_{z0} + (1-s) dR_{z1})^T.
// Momenta carried to the base point, m_i = Ad*_{f_i^-1} mu_i, satisfy (trivialised.hpp)
//   (1)  s dR_{z0}^T m0 + (1-s) dR_{z1}^T m1 = p,     (2)  m1 - m0 = nu,
// hence m0 = C^-1 (p - (1-s) dR_{z1}^T nu), m1 = m0 + nu, mu_i = Ad_{f_i}^T m_i. The step solves
//   E(g0)^T (mu0 - I(g0) xi_0) = 0,    A(g) v = b(t + s h, g),   phi(g1) = 0 in place of its rows,
// in the frame at g0 ((*) of place.hpp), and xi_1 is the admissible velocity of mu1 at g1.
// This is the discrete Lagrange-d'Alembert principle for L_d(g0, g1) = h L(g, xi/h).
#pragma once

#include <hamel/framework/mechanics/place.hpp>
#include <hamel/framework/schemes/general_step.hpp>

namespace hamel {

template <int N, int K>
class GeneralLift final : public GeneralStep {
  using Z = Sized<N, K>;
  using Vector = typename Z::Vector;

 public:
  explicit GeneralLift(const GeneralSetup& setup);
  int size() const override { return n_; }
  void begin(const Node& node, double h) override;
  void guess(Unknown& x) const override { x = xi0_; }
  double scale_squared() const override { return scale_squared_; }
  void residual(const Unknown& x, Unknown& f) const override;
  bool finish(const Unknown& x, Node& next) const override;
  void from_frame(Unknown& z) const override { place_.from_frame(z.data()); }

 private:
  void evaluate(const Unknown& x) const;

  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> system_;
  int n_;
  double s_, t_ = 0, h_ = 0, scale_squared_ = 0;
  bool mirrored_;  // s = 1/2 and tau symmetric: f0 = f1^-1
  Eigen::VectorXd g0_;
  Vector xi0_, target_;
  // Work: the place at place_g_ (g0, and g1 once finished), and what the last x determined. Allocated once.
  mutable Place<N, K> place_;
  mutable Eigen::VectorXd place_g_;
  mutable double place_time_;
  mutable Eigen::VectorXd f0_, f1_, base_, g1_;
  mutable Vector v_, z_, step_, p_, nu_, m_, mu_, r_;
  mutable typename Z::Matrix inertia_;
  mutable typename Z::Rows a_;
  mutable typename Z::Few b_, rows_;
  mutable Eigen::VectorXd phi_;
};

}  // namespace hamel
