// Blade: a knife edge, q a point of the body, u = gamma x d/|...|, d the direction of the edge.
#pragma once

#include <hamel/systems/mechanisms/contact.hpp>

namespace hamel::mechanisms {

struct BladeContact {
  Vec3 along = Vec3::UnitX();

  static std::string name() { return "blade"; }
  static std::string summary() { return "a knife edge"; }
  static std::vector<std::string> meanings() { return {"does not slip across its edge"}; }
  void fields(auto& f) { f("along", along, "", "where it slides"); }
  template <class T>
  ContactPoint<T, 1> touch(const ContactView<T>& view) const {
    const VecT<T, 3> across = view.vertical.cross(view.turned(along));
    using std::sqrt;
    return {view.at, {(T(1.0) / sqrt(across.squaredNorm())) * across}};
  }
  std::vector<BodyShape> shapes(const Point& at) const {
    const auto end = [&](double way) -> Point {
      return {at[0] + way * along[0], at[1] + way * along[1], at[2] + way * along[2]};
    };
    return {shapes::line({end(-0.1), end(0.1)}, {.color = "accent"})};
  }
};

}  // namespace hamel::mechanisms
