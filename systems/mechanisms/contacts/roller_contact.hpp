// Roller: a wheel that slips along the axles of its rollers. Its direction, from those of a wheel:
//   u = cos(a) rolling + sin(a) sideways, a the angle of the rollers (0: omniwheel, pi/4: mecanum
//   wheel).
#pragma once

#include <hamel/systems/mechanisms/contacts/wheel_contact.hpp>

namespace hamel::mechanisms {

struct RollerContact : WheelContact {
  double angle = 0;  // rad

  static std::string name() { return "roller"; }
  static std::string summary() { return "a wheel that slips along its rollers"; }
  static std::vector<std::string> meanings() {
    return {"does not slip along the axes of its rollers"};
  }
  void fields(auto& f) {
    WheelContact::fields(f);
    f("angle", angle, "rad", "of the rollers against the plane of the wheel");
  }
  template <class T>
  ContactPoint<T, 1> touch(const ContactView<T>& view) const {
    const auto wheel = WheelContact::touch(view);
    return {wheel.point,
            {T(std::cos(angle)) * wheel.directions[0] + T(std::sin(angle)) * wheel.directions[1]}};
  }
};

}  // namespace hamel::mechanisms
