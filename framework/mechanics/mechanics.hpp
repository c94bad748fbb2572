// A nonholonomic system, its type erased; everything may depend on the configuration.
//
//   L(g, xi) = 1/2 xi^T I(g) xi - V(g), force f(t, g, xi) in the dual of the algebra
//   A(t, g) xi = b(t, g)    k rows; the last of them are the differentials of the holonomic rows
//   phi(g) = 0              holonomic rows, imposed at the ends of each step, (M19)
// general_system.hpp derives a Mechanics from a system's struct. A system whose dimension is a
// parameter derives from Mechanics itself (systems/n_trailer.hpp), and states I, A and the force;
// the rest follows from them (mechanics.cpp), and is overridden where a system computes it faster
// or exactly.
#pragma once

#include <memory>
#include <utility>

#include <Eigen/Core>

namespace hamel {

class Geometry;

/// Sizes are fixed in the life of an object; out-parameters have these sizes. Elements as Packing.
class Mechanics {
 public:
  using Vector = Eigen::Ref<Eigen::VectorXd>;
  using Matrix = Eigen::Ref<Eigen::MatrixXd>;
  using ConstVector = Eigen::Ref<const Eigen::VectorXd>;

  virtual ~Mechanics() = default;
  virtual int dim() const = 0;               // n
  virtual int constraint_count() const = 0;  // k
  virtual int holonomic_rows() const { return 0; }
  virtual bool constant_inertia() const { return true; }
  virtual bool constant_constraints() const { return false; }
  /// Constant inertia and rows A xi = 0, and nothing else.
  virtual bool left_invariant() const { return false; }
  /// Are A, b and f the same at all times?
  virtual bool autonomous() const { return true; }
  /// Is there a force f beside the potential, a drift b? Else the energy is kept, (M47).
  virtual bool has_force() const { return false; }
  virtual bool has_drift() const { return false; }

  /// I(g), n x n.
  virtual void inertia(const double* g, Matrix out) const = 0;
  /// I(g) xi and 1/2 d(xi^T I(g) xi), n entries each.
  virtual void momentum(const double* g, ConstVector xi, Vector out, Vector inertial_force) const {
    momentum_of_inertia(g, xi, out, inertial_force);
  }
  /// A(t, g), k x n, and b(t, g).
  virtual void constraints(double t, const double* g, Matrix a, Vector b) const = 0;
  /// A xi - b, k entries.
  virtual void constraint_values(double t, const double* g, ConstVector xi, Vector out) const {
    values_of_constraints(t, g, xi, out);
  }
  /// Are rates() and motion() free of differences?
  virtual bool exact_rates() const { return false; }
  /// db/dt - (dA/dt) xi, k entries, and (dI/dt) xi, n entries, along (t, g) at g' = g xi. Only
  /// tau and products are taken of the geometry.
  virtual void rates(const Geometry& geometry, double t, const double* g, ConstVector xi,
                     Vector rows, Vector momentum) const {
    rates_by_differences(geometry, t, g, xi, rows, momentum);
  }
  /// All of the equations of motion: I and A, b (left as they are where they are constant), db/dt -
  /// (dA/dt) xi, and ad*_xi I xi + F - (dI/dt) xi.
  virtual void motion(const Geometry& geometry, double t, const double* g, ConstVector xi,
                      Matrix inertia, Matrix a, Vector b, Vector rows, Vector change) const {
    motion_of_parts(geometry, t, g, xi, inertia, a, b, rows, change);
  }
  /// A run begins: what was chosen on the way of another one is forgotten, so that a motion depends
  /// on its start alone.
  virtual void begin() const {}
  /// Has it xi' of the equations of motion at once, at an admissible (t, g, xi)?
  virtual bool has_accelerations() const { return false; }
  virtual void accelerations(double /*t*/, const double* /*g*/, ConstVector /*xi*/,
                             Vector /*out*/) const {}
  /// How many velocities are independent in the frame that a system states, the first of xi
  /// (framed_equations.hpp); 0: it states none.
  virtual int framed_size() const { return 0; }
  /// xi = E(g) y, y the first entries of x.
  virtual void expand(const double* /*g*/, ConstVector /*x*/, Vector /*xi*/) const {}
  /// The same, and xi' of the equations of motion.
  virtual void framed_motion(double /*t*/, const double* /*g*/, ConstVector /*x*/, Vector /*xi*/,
                             Vector /*rate*/) const {}
  /// phi(g).
  virtual void holonomic(const double* /*g*/, Vector /*out*/) const {}
  /// F = f - dV + 1/2 d(xi^T I(g) xi) of (M3): the force on the momentum in the dual.
  virtual void force(double /*t*/, const double* /*g*/, ConstVector /*xi*/, Vector out) const {
    out.setZero();
  }
  /// Its last part, 1/2 d(xi^T I(g) xi); zero where I is constant.
  virtual void inertial_force(const double* /*g*/, ConstVector /*xi*/, Vector out) const {
    out.setZero();
  }
  /// The rest of it, f - dV.
  virtual void applied_force(double t, const double* g, ConstVector xi, Vector out) const {
    force_without_inertial(t, g, xi, out);
  }
  /// Does f of (M3) depend on xi?
  virtual bool force_depends_on_velocity() const { return true; }
  /// <f, xi>, the power of the force.
  virtual double power(double /*t*/, const double* /*g*/, ConstVector /*xi*/) const { return 0; }
  /// V(g).
  virtual double potential(const double* /*g*/) const { return 0; }

 private:
  // The defaults, out of line; the virtual functions are not, as every object needs the vtable
  // (tools/cmake/localise).
  void momentum_of_inertia(const double* g, ConstVector xi, Vector out,
                           Vector inertial_force) const;
  void values_of_constraints(double t, const double* g, ConstVector xi, Vector out) const;
  void rates_by_differences(const Geometry& geometry, double t, const double* g, ConstVector xi,
                            Vector rows, Vector momentum) const;
  void motion_of_parts(const Geometry& geometry, double t, const double* g, ConstVector xi,
                       Matrix inertia, Matrix a, Vector b, Vector rows, Vector change) const;
  void force_without_inertial(double t, const double* g, ConstVector xi, Vector out) const;
};

/// The left-invariant case: constant inertia and rows, nothing else.
class LeftInvariantMechanics : public Mechanics {
 public:
  LeftInvariantMechanics(Eigen::MatrixXd inertia, Eigen::MatrixXd constraints)
      : inertia_(std::move(inertia)), constraints_(std::move(constraints)) {}
  int dim() const override { return static_cast<int>(inertia_.rows()); }
  int constraint_count() const override { return static_cast<int>(constraints_.rows()); }
  bool constant_constraints() const override { return true; }
  bool left_invariant() const override { return true; }
  void inertia(const double* /*g*/, Matrix out) const override { out = inertia_; }
  void constraints(double /*t*/, const double* /*g*/, Matrix a, Vector b) const override {
    a = constraints_;
    b.setZero();
  }

 private:
  Eigen::MatrixXd inertia_, constraints_;
};

/// A system without its rows: what the free steps of unadapted and gni integrate.
class UnconstrainedMechanics final : public Mechanics {
 public:
  explicit UnconstrainedMechanics(std::shared_ptr<const Mechanics> system)
      : system_(std::move(system)),
        a_(system_->constraint_count(), system_->dim()),
        b_(system_->constraint_count()),
        rows_(b_) {}
  int dim() const override { return system_->dim(); }
  int constraint_count() const override { return 0; }
  bool constant_inertia() const override { return system_->constant_inertia(); }
  bool constant_constraints() const override { return true; }
  bool left_invariant() const override { return system_->left_invariant(); }
  void inertia(const double* g, Matrix out) const override { system_->inertia(g, out); }
  void momentum(const double* g, ConstVector xi, Vector out, Vector force) const override {
    system_->momentum(g, xi, out, force);
  }
  void constraints(double, const double*, Matrix, Vector) const override {}
  bool exact_rates() const override { return system_->exact_rates(); }
  void rates(const Geometry& geometry, double t, const double* g, ConstVector xi, Vector,
             Vector momentum) const override {
    system_->rates(geometry, t, g, xi, rows_, momentum);
  }
  void motion(const Geometry& geometry, double t, const double* g, ConstVector xi, Matrix inertia,
              Matrix, Vector, Vector, Vector change) const override {
    system_->motion(geometry, t, g, xi, inertia, a_, b_, rows_, change);
  }
  bool autonomous() const override { return system_->autonomous(); }
  bool has_force() const override { return system_->has_force(); }
  void force(double t, const double* g, ConstVector xi, Vector out) const override {
    system_->force(t, g, xi, out);
  }
  void inertial_force(const double* g, ConstVector xi, Vector out) const override {
    system_->inertial_force(g, xi, out);
  }
  void applied_force(double t, const double* g, ConstVector xi, Vector out) const override {
    system_->applied_force(t, g, xi, out);
  }
  bool force_depends_on_velocity() const override { return system_->force_depends_on_velocity(); }
  double power(double t, const double* g, ConstVector xi) const override {
    return system_->power(t, g, xi);
  }
  double potential(const double* g) const override { return system_->potential(g); }

 private:
  std::shared_ptr<const Mechanics> system_;
  mutable Eigen::MatrixXd a_;  // work space
  mutable Eigen::VectorXd b_, rows_;
};

}  // namespace hamel
