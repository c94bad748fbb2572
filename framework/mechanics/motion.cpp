#include <hamel/framework/mechanics/motion.hpp>

#include <limits>
#include <utility>

#include <Eigen/LU>

#include <hamel/framework/lie/differences.hpp>

namespace hamel {

Motion::Motion(std::shared_ptr<const Geometry> geometry, std::shared_ptr<const Mechanics> mechanics)
    : geometry_(std::move(geometry)), system_(std::move(mechanics)), place_(*system_) {
  const int n = system_->dim(), k = system_->rows();
  for (auto* v : {&acceleration_, &momentum_, &change_, &step_}) v->resize(n);
  for (auto* v : {&reaction_, &b_, &b_rate_}) v->resize(k);
  for (auto* m : {&a_, &a_rate_}) m->resize(k, n);
  for (auto* m : {&inertia_, &inertia_rate_}) m->resize(n, n);
  moved_.resize(geometry_->size());
}

void Motion::operator()(double t, const double* g, const Eigen::VectorXd& xi) {
  place_.set(*system_, t, g);
  a_rate_.setZero();
  b_rate_.setZero();
  inertia_rate_.setZero();
  const bool moves = !system_->constant_constraints(), varies = !system_->constant_inertia();
  if (moves || varies) {
    differentiate_along(*geometry_, g, xi, step_, moved_, [&](double shift, double weight) {
      if (moves) {
        system_->constraints(t + shift, moved_.data(), a_, b_);
        a_rate_ += weight * a_;
        b_rate_ += weight * b_;
      }
      if (varies) {
        system_->inertia(moved_.data(), inertia_);
        inertia_rate_ += weight * inertia_;
      }
    });
  }
  momentum_.noalias() = place_.inertia * xi;
  system_->force(t, g, xi, change_);
  change_.noalias() -= inertia_rate_ * xi;
  geometry_->ad_transpose(xi.data(), momentum_.data(), step_.data());
  change_ += step_;
  // I xi' = change + A^T lambda, A xi' = db/dt - dA/dt xi.
  b_rate_.noalias() -= a_rate_ * xi;
  place_.velocity(change_, b_rate_, acceleration_);
  momentum_.noalias() = place_.inertia * acceleration_;
  momentum_ -= change_;
  place_.multipliers(momentum_, reaction_);
}

bool recover_step(const Geometry& geometry, const double* delta, double s, Eigen::VectorXd& xi) {
  const int n = geometry.dim(), size = geometry.size();
  xi.resize(n);
  if (!geometry.tau_inverse(delta, xi.data())) return false;
  if (s == 0 || geometry.one_parameter()) return true;
  Eigen::VectorXd f0(size), f1(size), z(n), rest(n);
  Eigen::MatrixXd right(n, n), c(n, n);
  double last = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 20; ++k) {
    z = -s * xi;
    geometry.tau(z.data(), f0.data());
    geometry.dtau_right(z.data(), right.data());
    c = s * right;
    z = (1 - s) * xi;
    geometry.tau(z.data(), f1.data());
    geometry.dtau_right(z.data(), right.data());
    c += (1 - s) * right;
    // rest = tau^-1((f0^-1 f1)^-1 delta) = tau^-1(f1^-1 f0 delta), carried to the base point.
    geometry.compose(f0.data(), delta, f0.data());
    Eigen::VectorXd f1_inverse(size);
    geometry.inverse(f1.data(), f1_inverse.data());
    geometry.compose(f1_inverse.data(), f0.data(), f0.data());
    if (!geometry.tau_inverse(f0.data(), rest.data())) return false;
    const double norm = rest.norm();
    if (!(norm < last)) break;
    last = norm;
    geometry.Ad(f1.data(), rest.data(), z.data());
    xi += c.partialPivLu().solve(z);
  }
  return true;
}

}  // namespace hamel
