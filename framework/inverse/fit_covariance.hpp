// Standard deviations and directions that the data do not see, of a fit. Not installed.
#pragma once

#include <Eigen/Core>

#include <hamel/framework/inverse/fit.hpp>
#include <hamel/framework/inverse/fit_descent.hpp>

namespace hamel {

/// Does a Jacobian of ten digits see all numbers with digits to spare?
bool sees_clearly(const FitLinear& at, const Eigen::VectorXd& x);

/// From residuals over their sigmas and equations of nodes, by the numbers x and the nodes: sigma
/// of each parameter, the covariance, undetermined directions.
void estimate_covariance(const FitLinear& at, const Eigen::VectorXd& x, Fit& out);

}  // namespace hamel
