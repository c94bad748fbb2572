// Residuals of a fit and their Jacobian at numbers to be fitted. Not installed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/inverse/fit.hpp>
#include <hamel/framework/inverse/fit_descent.hpp>
#include <hamel/framework/tangent/observed.hpp>
#include <hamel/framework/tangent/tangent_motion.hpp>

namespace hamel {

/// Number that is fitted: its variable, of one recording or (-1) of all.
struct FitUnknown {
  std::string name;
  std::size_t variable = 0;
  int recording = -1;
  double guess = 0, low = 0, high = 0;
};

/// Where a segment of a recording begins, and what its start is moved along: (eta; dxi) that keep
/// the constraints, a column for each.
struct FitNode {
  double time = 0;
  Start start;
  Eigen::MatrixXd directions;
};
/// Numbers, and the nodes of each recording behind its start: multiple shooting.
struct FitPoint {
  Eigen::VectorXd x;
  std::vector<std::vector<FitNode>> nodes;
  Eigen::Index size() const {
    Eigen::Index out = x.size();
    for (const auto& of_one : nodes)
      for (const FitNode& node : of_one) out += node.directions.cols();
    return out;
  }
};

class FitProblem {
 public:
  /// ConfigError with all mistakes.
  FitProblem(const Simulation& simulation, const FitRequest& request);

  const std::vector<FitUnknown>& unknowns() const { return unknowns_; }
  const MotionVariables& variables() const { return *variables_; }
  const Simulation& simulation() const { return simulation_; }
  /// Names of the data's columns, and the column of each residual.
  const std::vector<std::string>& columns() const { return columns_; }
  const std::vector<std::size_t>& column_of() const { return column_of_; }
  Eigen::Index data() const { return static_cast<Eigen::Index>(column_of_.size()); }
  const std::vector<std::string>& left_out() const { return left_out_; }

  /// r = q(z(t)) - datum in units of the data, c: from the end of a segment to the next node, as
  /// (eta, dy); false where a motion fails or cannot be.
  bool residuals(const FitPoint& at, Eigen::VectorXd& r, Eigen::VectorXd& c);
  /// Both, and their derivatives by the numbers and the nodes; for the covariance with all digits.
  bool jacobian(const FitPoint& at, TangentMotion::Carries digits, FitLinear& out);
  /// Nodes moved by the tail of an increment, behind the numbers; false where there are none such.
  bool move_nodes(const FitPoint& from, const Eigen::VectorXd& increment, FitPoint& to);
  /// Nodes where the tangent has grown, or of so many segments; their states from the data nearby.
  /// By column: sigmas, and the size of its data.
  void choose_nodes(const std::vector<double>& sigma, const std::vector<double>& scales,
                    std::optional<int> segments, FitPoint& out);
  /// Why the last motion failed.
  const std::string& failure() const { return failure_; }
  long runs() const { return runs_; }

  std::vector<Table> tables(const Eigen::VectorXd& residuals,
                            const std::vector<double>& sigma) const;
  Eigen::VectorXd values_of(const Eigen::VectorXd& x, int recording) const;

 private:
  struct Series {
    const Recording* recording;
    ObservedQuantities observed;
    std::vector<std::size_t> columns;  // of recording, those observed
    std::vector<std::size_t> names;    // of them, in columns_
  };
  std::string resolve_column(Series& series, std::size_t c);
  void resolve_columns(std::vector<std::string>& mistakes);
  void check_times(std::vector<std::string>& mistakes) const;
  void make_unknowns(std::vector<std::string>& mistakes);
  std::unique_ptr<TangentMotion> motion_of(const FitPoint& at, std::size_t r, std::size_t segment,
                                           TangentMotion::Carries carries) const;
  template <class Row, class Joint>
  bool follow(const FitPoint& at, TangentMotion::Carries carries, const Row& row,
              const Joint& joint);
  template <class Row, class Joint>
  bool follow_recording(const FitPoint& at, std::size_t r, TangentMotion::Carries carries,
                        const Row& row, const Joint& joint);
  class NodeChoice;
  std::vector<Eigen::Index> columns_of(const FitPoint& at, std::size_t r,
                                       std::size_t segment) const;

  Simulation simulation_;
  const FitRequest& request_;
  std::shared_ptr<const SystemModel> system_;
  std::unique_ptr<MotionVariables> variables_;
  std::vector<FitUnknown> unknowns_;
  std::vector<Series> series_;
  std::vector<std::string> columns_, left_out_;
  std::vector<std::size_t> column_of_;
  std::string failure_;
  long runs_ = 0;
};

}  // namespace hamel
