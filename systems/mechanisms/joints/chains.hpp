// Kinds without a joint class: several joints one behind the other, or none.
#pragma once

#include <hamel/systems/mechanisms/joints/hinge_joint.hpp>

namespace hamel::mechanisms {

/// Two hinges, the first on the parent, the second on the child, whose axes intersect.
struct UniversalJoint {
  using Chain = TypeList<HingeJoint, HingeJoint>;
  static std::string name() { return "universal"; }
};

/// The child is a part of the parent.
struct Weld {
  using Chain = TypeList<>;
  static std::string name() { return "weld"; }
};

}  // namespace hamel::mechanisms
