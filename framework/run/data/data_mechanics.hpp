// The mechanics of a system by data: matrices and vectors whose entries are formulas. Not
// installed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <hamel/framework/io/expression.hpp>
#include <hamel/framework/mechanics/coordinate_rates.hpp>
#include <hamel/framework/mechanics/inputs.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>

namespace hamel {

/// A matrix of numbers and formulas.
struct FormulaMatrix {
  struct Entry {
    Eigen::Index row, column;
    Expression value;
    std::string text, where;  // "system.toml:4:9: potential"
  };
  Eigen::MatrixXd constant;  // 0 where there is a formula
  std::vector<Entry> entries;

  bool is_constant() const { return entries.empty(); }
  bool is_zero() const { return is_constant() && constant.isZero(0); }
  bool uses(size_t first, size_t last) const;  // variables first <= i < last
  /// out += factor times the rate of the matrix, times x.
  template <class X, class Out>
  void add_rate(std::span<const double> values, std::span<const double> rates, double factor,
                const X& x, Out&& out) const {
    for (const Entry& e : entries) out[e.row] += factor * e.value.rate(values, rates) * x[e.column];
  }
  template <class Out>
  void at(std::span<const double> values, Out&& out) const {
    for (Eigen::Index j = 0; j < constant.cols(); ++j)
      for (Eigen::Index i = 0; i < constant.rows(); ++i) out(i, j) = constant(i, j);
    for (const Entry& e : entries) out(e.row, e.column) = e.value(values);
  }
};

/// The formulas of a system. Their variables, in this order: coordinates, t, inputs, rates.
struct DataFormulas {
  FormulaMatrix inertia, rows, drift, holonomic, potential, force;
  size_t inputs = 0;

  bool left_invariant() const;
};

class DataMechanics final : public Mechanics {
 public:
  /// given: null where no input drives it, and its formulas have none.
  DataMechanics(DataFormulas formulas, const GroupInfo& group,
                std::shared_ptr<const Geometry> geometry, std::shared_ptr<const Inputs> given);
  int dim() const override { return n_; }
  int constraint_count() const override { return own_ + held_; }
  int holonomic_rows() const override { return held_; }
  bool constant_inertia() const override { return f_.inertia.is_constant(); }
  bool constant_constraints() const override;
  bool autonomous() const override { return autonomous_; }
  bool has_force() const override { return !f_.force.is_zero(); }
  bool has_drift() const override { return !f_.drift.is_zero(); }
  bool force_depends_on_velocity() const override { return velocity_force_; }
  void inertia(const double* g, Matrix out) const override;
  void constraints(double t, const double* g, Matrix a, Vector b) const override;
  bool rates(double t, const double* g, ConstVector xi, Vector rows,
             Vector momentum) const override;
  void holonomic(const double* g, Vector out) const override;
  void force(double t, const double* g, ConstVector xi, Vector out) const override;
  void inertial_force(const double* g, ConstVector xi, Vector out) const override;
  double power(double t, const double* g, ConstVector xi) const override;
  double potential(const double* g) const override;

  /// Formulas, or derivatives of them, that are not finite there.
  std::vector<std::string> start_mistakes(double t, const double* g, ConstVector xi) const;

 private:
  size_t time() const { return static_cast<size_t>(geometry_->columns()); }
  void take(const double* g) const;
  void take(double t) const;
  void take(ConstVector xi) const;
  void add_inertial_slopes(ConstVector xi) const;  // of 1/2 xi^T I xi by the coordinates

  DataFormulas f_;
  std::shared_ptr<const Geometry> geometry_;
  CoordinateRates rates_;
  std::shared_ptr<const Inputs> given_;
  int n_, own_, held_;
  bool autonomous_, velocity_force_, exact_rates_;
  mutable std::vector<double> values_,
      slopes_;  // of the variables; of the coordinates, or their rates
  mutable Eigen::VectorXd now_;
};

}  // namespace hamel
