// The step of a run as a map from state to state, z+ = S(z; u, h): for tangents, fits and plans.
// Not installed.
//
// The map is the kernel of the run itself, begun anew at each state: whatever has a step has it,
// and a run repeats a chain of such steps to round-off. Implicit equations are solved to their
// round-off. Increments that keep the constraints are left-trivialised: (eta, dy), n + m numbers,
//   g (+) eta = g tau(eta),   xi (+) dy = projection onto A(g') xi = b of xi + E dy,
// E a basis of ker A at the state itself, orthonormal in the metric I, the projection orthogonal in
// it. Where the units of lengths and masses are changed, dy changes as the root of an energy.
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/run/run/plan/plan.hpp>

namespace hamel {

/// Place and velocity: the element as its Geometry lays it out, and xi.
struct MotionState {
  double time = 0;
  Eigen::VectorXd g, xi;
};

class StepMap {
 public:
  /// inputs: indices of those that set_inputs() sets.
  explicit StepMap(std::shared_ptr<const RunPlan> plan, std::vector<std::size_t> inputs = {});

  const RunPlan& plan() const { return *plan_; }
  const Geometry& geometry() const { return *plan_->geometry; }
  int velocities() const { return n_; }
  int increments() const { return n_ + m_; }
  int coordinate_count() const { return geometry().columns(); }

  void set_inputs(const Eigen::VectorXd& values);
  /// A step from there to time t. Not ok: it has no solution.
  Status step(const MotionState& from, double t, MotionState& to);
  /// The admissible state next to one, as a start there; false where there is none.
  bool make_admissible(MotionState& state);
  /// The same of the velocity alone.
  void project(MotionState& state);
  /// state (+) increment.
  void retract(const MotionState& state, const Eigen::VectorXd& increment, MotionState& out);
  /// The increment from one state to another, to first order in dy; false where there is none.
  bool difference(const MotionState& from, const MotionState& to, Eigen::VectorXd& out);

  /// E at a state, n x m, and its left inverse E^T I.
  const Eigen::MatrixXd& basis(const MotionState& state);
  const Eigen::MatrixXd& left_inverse(const MotionState& state);
  /// Frames are kept for each stage: that of the last retract() or basis(), and of the last
  /// difference() or left_inverse().
  void choose_stage(int k) {
    if (constant_) return;  // one frame
    stage_ = static_cast<std::size_t>(k);
    if (stage_ >= frames_.size()) frames_.resize(stage_ + 1);
  }
  /// Indices of the inputs that set_inputs() sets.
  const std::vector<std::size_t>& inputs() const { return inputs_; }

  /// The start of the run.
  MotionState start() const;
  /// Throws std::invalid_argument where the coordinates are no element.
  MotionState state_of(double t, std::span<const double> coordinates,
                       std::span<const double> velocity) const;
  /// The same without an allocation where `out` has been a state.
  void set_state(double t, std::span<const double> coordinates, std::span<const double> velocity,
                 MotionState& out) const;
  std::vector<double> coordinates(const MotionState& state) const;

 private:
  struct Frame {  // at one state: E, its left inverse E^T I
    MotionState state;
    Eigen::MatrixXd basis, inverse;
  };
  void evaluate_matrices(double t, const double* element);
  void set(Frame& frame, const MotionState& state);
  bool constant_ = false;  // I and A, b = 0: one frame, and no projection is needed

  std::shared_ptr<const RunPlan> plan_;
  std::vector<std::size_t> inputs_;
  std::unique_ptr<Kernel> kernel_;
  int n_, k_, m_;
  // Work.
  Config config_there_;  // that starts at a state
  Snapshot node_;
  struct Frames {
    Frame base, target;
  };
  std::vector<Frames> frames_ = std::vector<Frames>(1);
  std::size_t stage_ = 0;
  Eigen::MatrixXd inertia_, rows_, weighted_;
  Eigen::VectorXd drift_, eta_, way_;
};

/// A displacement of a state: g tau(eta), xi + dxi, and back.
void displace(const Geometry& geometry, const MotionState& from, const Eigen::VectorXd& by,
              double factor, MotionState& to);
/// (eta, dxi) from one state to another near it; false where tau has no inverse there.
bool displacement(const Geometry& geometry, const MotionState& from, const MotionState& to,
                  Eigen::VectorXd& by);

}  // namespace hamel
