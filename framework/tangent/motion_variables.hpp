// Numbers that a motion depends on, by name: parameters ("mass", "inertia2"), constant inputs, and
// "start." with a coordinate or a component of the velocity. Not installed.
//
// start.omega is the velocity with this component: of all xi with A xi = b and the given components
// that which is nearest to the usual start's in the metric I.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/run/simulation.hpp>

namespace hamel {

struct MotionVariable {
  enum class Kind { parameter, input, coordinate, velocity, direction };
  Kind kind = Kind::parameter;
  std::string name, field, unit;
  std::size_t index = 0;  // the entry of a parameter, the column of g, of xi, of the directions
  double value = 0;       // as the simulation has it
  Range range = {};
  bool of_system() const { return kind == Kind::parameter || kind == Kind::input; }
};

class MotionVariables {
 public:
  /// what: begins a message, "sensitivities". ConfigError names the nearest.
  MotionVariables(const std::string& what, const Simulation& simulation,
                  const std::vector<std::string>& names);

  const std::vector<MotionVariable>& all() const { return all_; }
  std::size_t size() const { return all_.size(); }
  Eigen::VectorXd values() const;
  /// The displacement (eta; dxi) of a factor of one; empty for other variables.
  Eigen::VectorXd direction(const MotionVariable& one) const {
    if (one.kind != MotionVariable::Kind::direction) return {};
    return directions_.col(static_cast<Eigen::Index>(one.index));
  }
  /// Parameters and inputs of a motion that begins at another time and state, and factors of
  /// displacements (eta; dxi) of this state, which are 0.
  MotionVariables from(double t, const Start& start, const Eigen::MatrixXd& directions) const;
  /// With these parameters and inputs; the start is not touched.
  Simulation with(const Eigen::VectorXd& values) const;
  /// The admissible start of a run of with(values). ConfigError where the rows leave no choice.
  Start start_of(Run& run, const Eigen::VectorXd& values) const;

 private:
  Simulation simulation_;
  std::vector<MotionVariable> all_;
  std::map<std::string, std::vector<double>> entries_;  // of the parameters
  bool moves_start_ = false;
  Eigen::MatrixXd directions_;
};

}  // namespace hamel
