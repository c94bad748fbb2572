// The sums over a placed tree: inertias, twists, momenta, weights.
#include <algorithm>

#include <hamel/systems/mechanisms/tree.hpp>

namespace hamel::mechanisms {

HAMEL_FLATTEN void Tree::accumulate_inertia() {
  if (carries_) return;
  carries_ = true;
  for (Node& node : nodes_) {
    if (node.rotor) continue;
    if (node.link.parent != kGround) {
      if (node.planar) move_in_plane(node.flat, node.inertia, node.own);
      else node.own = moved(node.place, node.inertia);
    }
    node.carried = node.own;
  }
  for (size_t j = nodes_.size(); j-- > 0;) {
    const Node& node = nodes_[j];
    if (node.rotor || node.link.parent == kGround) continue;
    Node& parent = at(node.link.parent);
    if (parent.planar) add_in_plane(parent.carried, node.carried);
    else parent.carried += node.carried;
  }
}

HAMEL_FLATTEN void Tree::move(Eigen::Ref<const Eigen::VectorXd> xi) {
  for (Node& node : nodes_) {
    const bool is_root = node.link.parent == kGround;
    node.rate = xi[node.dof];
    if (node.planar) {
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

// A column of I(g), and the row that mirrors it: what a momentum does on the first `count`
// velocities of a link and on those of all that carry it.
void Tree::write(const Node* from, int count, int column, const Wrench& momentum, double* out,
                 Eigen::Index stride) const {
  for (;;) {
    for (int i = 0; i < count; ++i) {
      const int row = from->dof + i;
      out[row + column * stride] = out[column + row * stride] = from->along(i, momentum);
    }
    if (from->link.parent == kGround) return;
    from = &at(from->link.parent);
    count = from->count;
  }
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
      const Node& parent = at(node.link.parent);
      write(&parent, parent.count, node.dof, node.spin_here, out, stride);
      continue;
    }
    for (int b = 0; b < node.count; ++b) {
      Wrench momentum = Wrench::Zero();
      if (node.planar)
        in_plane(momentum) = momentum_in_plane(node.carried, in_plane(node.columns.col(b)));
      else momentum = node.carried * node.columns.col(b);
      write(&node, b + 1, node.dof + b, momentum, out, stride);
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
      for (int i = 0; i < node.count; ++i) {
        out[node.dof + i] = node.along(i, node.momentum);
        inertial_force[node.dof + i] = 0;
      }
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
    for (int i = 0; i < node.count; ++i) out[node.dof + i] += node.along(i, weight);
  }
}

}  // namespace hamel::mechanisms
