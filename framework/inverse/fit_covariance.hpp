// Standard deviations and directions that the data do not see, of a fit. Not installed.
#pragma once

#include <Eigen/Core>

#include <hamel/framework/inverse/fit.hpp>

namespace hamel {

/// From derivatives of the residuals over their sigmas, at the numbers x: sigma of each parameter,
/// the covariance, undetermined directions.
void estimate_covariance(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& x, Fit& out);

}  // namespace hamel
