// Drawing of a system: bodies made of simple shapes, and the place of each as a function of the
// configuration.
//
//   void draw(auto& scene) const {
//     scene.floor();
//     scene.body("disk", [](const auto& g) { return Placement{g.translation, g.rotation}; },
//                {shapes::cylinder(radius, 0.02)}).trail();
//   }
// Lengths in the units of the configuration (m), z up; the report page moves the bodies.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/lie/types.hpp>
#include <hamel/framework/mechanics/point.hpp>

namespace hamel {

/// Origin of a shape in the body's frame, direction of the shape's z axis, and colour: "body",
/// "accent", "dark", "light" or "#rrggbb".
struct Look {
  Point at = {0, 0, 0};
  Point axis = {0, 0, 1};
  std::string color = "body";
};

/// A shape fixed in a body.
struct BodyShape {
  std::string kind;
  std::vector<double>
      sizes;  // box: edges, ellipsoid: radii, cylinder: radius and length, sphere: radius
  std::vector<Point> points;  // line: its corners, arrow: its tip
  Look look;
};

namespace shapes {
inline BodyShape box(Point edges, Look look = {}) {
  return {"box", {edges.begin(), edges.end()}, {}, std::move(look)};
}
/// About its own z axis; a disk has a small length. Marked, so that it is seen to turn.
inline BodyShape cylinder(double radius, double length, Look look = {}) {
  return {"cylinder", {radius, length}, {}, std::move(look)};
}
/// Marked, so that it is seen to turn.
inline BodyShape sphere(double radius, Look look = {}) {
  return {"sphere", {radius}, {}, std::move(look)};
}
inline BodyShape ellipsoid(Point radii, Look look = {}) {
  return {"ellipsoid", {radii.begin(), radii.end()}, {}, std::move(look)};
}
inline BodyShape line(std::vector<Point> points, Look look = {}) {
  return {"line", {}, std::move(points), std::move(look)};
}
inline BodyShape arrow(Point to, Look look = {}) { return {"arrow", {}, {to}, std::move(look)}; }
}  // namespace shapes

/// The place of a body: its origin, and its rotation (body to space).
struct Placement {
  Vec<3> position = Vec<3>::Zero();
  Mat<3, 3> rotation = Mat<3, 3>::Identity();
};

/// A body that moves in the plane: at (x, y), turned by theta about the vertical, z above the
/// floor.
inline Placement planar(double x, double y, double theta, double z = 0) {
  const double c = std::cos(theta), s = std::sin(theta);
  return {Vec<3>(x, y, z), Mat<3, 3>{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
}

/// The same for an element of SE(2).
Placement planar(const auto& g, double z = 0) {
  return planar(g.translation[0], g.translation[1], g.angle(), z);
}

struct DrawnBody {
  std::string name;
  std::function<Placement(std::span<const double> coordinates)> place;
  std::vector<BodyShape> shapes;
  bool has_trail = false;
  Point trail_point = {0, 0, 0};

  /// Draws the path of a point of the body.
  DrawnBody& trail(Point point = {0, 0, 0}) {
    has_trail = true;
    trail_point = point;
    return *this;
  }
};

struct Drawing {
  bool from_above = false;  // for motions in the plane: seen from above at first
  bool has_floor = false;   // a grid in the plane z = 0
  std::vector<DrawnBody> bodies;
};

/// The argument of a system's draw(); place: element of G -> Placement.
template <class G>
class Scene {
 public:
  explicit Scene(Drawing& drawing) : drawing_(drawing) {}
  void floor() { drawing_.has_floor = true; }
  void from_above() { drawing_.from_above = drawing_.has_floor = true; }
  template <class Place>
  DrawnBody& body(const std::string& name, Place place, std::vector<BodyShape> shapes) {
    drawing_.bodies.push_back({name,
                               [place](std::span<const double> coordinates) -> Placement {
                                 return place(G::from_coordinates(coordinates));
                               },
                               std::move(shapes)});
    return drawing_.bodies.back();
  }

 private:
  Drawing& drawing_;
};

}  // namespace hamel
