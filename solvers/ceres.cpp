#include <hamel/solvers/ceres.hpp>

#include <vector>

#include <ceres/ceres.h>

#include <hamel/framework/loop/scaled_equation.hpp>

namespace hamel {
namespace {

class Cost final : public ceres::CostFunction {
 public:
  Cost(const ScaledEquation& equation, int size) : equation_(equation) {
    set_num_residuals(size);
    mutable_parameter_block_sizes()->push_back(size);
    columns_.resize(static_cast<size_t>(size * size));
  }
  // Ceres takes the Jacobian by rows. Values that are not finite are kept from it: it would log
  // them.
  bool Evaluate(const double* const* parameters, double* f, double** jacobians) const override {
    const size_t n = static_cast<size_t>(num_residuals());
    double* rows = jacobians == nullptr ? nullptr : jacobians[0];
    equation_.evaluate({parameters[0], n}, {f, n},
                       {columns_.data(), rows == nullptr ? 0 : columns_.size()});
    if (rows != nullptr) {
      for (size_t i = 0; i < n; ++i) {
        for (size_t j = 0; j < n; ++j) rows[i * n + j] = columns_[j * n + i];
      }
    }
    return equation_.finite();
  }

 private:
  const ScaledEquation& equation_;
  mutable std::vector<double> columns_;
};

class CeresSolver final : public Solver, ceres::IterationCallback {
 public:
  CeresSolver() {
    options_.linear_solver_type = ceres::DENSE_QR;
    options_.function_tolerance = options_.gradient_tolerance = options_.parameter_tolerance = 0;
    options_.initial_trust_region_radius = options_.max_trust_region_radius = 1e16;
    options_.max_num_iterations = 50;
    options_.num_threads = 1;
    options_.logging_type = ceres::SILENT;
    options_.callbacks.push_back(this);
  }
  SolveReport solve(const Equation& equation, std::span<double> x, double tolerance) override {
    equation_.start(equation, x, tolerance);
    const int n = equation.size();
    if (problem_ == nullptr || static_cast<int>(x_.size()) != n) {
      x_.resize(x.size());
      problem_ = std::make_unique<ceres::Problem>();
      problem_->AddResidualBlock(new Cost(equation_, n), nullptr, x_.data());
    }
    std::copy(x.begin(), x.end(), x_.begin());
    iterations_ = 0;
    value_.resize(x.size());
    equation_.evaluate(x, value_, {});
    if (equation_.finite()) {  // else Ceres would log it
      ceres::Solver::Summary summary;
      ceres::Solve(options_, problem_.get(), &summary);
    }
    const bool ran_out = iterations_ >= options_.max_num_iterations;
    return equation_.finish(x, iterations_, ran_out ? Reason::max_iterations : Reason::stagnated);
  }

 private:
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    iterations_ = summary.iteration;
    return equation_.reached() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

  ScaledEquation equation_;
  ceres::Solver::Options options_;
  std::unique_ptr<ceres::Problem> problem_;
  std::vector<double> x_, value_;
  int iterations_ = 0;
};

}  // namespace

bool Ceres::found() { return true; }
std::shared_ptr<Solver> Ceres::make() { return std::make_shared<CeresSolver>(); }

}  // namespace hamel
