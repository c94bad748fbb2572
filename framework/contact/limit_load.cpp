#include <hamel/framework/contact/limit_load.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace hamel {
namespace {

constexpr double kLastWeight = 1e-14;
constexpr int kSteps = 100;        // of Newton for one m, of which about 5 are taken
constexpr double kNoPart = 1e-9;   // of the largest entry of V: round-off
constexpr double kAtLimit = 1e-9;  // a factor this near to 1 is at it

}  // namespace

LimitLoad::LimitLoad(int rows, int contacts)
    : v_(rows, rows),
      hessian_(rows + 1, rows + 1),
      u_(rows),
      w_(rows),
      x_(rows + 1),
      gradient_(rows + 1),
      step_(rows + 1),
      moved_(rows) {
  parts_.reserve(static_cast<size_t>(contacts));
}

void LimitLoad::begin(int unknowns) {
  parts_.clear();
  rows_ = 0;
  unknowns_ = unknowns;
  factor_ = 0;
}

void LimitLoad::add(int contact, int size) {
  parts_.push_back({contact, rows_, size, true});
  rows_ += size;
}

const LimitLoad::Part* LimitLoad::find(int contact) const {
  for (const Part& part : parts_)
    if (part.contact == contact && part.free) return &part;
  return nullptr;
}

Eigen::Vector2d LimitLoad::of(const Part& part, const Eigen::VectorXd& rows) const {
  Eigen::Vector2d out(0, 0);
  out.head(part.size) = rows.segment(part.first, part.size);
  return out;
}

// Columns of V of size 1; contacts whose rows of them are round-off are held by none.
void LimitLoad::scale_columns() {
  for (int j = 0; j < unknowns_; ++j) {
    const double most = v_.col(j).head(rows_).cwiseAbs().maxCoeff();
    if (most > 0) v_.col(j).head(rows_) /= most;
  }
  for (Part& part : parts_)
    part.free = v_.block(part.first, 0, part.size, unknowns_).cwiseAbs().maxCoeff() > kNoPart;
}

double LimitLoad::room(const Part& part) const {
  const double rho = x_[unknowns_], size = of(part, w_).norm();
  return (rho - size) * (rho + size);
}

// Of -log s, s = rho^2 - |w|^2, w = u + V c: ds = (-2 w^T V, 2 rho), d2s = (-2 V^T V, 2).
void LimitLoad::add_barrier(const Part& part) {
  const double rho = x_[unknowns_], s = room(part);
  const auto v = v_.block(part.first, 0, part.size, unknowns_);
  const auto w = w_.segment(part.first, part.size);
  auto change = moved_.head(unknowns_);
  for (int j = 0; j < unknowns_; ++j) change[j] = v.col(j).dot(w);
  gradient_.head(unknowns_) += 2 / s * change;
  gradient_[unknowns_] -= 2 * rho / s;
  for (int i = 0; i < unknowns_; ++i) {
    for (int j = 0; j <= i; ++j)
      hessian_(i, j) += 4 * change[i] * change[j] / (s * s) + 2 / s * v.col(i).dot(v.col(j));
    hessian_(unknowns_, i) -= 4 * rho * change[i] / (s * s);
  }
  hessian_(unknowns_, unknowns_) += 4 * rho * rho / (s * s) - 2 / s;
}

// A step of Newton; the decrement before it.
double LimitLoad::centre() {
  const int n = unknowns_ + 1;
  auto h = hessian_.topLeftCorner(n, n);
  auto d = step_.head(n);
  h.setZero();
  gradient_.head(n).setZero();
  gradient_[unknowns_] = 1 / m_;
  for (const Part& part : parts_)
    if (part.free) add_barrier(part);
  d = gradient_.head(n);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factors(h);
  factors.solveInPlace(d);
  const double decrement = std::sqrt(std::max(0.0, d.dot(gradient_.head(n))));
  double length = decrement > 0.25 ? 1 / (1 + decrement) : 1;
  const int inside = 60;
  for (int k = 0; k < inside; ++k, length /= 2) {  // round-off alone can leave the domain
    x_.head(n) -= length * d;
    w_.head(rows_) = u_.head(rows_);
    w_.head(rows_).noalias() += v_.topLeftCorner(rows_, unknowns_).lazyProduct(x_.head(unknowns_));
    const bool stays = x_[unknowns_] > 0 && std::ranges::all_of(parts_, [this](const Part& part) {
                         return !part.free || room(part) > 0;
                       });
    if (stays) break;
    x_.head(n) += length * d;
  }
  return decrement;
}

void LimitLoad::solve() {
  scale_columns();
  double most = 0;
  for (const Part& part : parts_)
    if (part.free) most = std::max(most, of(part, u_).norm());
  factor_ = part_ = 0;
  if (!(most > 0)) return;
  u_.head(rows_) /= most;
  x_.head(unknowns_).setZero();
  x_[unknowns_] = 2;
  w_.head(rows_) = u_.head(rows_);
  for (m_ = 1; m_ > 0.99 * kLastWeight; m_ /= 10)
    for (int k = 0; k < kSteps && centre() > 0.1; ++k) {
    }
  u_.head(rows_) *= most;
  w_.head(rows_) *= most;
  factor_ = most * x_[unknowns_];
  step_back();
}

// The least part of the way to c by which all hold.
void LimitLoad::step_back() {
  part_ = 1;
  if (!(factor_ < 1 - kAtLimit)) return;
  part_ = 0;
  for (const Part& part : parts_) {
    if (!part.free) continue;
    // |a + p (b - a)| = 1 where it enters the circle, which has b inside.
    const Eigen::Vector2d a = of(part, u_), b = of(part, w_), d = b - a;
    const double over = a.squaredNorm() - 1;
    if (!(over > 0)) continue;
    const double along = -a.dot(d),
                 root = std::sqrt(std::max(0.0, along * along - d.squaredNorm() * over));
    part_ = std::max(part_, over / (along + root));
  }
}

bool LimitLoad::yields(int contact) const {
  const Part* const part = find(contact);
  if (part == nullptr || factor_ < 1 - kAtLimit) return false;
  const double rho = x_[unknowns_], size = of(*part, w_).norm() * rho / factor_;
  const double left = rho - size, multiplier = 2 * rho * m_ / (left * (rho + size));
  return multiplier > left;
}

Eigen::Vector2d LimitLoad::reaction(int contact) const {
  const Part* const part = find(contact);
  if (part == nullptr) return {0, 0};
  const Eigen::Vector2d a = of(*part, u_), b = of(*part, w_);
  return a + part_ * (b - a);
}

}  // namespace hamel
