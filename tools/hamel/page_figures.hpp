// The data of the report's larger figures: heat maps, curves on the sphere, bodies that move.
#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/mechanics/drawing.hpp>

namespace hamel::tools {

/// A cell of a table, or a value on the axis of a heat map: a text, or a number that the page
/// formats.
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
  std::vector<std::vector<std::string>> marks = {};  // none, or as many short texts ("failed")
  bool log = false;                                  // the scale of the values
  std::string unit = "";                             // what they are
  std::string note = "";
  std::vector<std::vector<long>> members = {};  // none, or of the cells: a click shows the member
  std::vector<std::string> classes = {};        // names of the values 0, 1, ... in place of a scale
};

/// All pairs of columns, a dot for each member.
struct ScatterMatrix {
  struct Column {
    std::string name, unit;
    std::vector<double> values;
    std::vector<double> correlation = {};  // with each column
  };
  std::string title;
  std::vector<Column> columns;
  std::vector<long> members;              // of the dots
  std::vector<std::string> classes = {};  // none, or their names
  std::vector<long> class_of = {};        // of the dots
  std::string note = "";
};

class Page;

/// The members of an ensemble: what a click on one of them shows.
struct Members {
  struct Column {
    std::string name, unit;
    bool varied = false;  // else kept
    std::vector<double> values;
    std::vector<std::string> names = {};  // of the values 0, 1, ...
  };
  std::vector<std::string> paragraphs;
  std::string command;           // of a member, {} in place of its index
  long count = 0;                // of all members
  std::vector<long> index = {};  // of those with values here; none: all
  std::vector<Column> columns;
  std::map<long, std::string> failures = {};  // reasons
  std::map<long, const Page*> motions = {};   // the blocks of its first section
};

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

/// A force, drawn as an arrow from where it acts.
struct MovingForce {
  std::string name;
  std::vector<std::array<double, 6>> values;  // one for each time: where it acts, the force
};

/// Bodies that move, interpolated between the times: two poses that follow each other should differ
/// by less than half a turn.
struct Animation {
  std::string title;
  std::vector<double> times;
  std::vector<MovingBody> bodies;
  std::vector<MovingForce> forces = {};
  bool from_above = false;  // for motions in the plane: seen from above at first
  bool floor = false;       // a grid in the plane z = 0
  std::string note = "";
};

}  // namespace hamel::tools
