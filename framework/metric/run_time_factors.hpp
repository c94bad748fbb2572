// Accelerations by factors whose sizes are known at run time only: those of I and of A I^-1 A^T
// along the branches (branched_factors.hpp), or the frame of the admissible velocities
// (run_time_frame.hpp).
//
// A chain with a row for each of its links, as a train of trailers, has a full I and a full A I^-1
// A^T of nearly its size: their factors cost n^3. Its frame has few columns, and each row of A ends
// where its link does: n^2.
#pragma once

#include <optional>

#include <Eigen/Core>

#include <hamel/framework/lie/linear_solve.hpp>
#include <hamel/framework/metric/branched_factors.hpp>
#include <hamel/framework/metric/run_time_frame.hpp>

namespace hamel {

class RunTimeFactors : public BranchedFactors {
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;

 public:
  RunTimeFactors(int n, int k) : BranchedFactors(has_frame(n, k) ? 0 : n, has_frame(n, k) ? 0 : k) {
    if (has_frame(n, k)) frame_.emplace(n, k);
  }

  /// Are accelerations those of the frame? Then only the functions below are to be called.
  bool framed() const { return frame_.has_value(); }
  /// False where I is not definite; in a frame it need be so on ker A only.
  bool find_root(const Matrix& inertia) { return framed() || BranchedFactors::find_root(inertia); }
  void find_rows(const Matrix& inertia, const Matrix& a) {
    if (framed()) frame_->set(inertia.data(), a.data(), /*same_frame=*/false);
    else BranchedFactors::find_rows(a);
  }
  void apply_inertia(const Matrix& inertia, const Vector& xi, Vector& mu) const {
    if (framed()) multiply(inertia, xi, mu);
    else BranchedFactors::apply_inertia(inertia, xi, mu);
  }

  /// In a frame: the acceleration with A acceleration = c and E^T I acceleration = E^T change.
  void accelerate(const Vector& change, const Vector& c, Vector& acceleration) {
    frame_->velocity(change.data(), c.data(), acceleration.data());
  }
  /// In a frame: the lambda of a reaction A^T lambda.
  void multipliers(const Vector& reaction, Vector& lambda) {
    frame_->multipliers(reaction.data(), lambda.data());
  }

 private:
  static bool has_frame(int n, int k) { return n > 12 && 2 * k > n; }
  std::optional<RunTimeFrame> frame_;
};

}  // namespace hamel
