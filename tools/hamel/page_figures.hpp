// The data of the report's larger figures: heat maps, curves on the sphere, bodies that move.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace hamel::tools {

/// A cell of a table, or a value on the axis of a heat map: a word, or a number that the page formats.
struct Cell {
  Cell(std::string word) : text(std::move(word)) {}
  Cell(const char* word) : text(word) {}
  Cell(double value) : number(value), is_number(true) {}
  std::string text;
  double number = 0;
  bool is_number = false;
};

struct SphereCurve {
  std::string name;
  std::vector<std::vector<double>> points;  // of three entries
};

/// Coloured cells, darker for larger values. Rows are read from the top; where y_values are rising
/// numbers they grow upwards.
struct HeatMap {
  std::string title;
  std::string x, y;  // labels
  std::vector<Cell> x_values, y_values;
  std::vector<std::vector<double>> values;           // a row for each y; NaN is an empty cell
  std::vector<std::vector<std::string>> marks = {};  // none, or the same of short words ("failed")
  bool log = false;                                  // the scale of the values
  std::string unit = "";                             // what they are
  std::string note = "";
};

using Point = std::array<double, 3>;

/// Where a shape stands in the body's frame, where its own z axis points, and its colour: "body",
/// "accent", "dark", "light" or "#rrggbb".
struct Look {
  Point at = {0, 0, 0};
  Point axis = {0, 0, 1};
  std::string color = "body";
};

/// A shape fixed in a body; its length unit is that of the positions.
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

/// Position, and rotation as a unit quaternion (w, x, y, z), body to space.
struct Pose {
  Point position = {0, 0, 0};
  std::array<double, 4> rotation = {1, 0, 0, 0};
};

struct MovingBody {
  std::string name;
  std::vector<Pose> poses;  // one for each time
  std::vector<BodyShape> shapes;
  bool trail = false;             // draws the way of
  Point trail_point = {0, 0, 0};  // this point of the body
};

/// Bodies that move, interpolated between the times: two poses that follow each other should differ
/// by less than half a turn.
struct Animation {
  std::string title;
  std::vector<double> times;
  std::vector<MovingBody> bodies;
  bool from_above = false;  // for motions in the plane: seen from above at first
  bool floor = false;       // a grid in the plane z = 0
  std::string note = "";
};

}  // namespace hamel::tools
