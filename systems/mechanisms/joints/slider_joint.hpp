// Slider: along the axis.
#pragma once

#include <hamel/groups/rn.hpp>
#include <hamel/systems/mechanisms/joint.hpp>

namespace hamel::mechanisms {

struct SliderJoint {
  using Group = Rn<1>;
  static std::string name() { return "slider"; }
  static std::vector<std::string> columns() { return {"position"}; }
  static std::vector<std::string> rates() { return {"rate"}; }
  Vec<6> directions() const { return Vec<6>::Unit(5); }
  Rigid motion(const Vec<1>& x) const { return {Mat<3, 3>::Identity(), {0, 0, x[0]}}; }
};

}  // namespace hamel::mechanisms
