// Tube: a wheel with a round tread, a torus about an axle n. rho the radius of the crown, r of the
// wheel in its plane, below its centre c
//   q = c - (r - rho) (gamma - (gamma.n) n)/|...| - rho gamma,   u as of a wheel.
// Source: Pacejka, Tire and Vehicle Dynamics (2006), ch. 11, motorcycle tyres.
#pragma once

#include <string>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/contacts/wheel_contact.hpp>

namespace hamel::mechanisms {

struct TubeContact : WheelContact {
  double crown = 0;  // m

  static std::string name() { return "tube"; }
  static std::string summary() { return "a wheel with a round tread, a torus"; }
  void fields(auto& f) {
    f("axle", axle, "", "to the left, so that it rolls ahead at positive rates");
    f("radius", radius, "m", "of the wheel in its plane, the tread included", positive);
    f("crown", crown, "m", "radius of the tread across", non_negative);
  }
  std::string flaw() const {
    return crown <= radius
               ? ""
               : fmt::format("crown: got {}, expected at most the radius {}", crown, radius);
  }
  template <class T>
  ContactPoint<T, 2> touch(const ContactView<T>& view) const {
    const auto wheel = WheelContact::touch(view);
    const T part = T(crown / radius);
    const VecT<T, 3> rim = (T(1.0) - part) * (wheel.point - view.at);
    return {view.at + rim - T(crown) * view.vertical, wheel.directions};
  }
  std::vector<BodyShape> shapes(const Point& at) const {
    return {shapes::wheel(radius, 2 * crown,
                          {.at = at, .axis = {axle[0], axle[1], axle[2]}, .color = "dark"})};
  }
};

}  // namespace hamel::mechanisms
