// Residuals of a fit and their Jacobian at numbers to be fitted. Not installed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/inverse/fit.hpp>
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

  /// q(z(t)) - datum in units of the data; false where a motion fails or cannot be.
  bool residuals(const Eigen::VectorXd& x, Eigen::VectorXd& out);
  /// Both; for the covariance with all digits.
  bool jacobian(const Eigen::VectorXd& x, TangentMotion::Carries digits, Eigen::VectorXd& residuals,
                Eigen::MatrixXd& out);
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
  template <class Row>
  bool follow(const Eigen::VectorXd& x, TangentMotion::Carries carries, const Row& row);

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
