// The motion of a run: bodies, their paths in the plane, the axes of a body on the sphere.
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <hamel/framework/figures/curves.hpp>
#include <hamel/framework/figures/figures.hpp>
#include <hamel/framework/figures/run_figures.hpp>
#include <hamel/framework/mechanics/drawing.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel::figures {
namespace {

// The first column that the group calls name or ends in _name (a factor of a product), whatever the
// system calls it; -1 when none is.
int find_column(const Registry& registry, const Result& result, const std::string& name) {
  const auto group = registry.group_or_product(result.system->group.name);
  const auto& columns = group ? group->columns : result.system->group.columns;
  for (size_t j = 0; j < columns.size(); ++j) {
    if (columns[j] == name || columns[j].ends_with("_" + name)) return static_cast<int>(j) + 1;
  }
  return -1;
}

// The points of bodies whose way is drawn, seen from above; else x and y of the group, where it has
// them.
std::vector<Curve> paths(const Registry& registry, const Result& result) {
  std::vector<Curve> out;
  const std::vector<size_t> rows = thin_rows(result, 3000);
  for (const DrawnBody& body : result.system->drawing.bodies) {
    if (!body.has_trail) continue;
    Curve& curve = out.emplace_back(Curve{.name = body.name});
    for (size_t i : rows) {
      const Placement place = body.place(element(result, i));
      const Vec<3> at =
          place.position + place.rotation * Eigen::Map<const Vec<3>>(body.trail_point.data());
      curve.x.push_back(at[0]);
      curve.y.push_back(at[1]);
    }
  }
  const int x = find_column(registry, result, "x"), y = find_column(registry, result, "y");
  if (!out.empty() || x < 0 || y < 0) return out;
  const auto name = [&](int column) {
    return result.trajectory.columns()[static_cast<size_t>(column)];
  };
  Curve& curve = out.emplace_back(Curve{.name = fmt::format("{}, {}", name(x), name(y))});
  for (size_t i : rows) {
    curve.x.push_back(result.trajectory.at(i, static_cast<size_t>(x)));
    curve.y.push_back(result.trajectory.at(i, static_cast<size_t>(y)));
  }
  return out;
}

// The paths are not all constant: a body that only turns about a fixed point of its way has none.
bool moves(const std::vector<Curve>& paths) {
  return std::any_of(paths.begin(), paths.end(), [](const Curve& s) {
    const auto [x0, x1] = std::minmax_element(s.x.begin(), s.x.end());
    const auto [y0, y1] = std::minmax_element(s.y.begin(), s.y.end());
    return !s.x.empty() && (*x1 > *x0 || *y1 > *y0);
  });
}

// Rows whose rotations are near each other, so that a curve through them is that of the motion: all
// of the run thinned, or so much of its beginning as a figure shows.
std::vector<size_t> near_rows(const Result& result, size_t first) {
  constexpr size_t points = 2000, most = 4000;
  constexpr double near = 0.1;  // rad
  std::vector<size_t> rows = thin_rows(result, points);
  if (rows.size() < 3) return rows;
  const auto axis = [&](size_t row, size_t k) {
    return Vec<3>(result.trajectory.at(row, first + k), result.trajectory.at(row, first + k + 3),
                  result.trajectory.at(row, first + k + 6));
  };
  const size_t step = rows[1] - rows[0];
  double widest = 0;
  for (size_t i = 1; i < rows.size(); ++i)
    for (size_t k = 0; k < 3; ++k)
      widest = std::max(widest, (axis(rows[i], k) - axis(rows[i - 1], k)).norm());
  if (widest <= near) return rows;
  const auto finer =
      std::max<size_t>(1, static_cast<size_t>(static_cast<double>(step) * near / widest));
  rows.clear();
  for (size_t row = 0; row < result.trajectory.rows() && rows.size() < most; row += finer)
    rows.push_back(row);
  return rows;
}

void add_axes_on_sphere(std::vector<Figure>& out, const Registry& registry, const Result& result) {
  const int column = find_column(registry, result, "R11");
  if (column < 0) return;
  const auto first = static_cast<size_t>(column);
  const std::vector<size_t> rows = near_rows(result, first);
  bool turns = false;
  Sphere sphere;
  for (size_t axis = 0; axis < 3; ++axis) {
    Sphere::Curve curve{fmt::format("body axis e{}", axis + 1), {}};
    for (size_t i : rows) {
      const size_t at = first + axis;  // row-major: column `axis` of R
      curve.points.push_back({result.trajectory.at(i, at), result.trajectory.at(i, at + 3),
                              result.trajectory.at(i, at + 6)});
    }
    turns = turns || std::any_of(curve.points.begin(), curve.points.end(), [&](const Point& p) {
              return Eigen::Map<const Vec<3>>(p.data())
                         .cross(Eigen::Map<const Vec<3>>(curve.points[0].data()))
                         .norm() > 1e-6;
            });
    sphere.curves.push_back(std::move(curve));
  }
  if (!turns) return;  // nothing to see of a body that does not turn
  std::string note = "Columns of R; drag to turn.";
  const size_t stride = rows.size() > 1 ? rows[1] - rows[0] : 1;
  if (rows.back() + stride < result.trajectory.rows())
    note += fmt::format(" To t = {:.4g}: the whole run has more turns than this figure can show.",
                        result.trajectory.at(rows.back(), 0));
  out.push_back({.title = "Motion of the body axes",
                 .drawing = std::move(sphere),
                 .note = std::move(note),
                 .name = "axes"});
}

constexpr const char* kMode = ".mode";

// The column of this name; -1 where there is none.
int column_of(const Result& result, const std::string& name) {
  const std::vector<std::string>& columns = result.trajectory.columns();
  const auto at = std::ranges::find(columns, name);
  return at == columns.end() ? -1 : static_cast<int>(at - columns.begin());
}

// Contacts over the time, each cell the mode at its middle.
void add_modes(std::vector<Figure>& out, const Result& result) {
  constexpr size_t cells = 200;
  HeatMap map{.x = {"t", "s"}, .y = {"contact"}, .classes = {"open", "rolls", "slides"}};
  const double start = result.trajectory.at(0, 0),
               end = result.trajectory.at(result.trajectory.rows() - 1, 0),
               width = (end - start) / cells;
  const std::string suffix = kMode;
  for (const std::string& column : result.trajectory.columns()) {
    if (!column.ends_with(suffix)) continue;
    map.y_values.emplace_back(column.substr(0, column.size() - suffix.size()));
    const auto j = static_cast<size_t>(column_of(result, column));
    std::vector<double>& row = map.values.emplace_back();
    size_t i = 0;
    for (size_t cell = 0; cell < cells; ++cell) {
      const double t = start + (static_cast<double>(cell) + 0.5) * width;
      while (i + 1 < result.trajectory.rows() &&
             std::abs(result.trajectory.at(i + 1, 0) - start) <= std::abs(t - start))
        ++i;
      row.push_back(result.trajectory.at(i, j));
    }
  }
  if (map.values.empty() || start == end) return;
  for (size_t cell = 0; cell < cells; ++cell)
    map.x_values.emplace_back(start + (static_cast<double>(cell) + 0.5) * width);
  out.push_back({.title = "Modes of the contacts", .drawing = std::move(map), .name = "modes"});
}

// The cone of a contact that has a normal reaction and slips in two directions.
void add_cone(MovingForce& force, const DrawnForce& drawn, const Result& result,
              const std::vector<size_t>& rows) {
  const std::vector<ContactLaw>& laws = result.system->contact_laws;
  const auto law = std::ranges::find(laws, drawn.name, &ContactLaw::name);
  const size_t reactions = result.system->reactions.size();
  if (law == laws.end() || !law->normal || law->tangential.size() != 2 ||
      static_cast<size_t>(*law->normal) >= reactions)
    return;
  std::vector<double> one(reactions);
  one[static_cast<size_t>(*law->normal)] = 1;
  bool constant = true;
  for (const size_t i : rows) {
    const Vec<3> f = drawn.value(element(result, i), one).second;
    if (!(f.norm() > 0)) return force.normals.clear();
    const Vec<3> n = f / f.norm();
    force.normals.push_back({n[0], n[1], n[2]});
    constant = constant && (n - Eigen::Map<const Vec<3>>(force.normals[0].data())).norm() < 1e-9;
  }
  if (constant && !force.normals.empty()) force.normals.resize(1);
  force.friction = law->holding();
}

std::optional<Animation> animation_of(const Result& result) {
  const Drawing& drawing = result.system->drawing;
  if (drawing.bodies.empty()) return {};
  Animation out;
  out.from_above = drawing.from_above;
  out.floor = drawing.has_floor;
  std::vector<size_t> rows = thin_rows(result, 900);
  const auto time = [&](size_t i) { return result.trajectory.at(i, 0); };
  if (!rows.empty() && time(rows.back()) < time(rows.front())) std::ranges::reverse(rows);
  for (size_t i : rows) out.times.push_back(result.trajectory.at(i, 0));
  for (const DrawnBody& drawn : drawing.bodies) {
    MovingBody body{drawn.name, {}, drawn.shapes, drawn.has_trail, drawn.trail_point};
    for (size_t i : rows) {
      const Placement at = drawn.place(element(result, i));
      const Eigen::Quaterniond q(at.rotation);
      body.poses.push_back(
          {{at.position[0], at.position[1], at.position[2]}, {q.w(), q.x(), q.y(), q.z()}});
    }
    out.bodies.push_back(std::move(body));
  }
  const SystemModel& system = *result.system;
  if (system.forces.empty()) return out;
  std::vector<size_t> at;  // their columns
  for (const std::string& name : system.reactions) at.push_back(result.trajectory.index(name));
  std::vector<double> reactions(at.size());
  for (const DrawnForce& drawn : system.forces) {
    MovingForce force{drawn.name, {}};
    const int mode = column_of(result, drawn.name + kMode);
    for (size_t i : rows) {
      for (size_t j = 0; j < at.size(); ++j) reactions[j] = result.trajectory.at(i, at[j]);
      const auto [x, f] = drawn.value(element(result, i), reactions);
      force.values.push_back({x[0], x[1], x[2], f[0], f[1], f[2]});
      if (mode >= 0) force.modes.push_back(result.trajectory.at(i, static_cast<size_t>(mode)));
    }
    if (mode >= 0) add_cone(force, drawn, result, rows);
    out.forces.push_back(std::move(force));
  }
  return out;
}

}  // namespace

std::vector<size_t> thin_rows(const Result& result, size_t points) {
  const size_t rows = result.trajectory.rows(), step = std::max<size_t>(rows / points, 1);
  std::vector<size_t> out;
  for (size_t i = 0; i < rows; i += step) out.push_back(i);
  if (!out.empty() && out.back() != rows - 1) out.push_back(rows - 1);
  return out;
}

std::span<const double> element(const Result& result, size_t row) {
  return result.trajectory.row(row).subspan(1, result.system->group.columns.size());
}

std::vector<Figure> motion_of_run(const Registry& registry, const Result& r) {
  std::vector<Figure> out;
  if (r.trajectory.rows() == 0) return out;
  if (auto animation = animation_of(r))
    out.push_back({.title = "Motion", .drawing = std::move(*animation), .name = "motion"});
  if (r.system->drawing.has_floor || r.system->drawing.bodies.empty()) {
    std::vector<Curve> ways = paths(registry, r);
    if (moves(ways))
      out.push_back(
          {.title = "Path in the plane",
           .drawing =
               Plot{.x = {"x", "m"}, .y = {"y", "m"}, .curves = std::move(ways), .path = true},
           .name = "path"});
  }
  add_axes_on_sphere(out, registry, r);
  add_modes(out, r);
  for (Figure& figure : out) figure.section = "Motion";
  return out;
}

}  // namespace hamel::figures
