// The drawing of a system along the rows of a result, for hamel/_animation.py.
#include <Eigen/Geometry>

#include <hamel/framework/mechanics/system_model.hpp>

#include "bindings.hpp"

namespace hamel::python {
namespace {

nb::dict shape(const BodyShape& s) {
  nb::dict out;
  out["shape"] = s.kind;
  out["color"] = s.look.color;
  out["at"] = s.look.at;
  out["axis"] = s.look.axis;
  out["sizes"] = s.sizes;
  out["points"] = s.points;
  return out;
}

}  // namespace

nb::dict motion(StoredResult& stored, size_t most) {
  stored.restore_system();
  const Result& result = stored.result;
  const Drawing& drawing = result.system->drawing;
  const Trajectory& rows = result.trajectory;
  std::vector<size_t> shown;
  const size_t step = std::max<size_t>(rows.rows() / std::max<size_t>(most, 1), 1);
  for (size_t i = 0; i < rows.rows(); i += step) shown.push_back(i);
  nb::dict out;
  std::vector<double> times;
  for (const size_t i : shown) times.push_back(rows.at(i, 0));
  out["times"] = times;
  out["from_above"] = drawing.from_above;
  out["floor"] = drawing.has_floor;
  nb::list bodies;
  for (const DrawnBody& drawn : drawing.bodies) {
    std::vector<std::array<double, 7>> poses;
    for (const size_t i : shown) {
      const Placement at = drawn.place(rows.row(i).subspan(1, result.system->group.columns.size()));
      const Eigen::Quaterniond q(at.rotation);
      poses.push_back({at.position[0], at.position[1], at.position[2], q.w(), q.x(), q.y(), q.z()});
    }
    nb::dict body;
    body["name"] = drawn.name;
    body["poses"] = poses;
    nb::list shapes;
    for (const BodyShape& s : drawn.shapes) shapes.append(shape(s));
    body["shapes"] = shapes;
    body["trail"] = drawn.has_trail;
    body["trail_point"] = drawn.trail_point;
    bodies.append(body);
  }
  out["bodies"] = bodies;
  return out;
}

}  // namespace hamel::python
