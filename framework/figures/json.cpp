#include <hamel/framework/figures/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include <fmt/format.h>

#include <hamel/framework/figures/curves.hpp>
#include <hamel/framework/figures/figures.hpp>

namespace hamel::figures {
namespace {

constexpr int kTimeDigits = 15;

// More digits for a narrow range: a run from t = 10000 on has distinct times. Less than round-off
// shows.
int digits_of(std::span<const double> values) {
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    least = std::min(least, v);
    most = std::max(most, v);
  }
  if (!(least < most)) return kDigits;
  const double size = std::max(std::abs(least), std::abs(most));
  return kDigits + static_cast<int>(std::clamp(std::log10(size / (most - least)) + 1, 0.0, 6.0));
}

std::string text_of(const Axis& axis) { return with_unit(axis.label, axis.unit); }

// A band too narrow to be seen beside the other curves is drawn as a curve: round-off, mostly.
Json curves_of(const Plot& plot) {
  constexpr double seen = 1e-3;
  const double range = range_of(plot.curves);
  Json out = Json::array();
  for (const Curve& c : plot.curves) {
    const bool band = !c.low.empty() && (plot.y.log || range_of({&c, 1}) > seen * range);
    Json& curve = out.emplace_back(
        Json{{"name", with_unit(c.name, c.unit) + (c.note.empty() ? "" : ", " + c.note)},
             {"x", coordinates(c.x)},
             {"y", coordinates(c.y)},
             {"dashed", c.dashed}});
    if (c.markers) curve["markers"] = true;
    if (c.dots) curve["dots"] = true;
    if (c.fit) curve["fit"] = {{"slope", number(c.fit->slope)}, {"text", c.fit->text}};
    if (!c.tags.empty()) curve["tags"] = c.tags;
    if (!c.key.empty()) curve["key"] = c.key;
    if (band) curve["low"] = coordinates(c.low);
    if (band && c.envelope) curve["envelope"] = true;
    if (!c.members.empty()) curve["members"] = c.members;
  }
  return out;
}

Json shape_of(const BodyShape& s) {
  Json out = {{"shape", s.kind}, {"color", s.look.color}};
  if (s.look.at != Look{}.at) out["at"] = numbers(s.look.at);
  if (s.look.axis != Look{}.axis) out["axis"] = numbers(s.look.axis);
  if (s.kind == "box") out["size"] = numbers(s.sizes);
  if (s.kind == "ellipsoid") out["radii"] = numbers(s.sizes);
  const bool round = s.kind == "cylinder" || s.kind == "wheel";
  if (round || s.kind == "sphere") out["radius"] = number(s.sizes.at(0));
  if (round) out["length"] = number(s.sizes.at(1));
  if (s.kind == "arrow") out["to"] = numbers(s.points.at(0));
  if (s.kind == "line") {
    for (const Point& point : s.points) out["points"].push_back(numbers(point));
  }
  return out;
}

Json body_of(const MovingBody& body) {
  Json poses = Json::array(), parts = Json::array();
  for (const auto& [x, q] : body.poses)
    poses.push_back(numbers(std::array{x[0], x[1], x[2], q[0], q[1], q[2], q[3]}));
  for (const BodyShape& s : body.shapes) parts.push_back(shape_of(s));
  return {{"name", body.name},
          {"poses", poses},
          {"shapes", parts},
          {"trail", body.trail},
          {"trail_point", numbers(body.trail_point)}};
}

// The block of each kind of drawing.
struct Block {
  const Figure& figure;

  Json operator()(const Plot& plot) const {
    Json out = {{"kind", plot.path ? "path" : "plot"},
                {"title", figure.title},
                {"x", text_of(plot.x)},
                {"y", text_of(plot.y)}};
    if (plot.path) {
      out["series"] = curves_of(plot);
      return out;
    }
    out["log_x"] = plot.x.log;
    out["log_y"] = plot.y.log;
    out["series"] = curves_of(plot);
    out["filters"] = Json::array();
    for (const Filter& f : plot.filters)
      out["filters"].push_back({{"name", f.name}, {"values", f.values}});
    out["note"] = figure.note;
    if (plot.floor > 0) out["floor"] = number(plot.floor);
    if (!plot.slopes.empty()) out["slopes"] = plot.slopes;
    for (const Mark& mark : plot.marks)
      out["marks"].push_back({{"x", number(mark.x, kTimeDigits)}, {"text", mark.text}});
    for (const Band& band : plot.bands) {
      out["bands"].push_back({{"from", number(band.from, kTimeDigits)},
                              {"to", number(band.to, kTimeDigits)},
                              {"text", band.text}});
    }
    return out;
  }
  Json operator()(const Sphere& sphere) const {
    Json series = Json::array();
    for (const Sphere::Curve& curve : sphere.curves) {
      Json points = Json::array();
      for (const Point& point : curve.points) points.push_back(numbers(point));
      series.push_back({{"name", curve.name}, {"points", points}});
    }
    return {{"kind", "sphere"}, {"title", figure.title}, {"series", series}, {"note", figure.note}};
  }
  Json operator()(const HeatMap& map) const {
    Json rows = Json::array();
    for (const auto& row : map.values) rows.push_back(numbers(row));
    Json out = {{"kind", "heatmap"},
                {"title", figure.title},
                {"x", text_of(map.x)},
                {"y", text_of(map.y)},
                {"x_values", cells(map.x_values)},
                {"y_values", cells(map.y_values)},
                {"values", rows},
                {"log", map.log},
                {"unit", map.unit},
                {"note", figure.note}};
    if (!map.marks.empty()) out["marks"] = map.marks;
    if (!map.members.empty()) out["members"] = map.members;
    if (!map.classes.empty()) out["classes"] = map.classes;
    return out;
  }
  Json operator()(const ScatterMatrix& matrix) const {
    Json out = {{"kind", "scatter"}, {"title", figure.title}, {"columns", Json::array()}};
    for (const ScatterMatrix::Column& c : matrix.columns) {
      Json& column = out["columns"].emplace_back(
          Json{{"name", c.name}, {"unit", c.unit}, {"values", coordinates(c.values)}});
      if (!c.correlation.empty()) column["correlation"] = numbers(c.correlation);
    }
    out["members"] = matrix.members;
    if (!matrix.classes.empty()) {
      out["classes"] = matrix.classes;
      out["class"] = matrix.class_of;
    }
    out["note"] = figure.note;
    return out;
  }
  Json operator()(const Animation& animation) const {
    Json bodies = Json::array();
    for (const MovingBody& body : animation.bodies) bodies.push_back(body_of(body));
    Json out = {{"kind", "animation"},
                {"title", figure.title},
                {"view", animation.from_above ? "top" : "3d"},
                {"times", numbers(animation.times, kTimeDigits)},
                {"floor", animation.floor},
                {"bodies", bodies},
                {"note", figure.note}};
    for (const MovingForce& force : animation.forces) {
      Json values = Json::array();
      for (const auto& value : force.values) values.push_back(numbers(value));
      Json& drawn = out["forces"].emplace_back(Json{{"name", force.name}, {"values", values}});
      if (!force.modes.empty()) drawn["modes"] = numbers(force.modes);
      if (force.normals.empty()) continue;
      Json normals = Json::array();
      for (const Point& normal : force.normals) normals.push_back(numbers(normal));
      drawn["cone"] = {{"friction", number(force.friction)}, {"normals", normals}};
    }
    return out;
  }
};

}  // namespace

Json number(double value, int digits) {
  if (!std::isfinite(value)) return nullptr;
  return std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr);
}

Json numbers(std::span<const double> values, int digits) {
  Json out = Json::array();
  for (double v : values) out.push_back(number(v, digits));
  return out;
}

Json coordinates(std::span<const double> values) { return numbers(values, digits_of(values)); }

Json cells(const std::vector<Cell>& values) {
  Json out = Json::array();
  for (const Cell& cell : values) {
    if (!cell.is_number) out.push_back(cell.text);
    else if (std::isfinite(cell.number)) out.push_back(cell.number);
    else out.push_back(nullptr);
  }
  return out;
}

Json json_of(const Figure& figure) { return std::visit(Block{figure}, figure.drawing); }

std::string to_json(const std::vector<Figure>& figures) {
  Json out = Json::object();
  for (const Figure& figure : figures) out[figure.name] = json_of(figure);
  return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace hamel::figures
