// The inputs of the formula of a contact (contact.hpp), recorded.
#pragma once

#include <hamel/systems/mechanisms/contact.hpp>
#include <hamel/systems/mechanisms/programs/body_formulas.hpp>

namespace hamel::mechanisms {

template <>
class ContactView<Number> {
 public:
  using Vector = NumberVec3;

  ContactView(const Contact& contact, const BodyFormulas& bodies)
      : at(bodies.point(contact.carrier, contact.at)),
        bodies_(bodies),
        carrier_(contact.carrier),
        root_(bodies.root_in_world(contact.link)) {
    vertical = world_axis(2);
  }

  Vector at, vertical;
  bool sloping = false;

  Vector turned(const Vec3& direction) const { return bodies_.direction(carrier_, direction); }
  Vector world_axis(int i) const { return root_.rotation.row(i).transpose(); }
  Vector point_in_world(const Vector& q) const { return root_.apply(q); }
  Vector direction_in_world(const Vector& u) const { return root_.turn(u); }

 private:
  const BodyFormulas& bodies_;
  int carrier_;
  const Pose& root_;
};

/// The point of contact, and the directions in which it does not slip, seen from the root.
struct RecordedContact {
  NumberVec3 point;
  std::vector<NumberVec3> directions;
  std::vector<Number> drifts;  // of the ground, along them
};

}  // namespace hamel::mechanisms
