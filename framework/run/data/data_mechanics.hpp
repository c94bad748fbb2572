// The mechanics of a system by data: matrices and vectors whose entries are formulas. Not
// installed.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <hamel/framework/graph/system_formulas.hpp>
#include <hamel/framework/mechanics/coordinate_rates.hpp>
#include <hamel/framework/mechanics/inputs.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>
#include <hamel/framework/run/data/formula_programs.hpp>

namespace hamel {

class DataMechanics final : public Mechanics, public graph::HasSystemFormulas {
 public:
  /// given: null where no input drives it, and its formulas have none.
  DataMechanics(std::shared_ptr<const FormulaPrograms> programs, const GroupInfo& group,
                std::shared_ptr<const Geometry> geometry, std::shared_ptr<const Inputs> given);
  int dim() const override { return n_; }
  int constraint_count() const override { return own_ + held_; }
  int holonomic_rows() const override { return held_; }
  bool constant_inertia() const override { return f_.inertia.is_constant(); }
  bool constant_constraints() const override;
  bool autonomous() const override { return autonomous_; }
  bool has_force() const override { return !f_.force.is_zero(); }
  bool has_drift() const override { return !f_.drift.is_zero() || states_ > 0; }
  bool force_depends_on_velocity() const override { return velocity_force_; }
  void inertia(const double* g, Matrix out) const override;
  void constraints(double t, const double* g, Matrix a, Vector b) const override;
  bool exact_rates() const override { return exact_rates_; }
  void rates(const Geometry& geometry, double t, const double* g, ConstVector xi, Vector rows,
             Vector momentum) const override;
  void holonomic(const double* g, Vector out) const override;
  void force(double t, const double* g, ConstVector xi, Vector out) const override;
  void inertial_force(const double* g, ConstVector xi, Vector out) const override;
  double power(double t, const double* g, ConstVector xi) const override;
  double potential(const double* g) const override;

  graph::SystemFormulas system_formulas(std::span<const graph::Number> variables) const override;

  /// Formulas, or derivatives of them, that are not finite there.
  std::vector<std::string> start_mistakes(double t, const double* g, ConstVector xi) const;

 private:
  size_t time() const { return static_cast<size_t>(geometry_->columns()); }
  void take(const double* g) const;
  void take(double t) const;
  void take(ConstVector xi) const;
  const double* outputs(Evaluation e) const;  // at the values taken

  std::shared_ptr<const FormulaPrograms> programs_;
  DataFormulas f_;  // a copy: expressions serve one thread
  std::shared_ptr<const Geometry> geometry_;
  CoordinateRates rates_;
  std::shared_ptr<const Inputs> given_;
  int n_, states_, own_, held_;  // own_: rows that are no differentials, those of states the last
  bool autonomous_, velocity_force_, exact_rates_;
  mutable std::vector<double> values_;          // of the variables, then their rates
  mutable std::vector<double> outputs_, work_;  // of the program evaluated last; its work space
  mutable Eigen::VectorXd now_;
};

}  // namespace hamel
