#include <hamel/systems/mechanisms/starts/start_velocity.hpp>

#include <algorithm>
#include <cmath>

#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/systems/mechanisms/starts/poses.hpp>

namespace hamel::mechanisms {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kNoRate = 1e-9;  // beside numbers of size 1

void mark_with_carriers(const Tree& tree, int link, std::vector<char>& marked) {
  for (; link != kGround; link = tree.parent(link)) marked[static_cast<size_t>(link)] = 1;
}

// Does a joint with this axis, as drawn, turn a wheel about its axle, or a ball about its centre?
bool is_axle(const Contact& contact, const Twist& axis) {
  if (contact.model->radius() == 0) return false;
  const double near = 1e-6 * contact.model->radius();
  return velocity_at(axis, contact.at).norm() <= near &&
         std::ranges::all_of(contact.model->axes(),
                             [&](const Vec3& e) { return upper(axis).cross(e).norm() <= 1e-6; });
}

// y + free z -> those of least square sum of the entries `which`.
void keep_least(const std::vector<int>& which, VectorXd& y, MatrixXd& free) {
  if (which.empty() || free.cols() == 0) return;
  const MatrixXd rows = free(which, Eigen::all);
  if (rows.norm() <= kNoRate * free.norm()) return;
  y += free * least(rows, VectorXd(-y(which)));
  free = (free * dense::kernel(rows, kNoRate)).eval();
}

}  // namespace

StartVelocity::StartVelocity(const Multibody& system, const std::vector<double>& g)
    : inertia_(system.dim(), system.dim()) {
  system.inertia(g.data(), inertia_);
  units_ = velocity_units(inertia_);

  const Tree& tree = system.tree(g.data());
  const auto links = static_cast<size_t>(tree.links());
  std::vector<char> carries(links, 0), axle(links, 0);
  for (const Contact& contact : system.all_rows().contacts) {
    mark_with_carriers(tree, contact.link, carries);
    for (int link = 0; link < tree.links(); ++link) {  // of the wheel, or of what hangs on its axle
      if (link != contact.link && tree.parent(link) != contact.link) continue;
      if (tree.joint(link).only_turns() && is_axle(contact, tree.axis(link)))
        axle[static_cast<size_t>(link)] = 1;
    }
  }
  for (const Loop& loop : system.all_rows().loops) {
    mark_with_carriers(tree, loop.a, carries);
    mark_with_carriers(tree, loop.b, carries);
  }
  for (int link = 0; link < tree.links(); ++link) {
    const Joint& joint = tree.joint(link);
    const auto at = static_cast<size_t>(link);
    if (tree.link(link).is_state) continue;
    if (tree.parent(link) == kGround && joint.turns_and_slides()) {
      for (const int i : joint.turning()) turning_.push_back(tree.first(link) + i);
      continue;
    }
    for (int i = tree.first(link); i < tree.first(link) + tree.count(link); ++i) {
      if (axle[at]) continue;
      if (!carries[at]) limbs_.push_back(i);
      joints_.push_back(i);
    }
  }
}

VectorXd StartVelocity::operator()(const MatrixXd& a, const VectorXd& some) const {
  VectorXd y = some.cwiseQuotient(units_);
  MatrixXd free = MatrixXd::Identity(y.size(), y.size());
  if (a.rows() > 0) {
    MatrixXd rows = a * units_.asDiagonal();
    rows.rowwise().normalize();
    free = dense::kernel(rows);
    if (free.isZero(0)) return some;
  }
  for (const std::vector<int>* which : {&limbs_, &joints_, &turning_}) keep_least(*which, y, free);
  const MatrixXd energy = units_.asDiagonal() * inertia_ * units_.asDiagonal();
  const MatrixXd reduced = free.transpose() * energy * free;
  y += free * least(reduced, VectorXd(-(free.transpose() * (energy * y))));
  return y.cwiseProduct(units_);
}

}  // namespace hamel::mechanisms
