// Point: a point of a body, above the ground or on it, u the world's x and y: a skid, a leg.
#pragma once

#include <hamel/systems/mechanisms/contact.hpp>

namespace hamel::mechanisms {

struct PointContact {
  static constexpr bool of_world = true;
  static std::string name() { return "point"; }
  static std::string summary() { return "a point of a body on the ground: a skid, a leg"; }
  static std::vector<std::string> meanings() {
    return {"does not slip along x", "does not slip along y"};
  }
  template <class T>
  ContactPoint<T, 2> touch(const ContactView<T>& view) const {
    const VecT<T, 3> x = level_axis(view);
    return {view.at, {x, view.vertical.cross(x)}};
  }
  std::vector<BodyShape> shapes(const Point& at) const {
    return {shapes::sphere(0.01, {.at = at, .color = "dark"})};
  }
};

}  // namespace hamel::mechanisms
