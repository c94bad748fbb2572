#include <hamel/systems/mechanisms/starts/mobility.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/systems/mechanisms/starts/poses.hpp>

namespace hamel::mechanisms {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kNoMotion = 1e-9;  // beside numbers of size 1

bool moves_by_itself(const Prescribed& p) {
  return p.held < 0 && (p.driven || p.time_dependent || p.rate(0) != 0);
}

// A basis of the velocities that contacts, loops and joints that are held allow, in units of the
// energy that each velocity has alone.
MatrixXd free_velocities(const Multibody& system, const std::vector<double>& g, bool sticking) {
  MatrixXd inertia(system.dim(), system.dim());
  system.inertia(g.data(), inertia);
  MatrixXd a = RowValues(system, g).a;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const RowInfo& row = system.row_info()[static_cast<size_t>(i)];
    if (row.slips && (!sticking || row.holonomic)) a.row(i).setZero();
  }
  const std::vector<Prescribed>& prescribed = system.all_rows().prescribed;
  const Eigen::Index others = a.rows() - static_cast<Eigen::Index>(prescribed.size());
  for (size_t i = 0; i < prescribed.size(); ++i)
    if (moves_by_itself(prescribed[i])) a.row(others + static_cast<Eigen::Index>(i)).setZero();
  a = (a * velocity_units(inertia).asDiagonal()).eval();
  const double most = a.rows() == 0 ? 0 : a.rowwise().norm().maxCoeff();
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const double size = a.row(i).norm();  // in the plane a height is round-off alone
    a.row(i) *= size > kNoMotion * most ? 1 / size : 0;
  }
  MatrixXd out =
      a.rows() == 0 ? MatrixXd::Identity(a.cols(), a.cols()) : dense::kernel(a, kNoMotion);
  return out.isZero(0) ? MatrixXd(a.cols(), 0) : dense::qr(out).q.leftCols(out.cols()).eval();
}

bool any_of(const MatrixXd& free, const std::vector<int>& velocities) {
  return free.cols() > 0 && free(velocities, Eigen::all).norm() > kNoMotion;
}

}  // namespace

int vehicle_root(const Tree& tree) {
  for (int link = 0; link < tree.links(); ++link)
    if (tree.parent(link) == kGround && tree.joint(link).turns_and_slides()) return link;
  return -1;
}

bool moves_at_this_pose_alone(const Multibody& system, const std::vector<double>& g) {
  const Tree& tree = system.tree(g.data());
  const int root = vehicle_root(tree);
  if (root < 0 || system.all_rows().ground.moves()) return false;
  std::vector<int> own(static_cast<size_t>(tree.count(root)));
  std::iota(own.begin(), own.end(), tree.first(root));
  const std::vector<std::vector<double>> poses = poses_on_rows(system, g);
  const auto moves = [&](const std::vector<double>& pose) {
    return any_of(free_velocities(system, pose, false), own);
  };
  return poses.size() > 1 && moves(g) && std::none_of(poses.begin() + 1, poses.end(), moves);
}

Mobility mobility_at(const Multibody& system, const std::vector<double>& g, bool sticking) {
  Mobility out;
  out.any = system.all_rows().ground.moves() || free_velocities(system, g, sticking).cols() > 0;
  const Tree& tree = system.tree(g.data());
  const int root = vehicle_root(tree);
  if (root < 0 || system.all_rows().ground.moves()) return out;
  std::vector<int> own(static_cast<size_t>(tree.count(root))), turning = tree.joint(root).turning();
  std::iota(own.begin(), own.end(), tree.first(root));
  for (int& velocity : turning) velocity += tree.first(root);
  out.root = out.turns = false;
  for (const std::vector<double>& pose : poses_on_rows(system, g)) {
    const MatrixXd free = free_velocities(system, pose, sticking);
    out.root = out.root || any_of(free, own);
    out.turns = out.turns || any_of(free, turning);
  }
  return out;
}

std::vector<size_t> wheels_that_cannot_roll(const Multibody& system) {
  const Tree& tree = system.tree(system.drawn().data());
  const std::vector<Contact>& contacts = system.all_rows().contacts;
  std::vector<size_t> out;
  for (size_t i = 0; i < contacts.size(); ++i) {
    const std::vector<Vec3> axes = contacts[i].model->axes();
    if (contacts[i].model->radius() == 0 || axes.empty()) continue;
    bool turns = false;
    for (int link = contacts[i].link; link != kGround && !turns; link = tree.parent(link)) {
      const Joint& joint = tree.joint(link);
      if (joint.dim() == 1) turns = std::abs(upper(tree.axis(link)).dot(axes.front())) > kNoMotion;
      else turns = joint.turning().size() > 1;
    }
    if (!turns) out.push_back(i);
  }
  return out;
}

}  // namespace hamel::mechanisms
