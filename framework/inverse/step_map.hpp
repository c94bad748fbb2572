// The step of a run as a map from state to state, with inputs: z+ = S(t, z, u, h). Not installed.
//
// The map is the kernel of the run itself, begun anew at each state: whatever has a step has it,
// and a run repeats a chain of such steps to round-off. A state is the numbers (coordinates of g,
// xi). Increments are left-trivialised: (eta, dy), n + m numbers,
//   g (+) eta = g tau(eta),   xi (+) dy = projection onto A(g') xi = b of xi + E dy,
// E an orthonormal basis of ker A at the state itself, the projection orthogonal in the metric I.
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/run/run/plan.hpp>

namespace hamel {

class StepMap {
 public:
  /// plan: of a run with steps of one size, its inputs constant. inputs: those that vary, by index.
  StepMap(RunPlan plan, std::vector<std::size_t> inputs);

  int coordinates() const { return columns_; }
  int velocities() const { return n_; }
  int state_size() const { return columns_ + n_; }
  int increments() const { return n_ + m_; }
  const SystemModel& system() const { return *plan_.system; }
  const Geometry& geometry() const { return *plan_.geometry; }
  /// The start of the run.
  Eigen::VectorXd start() const;

  /// False where the step has no solution.
  bool step(double t, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs, double h,
            Eigen::VectorXd& next);
  /// state (+) increment.
  void retract(double t, const Eigen::VectorXd& state, const Eigen::VectorXd& increment,
               Eigen::VectorXd& out);
  /// The increment from one state to another, to first order in dy; false where there is none.
  bool difference(double t, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                  Eigen::VectorXd& out);
  /// The state with its velocity moved onto the constraints.
  void project(double t, Eigen::VectorXd& state);

 private:
  struct Frame {  // at one state: E, its left inverse (E^T I E)^-1 E^T I, the element
    Eigen::VectorXd state;
    double t = 0;
    Eigen::MatrixXd basis, inverse;
    std::vector<double> element;
  };
  void matrices(double t, const double* element);
  void set(Frame& frame, double t, const Eigen::VectorXd& state);

  RunPlan plan_;
  std::vector<std::size_t> inputs_;
  std::unique_ptr<Kernel> kernel_;
  Snapshot node_;
  int n_, k_, m_, columns_;
  // Work. The frames where retract() and difference() were last.
  Frame base_, target_;
  Eigen::MatrixXd inertia_, rows_, weighted_;
  Eigen::VectorXd drift_, eta_;
  std::vector<double> other_, tau_;
};

}  // namespace hamel
