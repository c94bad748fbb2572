#include <hamel/framework/inverse/fit_covariance.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace hamel {
namespace {

constexpr double kUndetermined = 1e-7;  // singular values, of the largest
constexpr double kClear = 1e-4;         // so that errors of 1e-10 leave six digits
constexpr double kUnseen = 1e-9;        // changes of the residuals, of the longest

// A direction that the data do not see, as relative changes of length 1.
void name_direction(const Eigen::VectorXd& direction, const Eigen::VectorXd& x,
                    const Eigen::VectorXd& sizes, Fit& out, std::vector<bool>& blind) {
  constexpr double part = 1e-4;  // smaller ones are round-off
  Eigen::VectorXd relative = direction;
  for (Eigen::Index j = 0; j < x.size(); ++j) relative[j] /= x[j] != 0 ? std::abs(x[j]) : sizes[j];
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

// Columns of J, which scale them; that of a number that is nothing but the errors of differences
// stays as it is. False where there is one, as seen with `unseen`.
bool find_lengths(const FitLinear& at, const Eigen::VectorXd& x, double unseen,
                  Eigen::VectorXd& lengths) {
  lengths = scales_of_columns(at);
  const Eigen::Index q = x.size();
  const Eigen::VectorXd changes =
      at.J.leftCols(q).colwise().norm().transpose().cwiseProduct(at.sizes.head(q));
  const double longest = lengths.cwiseProduct(at.sizes).maxCoeff(),
               of_numbers = std::max(1e-300, changes.maxCoeff());
  bool all = true;
  for (Eigen::Index j = 0; j < q; ++j) {
    const bool seen = changes[j] > unseen * of_numbers;
    lengths[j] = (seen ? changes[j] : longest) / at.sizes[j];
    all = all && seen;
  }
  return all;
}

}  // namespace

bool sees_clearly(const FitLinear& at, const Eigen::VectorXd& x) {
  Eigen::VectorXd lengths;
  if (!find_lengths(at, x, kClear, lengths)) return false;
  const Eigen::VectorXd s = FitStep(at, lengths).singular();
  return s.size() > 0 && s[s.size() - 1] > kClear * s[0];
}

// Over increments with C x = 0: J Z = U S V^T with columns scaled by D: covariance W S^-2 W^T, W =
// D^-1 Z V, of the directions that the data see; rows of the numbers. Without equations Z = 1.
void estimate_covariance(const FitLinear& at, const Eigen::VectorXd& x, Fit& out) {
  const Eigen::Index q = x.size();
  std::vector<bool> blind(static_cast<size_t>(q), false);
  Eigen::VectorXd lengths;
  find_lengths(at, x, kUnseen, lengths);
  const FitStep step(at, lengths);
  const Eigen::VectorXd& s = step.singular();
  const Eigen::MatrixXd directions = step.directions();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(q, q);
  for (Eigen::Index k = 0; k < directions.cols(); ++k) {
    const Eigen::VectorXd direction = directions.col(k).head(q);
    if (s[k] > kUndetermined * s[0]) {
      inverse += direction * direction.transpose() / (s[k] * s[k]);
      continue;
    }
    // Of length 1 as it is scaled: no change of the numbers, but of what a node is projected from.
    if (direction.cwiseProduct(lengths.head(q)).norm() > 1e-6)
      name_direction(direction, x, at.sizes, out, blind);
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
