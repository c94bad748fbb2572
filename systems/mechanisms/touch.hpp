// Where a contact touches the ground. Not installed.
#pragma once

#include <hamel/systems/mechanisms/rows.hpp>

namespace hamel::mechanisms {

/// Where a contact touches, its first horizontal direction, and the vertical: seen from the root.
struct Touch {
  Vec3 gamma, q, along;
  Rigid here;  // its carrier
  Vec3 axis;
  Touch(const Contact& contact, const Tree& tree) {
    here = tree.from_root(contact.carrier);
    gamma = tree.root_in_world(contact.link).rotation.row(2).transpose();
    q = here.apply(contact.at);
    axis = here.rotation.lazyProduct(contact.axis);
    along = axis;
    switch (contact.kind) {
      case ContactKind::wheel:
      case ContactKind::roller: {
        const Vec3 up = gamma - gamma.dot(axis) * axis;
        q -= contact.radius / up.norm() * up;
        along = axis.cross(gamma).normalized();
        break;
      }
      case ContactKind::blade: break;
      case ContactKind::ball:
        q -= contact.radius * gamma;
        along = tree.root_in_world(contact.link).rotation.row(0).transpose();
        break;
    }
  }
};

}  // namespace hamel::mechanisms
