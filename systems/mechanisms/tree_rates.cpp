// Rates along the motion with xi held: twists, and what turning and moving does on xi.
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

// Part of a link that is no rotor in the sum F, with its weight.
inline Wrench Tree::force_on(const Node& node) const {
  const bool is_root = node.link.parent == kGround;
  const Inertia& own = node.own;
  const Vec3& a = at(node.root).gravity;
  if (node.planar) {
    const Vec3 u = in_plane(node.against), v = in_plane(node.twist);
    Wrench out = Wrench::Zero();
    in_plane(out) =
        ad_transpose_in_plane(v, momentum_in_plane(own, v)) +
        Vec3(own.first[0] * a[1] - own.first[1] * a[0], own.mass * a[0], own.mass * a[1]);
    if (!is_root)
      in_plane(out) -= momentum_in_plane(own, in_plane(node.acceleration) - ad_in_plane(u, v));
    return out;
  }
  Wrench out = ad_transpose(node.twist, own * node.twist) + stack(own.first.cross(a), own.mass * a);
  if (!is_root) out -= own * (node.acceleration - ad(node.against, node.twist));
  return out;
}

HAMEL_FLATTEN void Tree::bias(const Vec3& gravity, Eigen::Ref<Eigen::VectorXd> out) {
  for (Node& node : nodes_) {
    if (node.link.parent == kGround)
      node.gravity = node.world.rotation.transpose().lazyProduct(gravity);
    if (!node.rotor) node.force = force_on(node);  // a rotor's weight is its parent's
  }
  for (size_t j = nodes_.size(); j-- > 0;) {
    const Node& node = nodes_[j];
    if (!node.rotor)
      node.each_along(node.force, [&](int i, double effect) { out[node.dof + i] = effect; });
    if (node.link.parent == kGround) continue;
    Node& parent = at(node.link.parent);
    if (node.rotor) {  // its spin is a wrench fixed in the parent
      out[node.dof] = node.spin_here.dot(ad(parent.against, parent.twist) - parent.acceleration);
      const Wrench force = node.rate * ad_transpose(parent.twist, node.spin_here);
      if (parent.planar) in_plane(parent.force) += in_plane(force);
      else parent.force += force;
    } else if (parent.planar) {
      in_plane(parent.force) += in_plane(node.force);
    } else {
      parent.force += node.force;
    }
  }
}

}  // namespace hamel::mechanisms
