// Formulas of a state as recorded programs, with their exact derivatives: path and cost of plans.
// Not installed.
//
//   f(q), q = (eta, xi, t): at the coordinates of g tau(eta), eta = 0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/graph/code.hpp>
#include <hamel/framework/run/data/event_formula.hpp>
#include <hamel/framework/run/run/plan/plan.hpp>

namespace hamel {

/// A formula of a state in the current recording. Throws std::domain_error where it is none.
using RecordedNumber = StateVariables::Recorded;

class RecordedPath {
 public:
  /// Null where one of them is no formula, or where the group has no recorded geometry; and where
  /// one depends on the velocity while rows or inertia change along the group, as then xi(eta) is
  /// curved.
  static std::unique_ptr<RecordedPath> of(const RunPlan& plan,
                                          const std::vector<RecordedNumber>& formulas);

  /// At a state; false where a value or slope is not finite.
  bool evaluate(double t, std::span<const double> coordinates, std::span<const double> velocity);
  Eigen::VectorXd values() const;
  /// By q, a row for each formula.
  const Eigen::MatrixXd& slopes() const { return slopes_; }
  /// Second derivatives of weights . f by q, behind evaluate().
  const Eigen::MatrixXd& hessian(const Eigen::VectorXd& weights);

 private:
  struct Entry {
    Eigen::Index row, column;
  };
  RecordedPath() = default;
  std::size_t columns_ = 0, n_ = 0, count_ = 0;
  std::vector<Entry> slope_entries_, second_entries_;
  std::unique_ptr<graph::Code> first_, second_;
  std::vector<double> in_, out_, work_;
  Eigen::MatrixXd slopes_, hessian_;
};

}  // namespace hamel
