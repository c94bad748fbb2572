#include <hamel/framework/stages/interior_rows.hpp>

#include <algorithm>
#include <cmath>

namespace hamel {
namespace {

constexpr double kBoundary = 0.995, kMultiplierRange = 1e10;

}  // namespace

void InteriorRows::resize(int rows) {
  for (Eigen::VectorXd* x : {&s, &y, &ds, &dy, &weight_, &pull_}) x->setZero(rows);
}

void InteriorRows::start(const Eigen::VectorXd& c, double least, double mu) {
  s = c.cwiseMax(least);
  y = mu * s.cwiseInverse();
}

void InteriorRows::condense(const Eigen::VectorXd& c, const Eigen::MatrixXd& J, double mu,
                            double softness, Eigen::MatrixXd& H, Eigen::VectorXd& g) {
  if (s.size() == 0) return;
  const Eigen::Index n = J.cols();
  weight_ = (s.array() / y.array() + softness).inverse();
  pull_ = y.array() + weight_.array() * (mu / y.array() - c.array() - softness * y.array());
  weighted_ = weight_.asDiagonal() * J;
  H.topLeftCorner(n, n).noalias() += J.transpose() * weighted_;
  g.head(n).noalias() -= J.transpose() * pull_;
}

void InteriorRows::step(const Eigen::VectorXd& c, const Eigen::MatrixXd& J,
                        const Eigen::VectorXd& dx, double mu, double softness) {
  if (s.size() == 0) return;
  pull_.noalias() = J * dx;
  weight_ = (s.array() / y.array() + softness).inverse();
  dy = weight_.array() * (mu / y.array() - c.array() - softness * y.array() - pull_.array());
  ds = (mu - s.array() * (y.array() + dy.array())) / y.array();
}

double InteriorRows::longest(const Eigen::VectorXd& x, const Eigen::VectorXd& dx) {
  double out = 1;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (dx[i] < 0) out = std::min(out, -kBoundary * x[i] / dx[i]);
  return out;
}

// y stays within a range of mu/s, (16) of Waechter and Biegler: a condition for convergence.
void InteriorRows::move(double primal, double dual, double mu) {
  s += primal * ds;
  y += dual * dy;
  y = y.array().max(mu / (kMultiplierRange * s.array())).min(kMultiplierRange * mu / s.array());
}

double InteriorRows::complement(double mu) const {
  double out = 0;
  for (Eigen::Index i = 0; i < s.size(); ++i) out = std::max(out, std::abs(s[i] * y[i] - mu));
  return out;
}

}  // namespace hamel
