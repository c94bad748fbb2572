// What explicit schemes on the equations of motion share: the classical Runge-Kutta method of order 4.
//
// In coordinates q of the element of its own choice, a scheme integrates
//   q' = rate(q, xi),   xi' = a(t, g, xi)   (Lagrange-d'Alembert, motion.hpp),   g = element(q),
// with the stages at 0, 1/2, 1/2, 1 and the weights 1/6, 1/3, 1/3, 1/6. Then g goes to the group and xi onto
// A xi = b, orthogonally in the metric I: that is all that is kept.
// Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, II.1.
#pragma once

#include <hamel/framework/mechanics/motion.hpp>
#include <hamel/framework/mechanics/place.hpp>
#include <hamel/framework/schemes/general_step.hpp>

namespace hamel {

class ExplicitStep : public GeneralStep {
 public:
  /// A step solves no equation.
  int size() const final { return 0; }
  void guess(Unknown& /*x*/) const final {}
  double scale_squared() const final { return 1; }
  void residual(const Unknown& /*x*/, Unknown& /*f*/) const final {}

  void begin(const Node& node, double h) final;
  bool finish(const Unknown& x, Node& next) const final;

 protected:
  /// coordinates: how many numbers q has.
  ExplicitStep(const GeneralSetup& setup, int coordinates);

  /// The coordinates of the element g that a step starts from.
  virtual void start(const Eigen::VectorXd& g, Eigen::VectorXd& q) = 0;
  /// The element at q; false outside the domain of the coordinates.
  virtual bool element(const Eigen::VectorXd& q, Eigen::VectorXd& g) const = 0;
  /// q', at the element g of q.
  virtual void rate(const Eigen::VectorXd& q, const Eigen::VectorXd& g, const Eigen::VectorXd& xi,
                    Eigen::VectorXd& out) const = 0;

  std::shared_ptr<const Geometry> geometry_;

 private:
  std::shared_ptr<const Mechanics> system_;
  mutable Motion motion_;
  mutable Place<> place_;
  double t_ = 0, h_ = 0;
  Eigen::VectorXd xi0_, q0_;
  mutable Eigen::VectorXd g_, q_, rate_, q_sum_, xi_, xi_sum_, mu_;
};

}  // namespace hamel
