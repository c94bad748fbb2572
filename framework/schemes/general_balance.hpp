// balance on a general system (method.md, section 3; the left-invariant case is schemes/balance.hpp).
//
// The nodal momenta are embedded, mu_i = I(g_i) xi_i. Unknowns v = xi/h and w = xi_1. With z0 = -s xi,
// z1 = (1-s) xi, f_i = tau(z_i), base point g = g0 f0^-1, g1 = g f1, m_i = Ad*_{f_i^-1} mu_i,
// nu = h force(t + s h, g, v), both equations of the cotangent lift are balanced on d at g:
//   E(g)^T ( s dR_{z0}^T m0 + (1-s) dR_{z1}^T m1 - I(g) v ) = 0,   A(g) v = b(t + s h, g),
//   E(g)^T ( m1 - m0 - nu ) = 0,                                   A(g1) w = b(t + h, g1),
// with phi(g1) = 0 in place of its rows of A(g) v = b. Each line is one (*) of place.hpp, in the frame at g.
#pragma once

#include <hamel/framework/mechanics/place.hpp>
#include <hamel/framework/schemes/general_step.hpp>

namespace hamel {

template <int N, int K>
class GeneralBalance final : public GeneralStep {
  using Z = Sized<N, K>;
  using Vector = typename Z::Vector;

 public:
  /// ends_only: the scheme reversible (balance.cpp).
  explicit GeneralBalance(const GeneralSetup& setup, bool ends_only = false);
  int size() const override { return 2 * n_; }
  void begin(const Node& node, double h) override;
  void guess(Unknown& x) const override;
  double scale_squared() const override { return scale_squared_; }
  void residual(const Unknown& x, Unknown& f) const override;
  bool finish(const Unknown& x, Node& next) const override;
  void from_frame(Unknown& z) const override {
    base_place_.from_frame(z.data());
    base_place_.from_frame(z.data() + n_);
  }

 private:
  void evaluate(const Unknown& x) const;

  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> system_;
  int n_;
  bool ends_only_;
  double s_, t_ = 0, h_ = 0, scale_squared_ = 0;
  Eigen::VectorXd g0_;
  Vector xi0_, mu0_;
  // Work: the place at the base point, and what the last x determined. Allocated once.
  mutable Place<N, K> base_place_;
  mutable Eigen::VectorXd f0_, f1_, base_, g1_;
  mutable Vector v_, w_, z0_, z1_, nu_, m0_, m1_, mu_, r_, u_;
  mutable typename Z::Matrix inertia_, right_;
  mutable typename Z::Rows a_;
  mutable typename Z::Few b_, rows_, end_rows_;
  mutable Eigen::VectorXd phi_;
};

}  // namespace hamel
