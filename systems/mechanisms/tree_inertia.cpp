// The sums over a placed tree: inertias, twists, momenta, weights.
#include <algorithm>

#include <hamel/systems/mechanisms/tree.hpp>

namespace hamel::mechanisms {

HAMEL_FLATTEN void Tree::turn_inertia() {
  if (turned_) return;
  turned_ = true;
  for (Node& node : nodes_) {
    if (node.rotor || node.link.parent == kGround) continue;
    if (node.turns) {
      const double* turned = placed_.data() + node.element;
      const Vec<12> seen = node.turned_inertia.at(turned[0], turned[1]);
      node.own.first = seen.head<3>();
      node.own.second = seen.tail<9>().reshaped<Eigen::AutoOrder>(3, 3);
    } else if (node.planar) {
      move_in_plane(node.flat, node.inertia, node.own);
    } else {
      node.own = moved(node.place, node.inertia);
    }
  }
}

HAMEL_FLATTEN void Tree::accumulate_inertia() {
  if (carries_) return;
  carries_ = true;
  turn_inertia();
  for (Node& node : nodes_) node.carried = node.own;
  for (size_t j = nodes_.size(); j-- > 0;) {
    const Node& node = nodes_[j];
    if (node.rotor || node.link.parent == kGround) continue;
    Node& parent = at(node.link.parent);
    if (parent.planar) add_in_plane(parent.carried, node.carried);
    else parent.carried += node.carried;
  }
}

// Twist of a root, its velocities xi the whole of it at the position of C, in its own axes.
inline void Tree::move_free(Node& node, const double* xi) {
  const Vec3& c = node.link.on_child.position;
  if (node.planar) {
    in_plane(node.twist) = Vec3(xi[0], xi[1] + c[1] * xi[0], xi[2] - c[0] * xi[0]);
  } else {
    const Vec3 omega(xi[0], xi[1], xi[2]);
    node.twist = stack(omega, Vec3(xi[3], xi[4], xi[5]) + c.cross(omega));
  }
}

HAMEL_FLATTEN void Tree::move(Eigen::Ref<const Eigen::VectorXd> xi) {
  const size_t bytes = moved_.size() * sizeof(double);
  if (moves_ && std::memcmp(moved_.data(), xi.data(), bytes) == 0) return;
  std::memcpy(moved_.data(), xi.data(), bytes);
  moves_ = true;
  for (Node& node : nodes_) {
    const bool is_root = node.link.parent == kGround;
    node.rate = xi[node.dof];
    if (node.free) {
      move_free(node, xi.data() + node.dof);
    } else if (node.planar) {
      Vec3 v = Vec3::Zero();
      if (!is_root) v = in_plane(at(node.link.parent).twist);
      for (int i = 0; i < node.count; ++i) v += xi[node.dof + i] * in_plane(node.columns.col(i));
      in_plane(node.twist) = v;
    } else {
      Twist v = Twist::Zero();
      if (!is_root) v = at(node.link.parent).twist;
      for (int i = 0; i < node.count; ++i) v += xi[node.dof + i] * node.columns.col(i);
      node.twist = v;
    }
  }
}

// A column of I(g), and the row that mirrors it: what a momentum does on the velocities of a link
// and of all that carry it.
inline void Tree::write(const Node* from, int column, const Wrench& momentum, double* out,
                        Eigen::Index stride) const {
  for (;; from = &at(from->link.parent)) {
    double *const down = out + from->dof + column * stride, *const across =
                                                                out + column + from->dof * stride;
    from->each_along(momentum,
                     [&](int i, double effect) { down[i] = across[i * stride] = effect; });
    if (from->link.parent == kGround) return;
  }
}

// The inertia of all that a free root carries, at the position of C.
inline void Tree::write_free(const Node& node, double* out, Eigen::Index stride) {
  const Inertia& all = node.carried;
  const Vec3& c = node.link.on_child.position;
  const Vec3 first = all.first - all.mass * c;
  double* const block = out + node.dof * (stride + 1);
  if (node.planar) {
    Eigen::Map<Mat<3, 3>, 0, Eigen::OuterStride<>> flat(block, Eigen::OuterStride<>(stride));
    const double second =
        all.second(2, 2) - c[0] * (all.first[0] + first[0]) - c[1] * (all.first[1] + first[1]);
    flat << second, -first[1], first[0], -first[1], all.mass, 0, first[0], 0, all.mass;
    return;
  }
  Eigen::Map<Mat<6, 6>, 0, Eigen::OuterStride<>> full(block, Eigen::OuterStride<>(stride));
  full.topLeftCorner<3, 3>() = all.second - parallel_axis(c, all.first + first);
  const Mat<3, 3> across = cross_matrix(first);
  full.topRightCorner<3, 3>() = across;
  full.bottomLeftCorner<3, 3>() = -across;
  full.bottomRightCorner<3, 3>() = all.mass * Mat<3, 3>::Identity();
}

HAMEL_FLATTEN void Tree::inertia(Eigen::Ref<Eigen::MatrixXd> to) const {
  const Eigen::Index stride = to.outerStride();
  double* out = to.data();
  if (!chain_) {
    if (stride == dim_) std::fill_n(out, dim_ * dim_, 0.0);
    else to.setZero();
  }
  for (const Node& node : nodes_) {
    if (node.rotor) {
      out[node.dof * (stride + 1)] = node.moment;
      write(&at(node.link.parent), node.dof, node.spin_here, out, stride);
      continue;
    }
    if (node.free) {
      write_free(node, out, stride);
      continue;
    }
    for (int b = 0; b < node.count; ++b) {
      Wrench momentum = Wrench::Zero();
      if (node.planar)
        in_plane(momentum) = momentum_in_plane(node.carried, in_plane(node.columns.col(b)));
      else momentum = node.carried * node.columns.col(b);
      write(&node, node.dof + b, momentum, out, stride);
    }
  }
}

HAMEL_FLATTEN void Tree::momentum(Eigen::Ref<Eigen::VectorXd> out,
                                  Eigen::Ref<Eigen::VectorXd> inertial_force) {
  for (Node& node : nodes_) {
    if (node.rotor) node.momentum = node.rate * node.spin_here;
    else if (node.planar)
      in_plane(node.momentum) = momentum_in_plane(node.own, in_plane(node.twist));
    else node.momentum = node.own * node.twist;
  }
  for (size_t j = nodes_.size(); j-- > 0;) {
    const Node& node = nodes_[j];
    if (node.link.parent == kGround) {  // its own velocity is left-trivialised
      node.each_along(node.momentum, [&](int i, double effect) {
        out[node.dof + i] = effect;
        inertial_force[node.dof + i] = 0;
      });
      continue;
    }
    Node& parent = at(node.link.parent);
    if (node.rotor) {  // turned by its parent, too; its inertia is the same at all angles
      const double turned = parent.planar ? in_plane(node.spin_here).dot(in_plane(parent.twist))
                                          : node.spin_here.dot(parent.twist);
      out[node.dof] = turned + node.moment * node.rate;
      inertial_force[node.dof] = 0;
    } else if (node.planar) {
      const Vec3 momentum = in_plane(node.momentum), column = in_plane(node.columns.col(0));
      out[node.dof] = column.dot(momentum);
      inertial_force[node.dof] =
          column.dot(ad_transpose_in_plane(in_plane(parent.twist), momentum));
    } else {
      const Wrench force = ad_transpose(parent.twist, node.momentum);
      for (int i = 0; i < node.count; ++i) {
        out[node.dof + i] = node.columns.col(i).dot(node.momentum);
        inertial_force[node.dof + i] = node.columns.col(i).dot(force);
      }
    }
    if (parent.planar) in_plane(parent.momentum) += in_plane(node.momentum);
    else parent.momentum += node.momentum;
  }
}

HAMEL_FLATTEN void Tree::add_weight(const Vec3& gravity, Eigen::Ref<Eigen::VectorXd> out) const {
  const bool sloping = gravity[0] != 0 || gravity[1] != 0;
  for (const Node& node : nodes_) {
    if (node.rotor || (node.planar && !sloping)) continue;
    const Vec3 a = at(node.root).world.rotation.transpose().lazyProduct(gravity);
    const Wrench weight = stack(node.carried.first.cross(a), node.carried.mass * a);
    node.each_along(weight, [&](int i, double effect) { out[node.dof + i] += effect; });
  }
}

}  // namespace hamel::mechanisms
