// Wheel: a thin disk about an axle n. Below its centre c, in the plane across the axle,
//   q = c - r (gamma - (gamma.n) n)/|...|,   u = n x gamma/|...| (rolling), gamma x u (sideways).
#pragma once

#include <hamel/framework/mechanics/wheel_shape.hpp>
#include <hamel/systems/mechanisms/contact.hpp>

namespace hamel::mechanisms {

struct WheelContact {
  Vec3 axle = Vec3::UnitY();
  double radius = 0;  // m

  static std::string name() { return "wheel"; }
  static std::string summary() { return "a thin disk that rolls on the ground"; }
  static std::vector<std::string> meanings() {
    return {"rolls without slipping", "does not slip sideways"};
  }
  void fields(auto& f) {
    f("axle", axle, "", "to the left, so that it rolls ahead at positive rates");
    f("radius", radius, "m", "of the disk", positive);
  }
  template <class T>
  ContactPoint<T, 2> touch(const ContactView<T>& view) const {
    const VecT<T, 3> n = view.turned(axle), up = view.vertical - view.vertical.dot(n) * n,
                     ahead = n.cross(view.vertical);  // as long as up
    using std::sqrt;
    const T inverse = T(1.0) / sqrt(ahead.squaredNorm());
    const VecT<T, 3> rolling = inverse * ahead;
    return {view.at - (radius * inverse) * up, {rolling, view.vertical.cross(rolling)}};
  }
  std::vector<BodyShape> shapes(const Point& at) const {
    return {shapes::wheel(radius, 0.1 * radius,
                          {.at = at, .axis = {axle[0], axle[1], axle[2]}, .color = "dark"})};
  }
};

}  // namespace hamel::mechanisms
