// A watch over rows that move, A(g) xi = b(t, g): where they become dependent, the velocity that
// they require has no bound, and a step of one size may jump over the place. Not installed.
//
// The rows are taken of size 1, in units of the velocities in which each has the same energy. With
// E a basis of their kernel at the last node, det [A; E^T] has a sign there. At the next node it is
// 0 where A has become dependent, and of the other sign where the rows passed such a place in
// between, or their kernel turned by more than a right angle: no step that resolves the motion does
// so.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/QR>

#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/loop/snapshot.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {

class HasImpliedRows;

class RowsWatch {
 public:
  RowsWatch(std::shared_ptr<const Geometry> geometry, const SystemModel& system,
            std::shared_ptr<const Mechanics> mechanics);

  /// The condition above which rows are named where a run fails: the velocity that they require
  /// grows with it.
  static constexpr double kNearlyDependent = 100;

  /// The first node, also behind an impact.
  void begin(const Snapshot& state);
  /// The next node; where its rows are dependent, or became so since the last one, or contradict
  /// each other, as text.
  std::optional<std::string> node(const Snapshot& state);
  /// The condition of the rows at a state: the largest of their singular values over the smallest.
  double condition(const Snapshot& state);
  /// The rows that are dependent at the last state, or nearly.
  std::string names() const;
  /// "; the rows are nearly dependent there: …" where they are; else empty.
  std::string remark(const Snapshot& state);

 private:
  void set_rows(const Snapshot& state);
  void set_frame(double t);
  // Factors of [A; E^T], without memory taken.
  dense::Pivots pivots();

  std::shared_ptr<const Geometry> geometry_;
  const SystemModel& system_;
  std::shared_ptr<const Mechanics> mechanics_;
  const HasImpliedRows* implied_;  // of mechanics_; null where there are none
  Eigen::VectorXd g_, b_;
  Eigen::MatrixXd rows_, columns_, inertia_, frame_, whole_;  // A, A^T, I, E, [A; E^T]
  Eigen::HouseholderQR<Eigen::MatrixXd> qr_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  Eigen::RowVectorXd work_;
  double last_time_ = 0;
  int sign_ = 1;  // of the determinant at the last node
};

}  // namespace hamel
