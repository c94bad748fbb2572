// The equations of a system as recorded programs: their terms at a state, and exact derivatives of
// all terms along displacements, velocities and inputs. Not installed.
//
//   I a = change + A^T lambda,   A a = row_rates
//   da: I da - A^T dlambda = d change - dI a + dA^T lambda,   A da = d row_rates - dA a
// The accelerations are solved with numbers, so that no frame is recorded: no pivot may vanish, and
// the programs grow with the terms alone.
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/graph/code.hpp>
#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {

/// I, A, b, the rates of rows, ad*_xi I xi + F - (dI/dt) xi; or derivatives of all.
struct MotionValues {
  Eigen::MatrixXd inertia, rows;
  Eigen::VectorXd drift, row_rates, change;
};

class RecordedMotion {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  /// Null where a system has no formulas, where those are not its own at an element, or where it
  /// has more than 40 velocities. known: of a system like it, or null; returned where formulas are
  /// the same.
  static std::shared_ptr<const RecordedMotion> of(
      const SystemModel& model, std::shared_ptr<const Geometry> geometry, const Vector& g,
      const std::shared_ptr<const RecordedMotion>& known = nullptr);

  int inputs() const { return inputs_; }
  MotionValues at(const Vector& g, const Vector& xi, double t = 0) const;
  /// Derivatives along each column (delta, nu, u): g exp(e delta), xi + e nu, inputs e u, which are
  /// 0 at the state. Of 2n rows, or more.
  std::vector<MotionValues> along(const Vector& g, const Vector& xi,
                                  const Matrix& directions) const;
  Vector acceleration(const Vector& g, const Vector& xi, double t = 0) const;
  /// Derivatives of the acceleration, column by column, by those of the terms there.
  Matrix acceleration_slopes(const Vector& g, const Vector& xi,
                             const std::vector<MotionValues>& terms) const;

 private:
  RecordedMotion() = default;
  bool has_formulas_of(const RecordedMotion& other) const;
  MotionValues values_from(const double* values, size_t stride) const;

  std::vector<graph::Node> nodes_;  // of the terms, and which of them these are
  std::vector<int> results_;
  std::shared_ptr<const Geometry> geometry_;
  int n_ = 0, k_ = 0, inputs_ = 0;
  std::vector<double> constants_;  // of the terms, 0 where they change
  std::vector<size_t> places_;     // of those that change
  std::unique_ptr<graph::Code> terms_, slopes_;
};

}  // namespace hamel
