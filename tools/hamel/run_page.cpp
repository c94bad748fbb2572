#include "run_page.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <Eigen/Geometry>

namespace hamel::tools {
namespace {

// The first column that is called name or ends in _name (a factor of a product); -1 when none is.
int find_column(const Result& result, const std::string& name) {
  const auto& columns = result.system.group.columns;
  for (size_t j = 0; j < columns.size(); ++j) {
    if (columns[j] == name || columns[j].ends_with("_" + name)) return static_cast<int>(j) + 1;
  }
  return -1;
}

std::vector<size_t> thin_rows(const Result& result, size_t points) {
  const size_t rows = result.trajectory.rows(), step = std::max<size_t>(rows / points, 1);
  std::vector<size_t> out;
  for (size_t i = 0; i < rows; i += step) out.push_back(i);
  if (!out.empty() && out.back() != rows - 1) out.push_back(rows - 1);
  return out;
}

// Forces or moving constraints do.
bool does_work(const Result& r) { return std::isfinite(r.work); }

std::string headline(const Result& r) {
  if (!r.status.ok) {
    return fmt::format(
        "Failed in step {} at t = {:.6g}: {} (residual {:.2e}). {} good steps are kept.",
        r.status.step, r.status.time, r.status.reason, r.status.residual, r.steps);
  }
  std::string out =
      fmt::format("{} steps of h = {} to t = {:.6g}", r.steps, r.config.step, r.last.time);
  if (std::isfinite(r.exact_error_max)) {
    out += fmt::format(
        "; against the exact motion the configuration is off by at most {:.1e}, the velocity by at "
        "most {:.1e}",
        r.exact_error_max, r.exact_velocity_error_max);
  } else if (std::isfinite(r.estimated_error)) {
    out += fmt::format("; by half and a quarter of the step its end is off by about {:.1e}",
                       r.estimated_error);
  }
  out += fmt::format(
      "; constraint residual at most {:.1e}, group defect at most {:.1e}, {} at most {:.1e}.",
      r.constraint_max, r.group_defect_max,
      does_work(r) ? "defect of the energy balance" : "energy error", r.energy_error_max);
  if (r.stats.fallbacks > 0) {
    const Fallback& first = r.stats.first_fallbacks.front();
    out += fmt::format(" {} steps failed and were rescued, the first at t = {:.6g}: {}.",
                       r.stats.fallbacks, first.time, first.action);
  }
  return out;
}

}  // namespace

Series curve(const Result& result, const std::string& name, const std::string& column,
             bool magnitude) {
  std::vector<double> y = result.trajectory.column(column);
  return thinned(name, result.trajectory.column("t"), magnitude ? magnitudes(y) : y, magnitude);
}

Series plane_path(const Result& result, const std::string& name) {
  Series out{name, {}, {}};
  const int x = find_column(result, "x"), y = find_column(result, "y");
  if (x < 0 || y < 0) return out;
  for (size_t i : thin_rows(result, 3000)) {
    out.x.push_back(result.trajectory.at(i, static_cast<size_t>(x)));
    out.y.push_back(result.trajectory.at(i, static_cast<size_t>(y)));
  }
  return out;
}

std::vector<SphereCurve> axes_on_sphere(const Result& result) {
  const int first = find_column(result, "R11");
  if (first < 0) return {};
  std::vector<SphereCurve> out;
  for (size_t axis = 0; axis < 3; ++axis) {
    SphereCurve curve{fmt::format("body axis e{}", axis + 1), {}};
    for (size_t i : thin_rows(result, 2000)) {
      const size_t at = static_cast<size_t>(first) + axis;  // row-major: column `axis` of R
      curve.points.push_back({result.trajectory.at(i, at), result.trajectory.at(i, at + 3),
                              result.trajectory.at(i, at + 6)});
    }
    out.push_back(std::move(curve));
  }
  return out;
}

namespace {

std::optional<Animation> animation_of(const Result& result) {
  const Drawing& drawing = result.system.drawing;
  if (drawing.bodies.empty()) return {};
  Animation out;
  out.title = "Motion";
  out.from_above = drawing.from_above;
  out.floor = drawing.has_floor;
  const std::vector<size_t> rows = thin_rows(result, 900);
  for (size_t i : rows) out.times.push_back(result.trajectory.at(i, 0));
  for (const DrawnBody& drawn : drawing.bodies) {
    MovingBody body{drawn.name, {}, drawn.shapes, drawn.has_trail, drawn.trail_point};
    for (size_t i : rows) {
      const auto coordinates =
          result.trajectory.row(i).subspan(1, result.system.group.columns.size());
      const Placement at = drawn.place(coordinates);
      const Eigen::Quaterniond q(at.rotation);
      body.poses.push_back(
          {{at.position[0], at.position[1], at.position[2]}, {q.w(), q.x(), q.y(), q.z()}});
    }
    out.bodies.push_back(std::move(body));
  }
  return out;
}

}  // namespace

Page run_page(const Result& r) {
  Page page(fmt::format("{}: {} with {}", r.system.name, r.config.scheme, r.config.retraction),
            fmt::format("{}: {}, h = {}", r.system.group.name, r.method(), r.config.step));
  page.section("Result");
  page.verdict(r.status.ok ? "ok" : "failed", headline(r));
  if (!r.notes.empty()) page.text(r.notes);
  const std::string name = r.config.scheme;
  const Axes log = {.x = "time t [s]", .y = "", .log_x = false, .log_y = true};
  const auto with = [](Axes axes, const char* y) {
    axes.y = y;
    return axes;
  };
  if (const auto animation = animation_of(r)) page.animation(*animation);
  const bool exact = r.trajectory.columns().back() == "exact_velocity_error";
  if (const Series path = plane_path(r, name); !path.x.empty()) {
    page.path("Path in the plane", {.x = "x [m]", .y = "y [m]"}, {path});
  }
  if (const auto axes = axes_on_sphere(r); !axes.empty()) {
    page.sphere("Motion of the body axes", axes, "Columns of R; drag to turn.");
  }
  if (does_work(r)) {
    page.plot("Energy balance", with(log, "|E - E0 - W| / max E"), {curve(r, name, "energy_error")},
              "W is the work of forces and moving constraints, by a quadrature over all steps.");
  } else {
    page.plot("Energy error", with(log, "|E - E0| / E0"), {curve(r, name, "energy_error")});
  }
  if (exact) {
    page.plot(
        "Error against the exact motion", with(log, "|difference|"),
        {curve(r, "configuration", "exact_error"), curve(r, "velocity", "exact_velocity_error")},
        "Euclidean distance of the element's columns, and of the body velocities.");
  }
  page.plot("Constraint residual", with(log, "|A xi/h|"), {curve(r, name, "constraint")},
            "The step's velocity is recovered from consecutive configurations; its floor is about "
            "2e-16/h times the size of the coordinates.");
  if (r.trajectory.has("holonomic")) {
    page.plot("Holonomic residual", with(log, "|phi(g)|"), {curve(r, name, "holonomic")});
  }
  page.plot("Group defect", with(log, "defect"), {curve(r, name, "group_defect")});
  std::vector<Series> momentum, velocity;
  for (int i = 1; i <= r.system.group.dim; ++i) {
    momentum.push_back(curve(r, fmt::format("mu{}", i), fmt::format("mu{}", i), false));
    velocity.push_back(curve(r, fmt::format("xi{}", i), fmt::format("xi{}", i), false));
  }
  page.plot("Body momentum", {.x = "time t [s]", .y = "mu"}, momentum);
  page.plot("Body velocity", {.x = "time t [s]", .y = "xi"}, velocity);
  if (r.system.mechanics->rows() > 0) {
    std::vector<Series> reactions;
    for (int i = 1; r.trajectory.has(fmt::format("lambda{}", i)); ++i) {
      reactions.push_back(curve(r, fmt::format("lambda{}", i), fmt::format("lambda{}", i), false));
    }
    if (!reactions.empty()) {
      page.plot("Reaction forces", {.x = "time t [s]", .y = "lambda"}, reactions,
                fmt::format("Multipliers of the rows A xi = b, from the equations of motion at the "
                            "recorded states. Their work over the run: {:.2e}, with A xi measured "
                            "on the configurations; where b = 0 it is zero but for round-off.",
                            r.reaction_work));
    }
  }
  page.section("Record");
  page.record(r.record());
  return page;
}

}  // namespace hamel::tools
