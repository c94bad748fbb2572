// Pin: a point q of the body that does not slip in any direction, u the world's x and y.
#pragma once

#include <hamel/systems/mechanisms/contact.hpp>

namespace hamel::mechanisms {

struct MyContact {
  static constexpr bool of_world = true;
  static std::string name() { return "my_contact"; }
  static std::string summary() { return "a point that stays on its place"; }
  static std::vector<std::string> meanings() { return {"stays in x", "stays in y"}; }
  template <class T>
  ContactPoint<T, 2> touch(const ContactView<T>& view) const {
    return {view.at, {view.world_axis(0), view.world_axis(1)}};
  }
  std::vector<BodyShape> shapes(const Point& at) const {
    return {shapes::sphere(0.02, {.at = at, .color = "dark"})};
  }
};

}  // namespace hamel::mechanisms
