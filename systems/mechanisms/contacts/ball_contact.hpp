// Ball: a sphere that rolls, q = c - r gamma, u the world's x and y.
#pragma once

#include <hamel/systems/mechanisms/contact.hpp>

namespace hamel::mechanisms {

struct BallContact {
  double radius = 0;  // m

  static constexpr bool of_world = true;
  static std::string name() { return "ball"; }
  static std::string summary() { return "a sphere that rolls on the ground"; }
  static std::vector<std::string> meanings() {
    return {"rolls without slipping, along x", "rolls without slipping, along y"};
  }
  void fields(auto& f) { f("radius", radius, "m", "of the sphere", positive); }
  template <class T>
  ContactPoint<T, 2> touch(const ContactView<T>& view) const {
    const VecT<T, 3> x = level_axis(view);
    return {view.at - T(radius) * view.vertical, {x, view.vertical.cross(x)}};
  }
  std::vector<BodyShape> shapes(const Point& at) const {
    return {shapes::sphere(radius, {.at = at})};
  }
};

}  // namespace hamel::mechanisms
