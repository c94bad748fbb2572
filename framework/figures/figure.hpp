// Figures as data: titles, axes, curves and what is drawn beside them. The report page, the files
// of `hamel report --figure` and notebooks draw the same objects (figures.hpp makes them).
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <hamel/framework/mechanics/drawing.hpp>

namespace hamel::figures {

/// Number or text: a cell of a table, or a value on the axis of a heat map.
struct Cell {
  Cell(std::string word) : text(std::move(word)) {}
  Cell(const char* word) : text(word) {}
  Cell(double value) : number(value), is_number(true) {}
  std::string text;
  double number = 0;
  bool is_number = false;
};

/// Axis "label [unit]".
struct Axis {
  std::string label, unit = "";
  bool log = false;
};

/// A fitted line, named in the legend: the text, or the slope where there is none.
struct Fit {
  double slope = 0;
  std::string text = "";
};

/// Curve "name [unit], note" through the points (x, y).
struct Curve {
  std::string name, unit = "";
  std::vector<double> x = {}, y = {};
  std::string note = "";
  bool dashed = false;
  bool markers = false;  // in a plot up to 48 points have them anyway
  bool dots = false;     // markers alone: the points are in no order that a line may follow
  std::optional<Fit> fit = {};
  std::map<std::string, std::string> tags = {};  // by which the filters of the plot select
  std::string key = "";            // curves with one key have one colour on a page; empty: the name
  std::vector<double> low = {};    // none, or the lower edge of a band of which y is the upper one
  bool envelope = false;           // the band is that of a curve with too many turns to be drawn
  std::vector<long> members = {};  // none, or of the points: a click shows the member
};

/// A moment on the x axis, drawn as a line with this text.
struct Mark {
  double x = 0;
  std::string text;
};

/// A part of the x axis, shaded, with this text.
struct Band {
  double from = 0, to = 0;
  std::string text;
};

/// A selector over a plot: only curves whose tag `name` has the chosen value (the first, at the
/// start) are shown; a curve without that tag always is.
struct Filter {
  std::string name;
  std::vector<std::string> values;
};

/// Curves over x, or (path) in the plane with equal scales.
struct Plot {
  Axis x, y;
  std::vector<Curve> curves = {};
  bool path = false;
  double floor = 0;  // round-off: a line there, and a fixed axis while the curves stay near it
  std::vector<int> slopes = {};  // triangles of these slopes, on two logarithmic axes
  std::vector<Mark> marks = {};  // events
  std::vector<Band> bands = {};
  std::vector<Filter> filters = {};
};

/// Curves on the unit sphere.
struct Sphere {
  struct Curve {
    std::string name;
    std::vector<Point> points;
  };
  std::vector<Curve> curves;
};

/// Coloured cells, darker for larger values. Rows are read from the top; where y_values are rising
/// numbers they grow upwards.
struct HeatMap {
  Axis x, y;
  std::vector<Cell> x_values = {}, y_values = {};
  std::vector<std::vector<double>> values = {};      // a row for each y; NaN is an empty cell
  std::vector<std::vector<std::string>> marks = {};  // none, or as many short texts ("failed")
  bool log = false;                                  // the scale of the values
  std::string unit = "";                             // of the values
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
  std::vector<Column> columns = {};
  std::vector<long> members = {};         // of the dots
  std::vector<std::string> classes = {};  // none, or their names
  std::vector<long> class_of = {};        // of the dots
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
  std::vector<double> modes = {};             // none, or as many: 0 open, 1 rolling, 2 sliding
  // The cone of Coulomb's friction: mu, and the direction of the normal reaction, one for each time
  // or one for all; without directions there is none.
  double friction = 0;
  std::vector<Point> normals = {};
};

/// Bodies that move, interpolated between the times: two poses that follow each other should differ
/// by less than half a turn.
struct Animation {
  std::vector<double> times = {};
  std::vector<MovingBody> bodies = {};
  std::vector<MovingForce> forces = {};
  bool from_above = false;  // for motions in the plane: seen from above at first
  bool floor = false;       // a grid in the plane z = 0
};

/// A figure of a run, a study, an ensemble, a branch of steady motions or a section.
struct Figure {
  std::string title;
  std::variant<Plot, Sphere, HeatMap, ScatterMatrix, Animation> drawing;
  std::string note = "";     // below it
  std::string name = "";     // for --figure and Python; empty: from the title
  std::string section = "";  // of a page: figures of one section stand together
};

}  // namespace hamel::figures
