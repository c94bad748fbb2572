#include <hamel/framework/inverse/fit_covariance.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <Eigen/SVD>

namespace hamel {
namespace {

constexpr double kUndetermined = 1e-7;  // singular values, of the largest

// The largest change of the residuals by a relative change of one number.
double longest_change(const Eigen::VectorXd& lengths, const Eigen::VectorXd& x) {
  double out = 0;
  for (Eigen::Index j = 0; j < x.size(); ++j)
    out = std::max(out, lengths[j] * (x[j] == 0 ? 1 : std::abs(x[j])));
  return out;
}

// A direction that the data do not see, as relative changes of length 1.
void name_direction(const Eigen::VectorXd& direction, const Eigen::VectorXd& x, Fit& out,
                    std::vector<bool>& blind) {
  constexpr double part = 1e-4;  // smaller ones are round-off
  Eigen::VectorXd relative = direction;
  for (Eigen::Index j = 0; j < x.size(); ++j)
    if (x[j] != 0) relative[j] /= std::abs(x[j]);
  Eigen::Index largest = 0;
  relative.cwiseAbs().maxCoeff(&largest);
  relative /= std::copysign(relative.norm(), relative[largest]);
  std::map<std::string, double>& named = out.undetermined.emplace_back();
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    if (std::abs(relative[j]) < part) continue;
    named[out.parameters[static_cast<size_t>(j)].name] = relative[j];
    blind[static_cast<size_t>(j)] = true;
  }
}
}  // namespace

// J = U S V^T D with columns scaled to length 1 by D: covariance D^-1 V S^-2 V^T D^-1 of the
// directions that the data see.
void estimate_covariance(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& x, Fit& out) {
  const Eigen::Index q = x.size();
  Eigen::VectorXd lengths = jacobian.colwise().norm();
  const double longest = lengths.maxCoeff();
  Eigen::MatrixXd scaled = jacobian;
  std::vector<bool> blind(static_cast<size_t>(q), false);
  for (Eigen::Index j = 0; j < q; ++j) {
    // A column that is nothing but the errors of differences stays as it is.
    const double size = x[j] == 0 ? 1 : std::abs(x[j]);
    const bool seen = lengths[j] * size > 1e-9 * std::max(1e-300, longest_change(lengths, x));
    if (!seen || lengths[j] == 0) lengths[j] = longest > 0 ? longest : 1;
    scaled.col(j) /= lengths[j];
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& s = svd.singularValues();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(q, q);
  for (Eigen::Index k = 0; k < q; ++k) {
    const Eigen::VectorXd direction = svd.matrixV().col(k).cwiseQuotient(lengths);
    if (s[k] > kUndetermined * s[0]) {
      inverse += direction * direction.transpose() / (s[k] * s[k]);
      continue;
    }
    name_direction(direction, x, out, blind);
  }
  for (Eigen::Index i = 0; i < q; ++i) {
    const auto row = static_cast<size_t>(i);
    if (!blind[row]) out.parameters[row].sigma = std::sqrt(inverse(i, i));
    for (Eigen::Index j = 0; j < q; ++j)
      if (!blind[row] && !blind[static_cast<size_t>(j)])
        out.covariance(static_cast<int>(i), static_cast<int>(j)) = inverse(i, j);
  }
}

}  // namespace hamel
