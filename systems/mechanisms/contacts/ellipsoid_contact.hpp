// Ellipsoid: D = diag(a1, a2, a3) along the axes of the body as drawn, d = D gamma in them,
//   q = c - D d/|d|,   u the world's x and y.
// Source: Garcia and Hubbard, Proc. R. Soc. Lond. A 418 (1988).
#pragma once

#include <vector>

#include <hamel/systems/mechanisms/contact.hpp>

namespace hamel::mechanisms {

struct EllipsoidContact {
  std::vector<double> semi_axes = {0, 0, 0};  // m

  static constexpr bool of_world = true;
  static std::string name() { return "ellipsoid"; }
  static std::string summary() { return "an ellipsoid that rolls on the ground"; }
  static std::vector<std::string> meanings() {
    return {"rolls without slipping, along x", "rolls without slipping, along y"};
  }
  void fields(auto& f) {
    f("semi_axes", semi_axes, "m", "along x, y, z of the body as drawn", positive);
  }
  std::vector<Vec3> axes() const { return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}; }
  template <class T>
  ContactPoint<T, 2> touch(const ContactView<T>& view) const {
    using std::sqrt;
    VecT<T, 3> sum = VecT<T, 3>::Constant(T(0.0));
    T square = T(0.0);
    for (int i = 0; i < 3; ++i) {
      const double a = semi_axes[static_cast<size_t>(i)];
      const VecT<T, 3> e = view.turned(Vec3::Unit(i));
      const T along = view.vertical.dot(e);
      sum += (T(a * a) * along) * e;
      square += T(a * a) * (along * along);
    }
    const VecT<T, 3> x = level_axis(view);
    return {view.at - (T(1.0) / sqrt(square)) * sum, {x, view.vertical.cross(x)}};
  }
  std::vector<BodyShape> shapes(const Point& at) const {
    return {shapes::ellipsoid({semi_axes[0], semi_axes[1], semi_axes[2]}, {.at = at})};
  }
};

}  // namespace hamel::mechanisms
