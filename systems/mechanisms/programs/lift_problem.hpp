// The problem of lift on programs: that of any system (dynamic_problem.hpp), with elements in the
// numbers of the programs and nodes that carry what the next step needs. What measures a run goes
// through the element of the group.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <utility>

#include <hamel/framework/schemes/dynamic_problem.hpp>
#include <hamel/systems/mechanisms/programs/lift_layout.hpp>

namespace hamel::mechanisms {

class LiftProblem : public DynamicProblem {
 public:
  LiftProblem(std::shared_ptr<const Geometry> geometry, std::shared_ptr<const Mechanics> mechanics,
              std::shared_ptr<const LiftLayout> layout)
      : DynamicProblem(std::move(geometry), std::move(mechanics)),
        layout_(std::move(layout)),
        seen_(element()),
        packed_(DynamicProblem::element()) {
    seen_.setConstant(std::numeric_limits<double>::quiet_NaN());
  }

  const LiftLayout& layout() const { return *layout_; }
  /// xi, what is carried is known of (0: nothing), and the most that is carried in any frame.
  int state_size() const {
    const int n = dim(), m = n - constraint_count();
    return n + 1 + 2 * m + 2 + (n - m) * m;
  }
  void velocity(const State& x, Vector& xi) const { xi = x.head(dim()); }
  /// Nothing is carried yet.
  void to_state(const Vector& xi, State& x) const {
    x.setZero();
    x.head(dim()) = xi;
  }

  Element element() const { return Element::Zero(static_cast<Eigen::Index>(layout_->size())); }
  /// The element of the group, until the next call.
  const Element& packed(const Element& g) const {
    if (seen_ != g) {
      layout_->pack(g.data(), packed_.data());
      seen_ = g;
    }
    return packed_;
  }

  void compose(const Element& g, const Element& h, Element& out) const {
    layout_->compose(g.data(), h.data(), out.data());
  }
  void inverse(const Element& g, Element& out) const { layout_->inverse(g.data(), out.data()); }
  void normalise(Element& g) const { layout_->normalise(g.data()); }
  double defect(const Element& g) const { return DynamicProblem::defect(packed(g)); }
  double rotation_angle(const Element& g) const {
    return DynamicProblem::rotation_angle(packed(g));
  }
  void Ad_transpose(const Element& g, const Vector& mu, Vector& out) const {
    DynamicProblem::Ad_transpose(packed(g), mu, out);
  }
  void tau(const Vector& xi, Element& out) const { layout_->tau(xi.data(), out.data()); }
  bool recover_step(const Element& delta, double s, Vector& xi) const {
    return layout_->recover_step(delta.data(), s, xi.data());
  }
  void store(const Element& g, double* out) const { layout_->pack(g.data(), out); }
  void coordinates(const Element& g, double* out) const { layout_->coordinates(g.data(), out); }
  void from_coordinates(std::span<const double> values, Element& out) const {
    Element there = DynamicProblem::element();
    DynamicProblem::from_coordinates(values, there);
    layout_->unpack(there.data(), out.data());
  }
  void inertia(const Element& g, Matrix& out) const { DynamicProblem::inertia(packed(g), out); }
  void momentum_at(const Element& g, const Vector& xi, Vector& out, Vector& inertial_force) const {
    DynamicProblem::momentum_at(packed(g), xi, out, inertial_force);
  }
  void constraints(double t, const Element& g, ConstraintMatrix& a, Multipliers& b) const {
    DynamicProblem::constraints(t, packed(g), a, b);
  }
  void constraint_values(double t, const Element& g, const Vector& xi, Multipliers& out) const {
    DynamicProblem::constraint_values(t, packed(g), xi, out);
  }
  void holonomic(const Element& g, HolonomicValues& phi) const {
    DynamicProblem::holonomic(packed(g), phi);
  }
  void force(double t, const Element& g, const Vector& xi, Vector& out) const {
    DynamicProblem::force(t, packed(g), xi, out);
  }
  void inertial_force(const Element& g, const Vector& xi, Vector& out) const {
    DynamicProblem::inertial_force(packed(g), xi, out);
  }
  void applied_force(double t, const Element& g, const Vector& xi, Vector& out) const {
    DynamicProblem::applied_force(t, packed(g), xi, out);
  }
  double potential(const Element& g) const { return DynamicProblem::potential(packed(g)); }

 private:
  std::shared_ptr<const LiftLayout> layout_;
  mutable Element seen_, packed_;
};

}  // namespace hamel::mechanisms
