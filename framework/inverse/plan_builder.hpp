// The request of a plan, checked and made a problem over stages. Not installed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <hamel/framework/inverse/motion_plan.hpp>
#include <hamel/framework/inverse/plan_stages.hpp>
#include <hamel/framework/stages/scaled_stages.hpp>

namespace hamel {

class Registry;

class PlanBuilder {
 public:
  PlanBuilder(const Registry& registry, const PlanRequest& request);

  /// Throws ConfigError with all mistakes.
  std::unique_ptr<PlanStages> stages();
  /// The start to the goal along the group, moved by a seeded smooth perturbation; or the states of
  /// the inputs of a file.
  struct Guess {
    StagePoint point;
    StageScales scales;
  };
  Guess guess(PlanStages& stages, unsigned seed) const;
  /// Names of the numbers of a state: columns of the element, components of xi.
  const std::vector<std::string>& quantities() const { return quantities_; }
  /// The run that the plan is for: scheme, step.
  const Config& config() const { return config_; }

 private:
  void complete_config();
  RunPlan plan();
  void check_plan(const RunPlan& plan);
  std::vector<std::size_t> find_inputs(const SystemModel& system);
  void check_rates(const RunPlan& plan, const std::vector<std::size_t>& inputs);
  void set_costs(PlanStages& stages);
  void set_bounds(PlanStages& stages);
  void set_goals(PlanStages& stages);
  void add_goals(PlanStages& stages, const std::vector<std::optional<double>>& given,
                 const std::string& key, std::size_t first, std::size_t count);
  StateFormula formula(const SystemModel& system, const std::string& key, const std::string& text);
  void add_constraint(PlanStages& stages, const std::string& text);
  void mistake(const std::string& key, const std::string& what);
  std::string placed(const std::string& mistake) const;
  StagePoint rolled_out(PlanStages& stages) const;
  std::vector<MotionState> carried(const PlanStages& stages) const;
  MotionState goal_state(PlanStages& stages, const MotionState& carried,
                         Eigen::VectorXd& way) const;
  Eigen::VectorXd sizes_aside(const PlanStages& stages, const Eigen::VectorXd& way) const;

  const Registry& registry_;
  const PlanRequest& request_;
  Config config_;
  Mistakes mistakes_;
  std::vector<std::string> quantities_;
};

}  // namespace hamel
