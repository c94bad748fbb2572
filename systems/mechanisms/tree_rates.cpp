// Rates along the motion with xi held: twists, and the momentum I(g) xi.
#include <hamel/systems/mechanisms/tree.hpp>

namespace hamel::mechanisms {

HAMEL_FLATTEN void Tree::accelerate() {
  for (Node& node : nodes_) {
    if (node.link.parent == kGround) continue;  // U = D = 0
    const Node& parent = at(node.link.parent);
    const Node& root = at(node.root);
    if (node.planar) {
      in_plane(node.against) = in_plane(node.twist) - in_plane(root.twist);
      if (node.on_root) continue;
      in_plane(node.acceleration) =
          in_plane(parent.acceleration) +
          ad_in_plane(in_plane(parent.against), in_plane(node.twist) - in_plane(parent.twist));
    } else {
      node.against = node.twist - root.twist;
      if (node.on_root) continue;  // U_parent = 0
      node.acceleration = parent.acceleration + ad(parent.against, node.twist - parent.twist);
    }
  }
}

HAMEL_FLATTEN void Tree::add_inertia_rate(Eigen::Ref<Eigen::VectorXd> out) {
  for (Node& node : nodes_) {
    if (node.rotor) continue;
    if (node.planar) {
      const Vec3 u = in_plane(node.against), v = in_plane(node.twist);
      const Vec3 momentum = momentum_in_plane(node.own, v);
      in_plane(node.momentum) = momentum;
      in_plane(node.momentum_rate) =
          momentum_in_plane(node.own, in_plane(node.acceleration) - ad_in_plane(u, v)) -
          ad_transpose_in_plane(u, momentum);
    } else if (node.link.parent == kGround) {
      node.momentum = node.own * node.twist;
      node.momentum_rate.setZero();
    } else {
      node.momentum = node.own * node.twist;
      node.momentum_rate = node.own * (node.acceleration - ad(node.against, node.twist)) -
                           ad_transpose(node.against, node.momentum);
    }
  }
  for (size_t j = nodes_.size(); j-- > 0;) {
    const Node& node = nodes_[j];
    if (node.link.parent == kGround) {
      for (int i = 0; i < node.count; ++i) out[node.dof + i] += node.along(i, node.momentum_rate);
      continue;
    }
    Node& parent = at(node.link.parent);
    if (node.rotor) {  // its spin is a wrench fixed in the parent
      out[node.dof] += node.spin_here.dot(parent.acceleration - ad(parent.against, parent.twist));
      const Wrench change = -node.rate * ad_transpose(parent.against, node.spin_here);
      if (parent.planar) {
        in_plane(parent.momentum) += node.rate * in_plane(node.spin_here);
        in_plane(parent.momentum_rate) += in_plane(change);
      } else {
        parent.momentum += node.rate * node.spin_here;
        parent.momentum_rate += change;
      }
      continue;
    }
    if (node.planar) {
      const Vec3 force = ad_transpose_in_plane(in_plane(parent.against), in_plane(node.momentum)) +
                         in_plane(node.momentum_rate);
      out[node.dof] += in_plane(node.columns.col(0)).dot(force);
    } else {  // the axes of a ball joint turn with the child, that of a hinge or slider with the
              // parent
      const Twist& carrier = node.count > 1 ? node.against : parent.against;
      const Wrench force = ad_transpose(carrier, node.momentum) + node.momentum_rate;
      for (int i = 0; i < node.count; ++i) out[node.dof + i] += node.columns.col(i).dot(force);
    }
    if (parent.planar) {
      in_plane(parent.momentum) += in_plane(node.momentum);
      in_plane(parent.momentum_rate) += in_plane(node.momentum_rate);
    } else {
      parent.momentum += node.momentum;
      parent.momentum_rate += node.momentum_rate;
    }
  }
}

}  // namespace hamel::mechanisms
