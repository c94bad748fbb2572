// A problem whose types are known at run time only: systems by data, products put together by name,
// and all others without a compiled kernel. Vectors are allocated once, by whoever keeps them.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/lie/linear_solve.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>
#include <hamel/framework/metric/metric.hpp>

namespace hamel {

class DynamicProblem {
 public:
  static constexpr bool left_invariant = false;
  using Element = Eigen::VectorXd;  // as Packing lays it out
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;
  using State = Eigen::VectorXd;  // xi
  using StateMatrix = Eigen::MatrixXd;
  using TwoStates = Eigen::VectorXd;
  using TwoStatesMatrix = Eigen::MatrixXd;
  using ConstraintMatrix = Eigen::MatrixXd;
  using Multipliers = Eigen::VectorXd;
  using HolonomicValues = Eigen::VectorXd;
  using Metric = hamel::Metric<>;
  using Unconstrained = DynamicProblem;

  DynamicProblem(std::shared_ptr<const Geometry> geometry,
                 std::shared_ptr<const Mechanics> mechanics)
      : geometry_(std::move(geometry)), mechanics_(std::move(mechanics)) {}
  DynamicProblem unconstrained() const {
    return {geometry_, std::make_shared<UnconstrainedMechanics>(mechanics_)};
  }

  int dim() const { return mechanics_->dim(); }
  int constraint_count() const { return mechanics_->constraint_count(); }
  int holonomic_rows() const { return mechanics_->holonomic_rows(); }
  int state_size() const { return mechanics_->dim(); }
  bool symmetric() const { return geometry_->symmetric(); }
  bool one_parameter() const { return geometry_->one_parameter(); }

  Element element() const { return Element::Zero(geometry_->size()); }
  void compose(const Element& g, const Element& h, Element& out) const {
    geometry_->compose(g.data(), h.data(), out.data());
  }
  void inverse(const Element& g, Element& out) const { geometry_->inverse(g.data(), out.data()); }
  void normalise(Element& g) const { geometry_->normalise(g.data()); }
  double defect(const Element& g) const { return geometry_->defect(g.data()); }
  double rotation_angle(const Element& g) const { return geometry_->rotation_angle(g.data()); }
  static bool same(const Element& g, const Element& h) { return g == h; }
  void Ad_transpose(const Element& g, const Vector& mu, Vector& out) const {
    geometry_->Ad_transpose(g.data(), mu.data(), out.data());
  }
  void ad_transpose(const Vector& xi, const Vector& mu, Vector& out) const {
    geometry_->ad_transpose(xi.data(), mu.data(), out.data());
  }
  void tau(const Vector& xi, Element& out) const { geometry_->tau(xi.data(), out.data()); }
  void dtau_right_transpose(const Vector& xi, const Vector& m, Vector& out) const {
    geometry_->dtau_right_transpose(xi.data(), m.data(), out.data());
  }
  void dtau_right_inverse_transpose(const Vector& xi, const Vector& p, Vector& out) const {
    geometry_->dtau_right_inverse_transpose(xi.data(), p.data(), out.data());
  }
  void dtau_left_inverse(const Vector& xi, const Vector& eta, Vector& out) const {
    geometry_->dtau_left_inverse(xi.data(), eta.data(), out.data());
  }
  void tau_with_rate(const Vector& xi, const Vector& eta, Element& g, Vector& rate) const {
    tau(xi, g);
    dtau_left_inverse(xi, eta, rate);
  }
  void mixed_momentum(double s, const Vector& xi, const Vector& p, const Vector& nu,
                      Vector& q) const {
    geometry_->mixed_momentum(s, xi.data(), p.data(), nu.data(), q.data());
  }
  bool in_domain(const Vector& xi) const { return geometry_->in_domain(xi.data()); }
  bool recover_step(const Element& delta, double s, Vector& xi) const {
    return geometry_->recover_step(delta.data(), s, xi.data());
  }
  int element_size() const { return geometry_->size(); }
  static void store(const Element& g, double* out) { std::copy(g.begin(), g.end(), out); }
  int columns() const { return geometry_->columns(); }
  void coordinates(const Element& g, double* out) const { geometry_->coordinates(g.data(), out); }
  void from_coordinates(std::span<const double> values, Element& out) const {
    geometry_->from_coordinates(values, out.data());
  }
  void nearest(std::span<const double> values, Element& out) const {
    geometry_->nearest(values, out.data());
  }

  static void velocity(const State& x, Vector& xi) { xi = x; }
  static void to_state(const Vector& xi, State& x) { x = xi; }
  static void momentum(const Matrix& inertia, const State& x, Vector& mu) {
    multiply(inertia, x, mu);
  }

  bool constant_inertia() const { return mechanics_->constant_inertia(); }
  bool constant_constraints() const { return mechanics_->constant_constraints(); }
  void inertia(const Element& g, Matrix& out) const { mechanics_->inertia(g.data(), out); }
  void momentum_at(const Element& g, const Vector& xi, Vector& out, Vector& inertial_force) const {
    mechanics_->momentum(g.data(), xi, out, inertial_force);
  }
  void constraints(double t, const Element& g, ConstraintMatrix& a, Multipliers& b) const {
    mechanics_->constraints(t, g.data(), a, b);
  }
  void constraint_values(double t, const Element& g, const Vector& xi, Multipliers& out) const {
    mechanics_->constraint_values(t, g.data(), xi, out);
  }
  void motion(double t, const Element& g, const Vector& xi, Matrix& inertia, ConstraintMatrix& a,
              Multipliers& b, Multipliers& rows, Vector& change) const {
    mechanics_->motion(*geometry_, t, g.data(), xi, inertia, a, b, rows, change);
  }
  bool has_accelerations() const { return mechanics_->has_accelerations(); }
  void accelerations(double t, const Element& g, const State& x, State& rate) const {
    mechanics_->accelerations(t, g.data(), x, rate);
  }
  bool framed() const { return mechanics_->framed_size() > 0; }
  void expand(const Element& g, const State& x, Vector& xi) const {
    mechanics_->expand(g.data(), x, xi);
  }
  void framed_motion(double t, const Element& g, const State& x, Vector& xi, State& rate) const {
    mechanics_->framed_motion(t, g.data(), x, xi, rate);
  }
  bool autonomous() const { return mechanics_->autonomous(); }
  void holonomic(const Element& g, HolonomicValues& phi) const {
    mechanics_->holonomic(g.data(), phi);
  }
  void force(double t, const Element& g, const Vector& xi, Vector& out) const {
    mechanics_->force(t, g.data(), xi, out);
  }
  void inertial_force(const Element& g, const Vector& xi, Vector& out) const {
    mechanics_->inertial_force(g.data(), xi, out);
  }
  void applied_force(double t, const Element& g, const Vector& xi, Vector& out) const {
    mechanics_->applied_force(t, g.data(), xi, out);
  }
  bool force_depends_on_velocity() const { return mechanics_->force_depends_on_velocity(); }
  double potential(const Element& g) const { return mechanics_->potential(g.data()); }

 private:
  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> mechanics_;
};

}  // namespace hamel
