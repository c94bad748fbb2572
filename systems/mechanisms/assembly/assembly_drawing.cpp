// Assembly: every part has a shape from its data.
#include <algorithm>
#include <cmath>
#include <iterator>

#include <hamel/systems/mechanisms/assembly/assembly.hpp>

namespace hamel {
namespace {

using namespace mechanisms;

Point point(const Vec3& v) { return {v[0], v[1], v[2]}; }

// Sizes that are no part's own are drawn so large in a mechanism of this extent, m, or a larger
// one.
constexpr double kUsual = 0.3;

// A shape of a contact at a place: smaller.
void shrink(BodyShape& shape, const Point& at, double by) {
  for (double& size : shape.sizes) size *= by;
  for (Point& corner : shape.points)
    for (size_t i = 0; i < 3; ++i) corner[i] = at[i] + by * (corner[i] - at[i]);
}

}  // namespace

// By which it is smaller than what is drawn in its usual size; 1 at most.
double Assembly::drawn_scale() const {
  Vec3 least = Vec3::Constant(HUGE_VAL), most = -least;
  const auto add = [&](const Point& at) {
    least = least.cwiseMin(vec(at));
    most = most.cwiseMax(vec(at));
  };
  for (const auto& body : parts_.bodies_) add(body.at);
  for (const auto& joint : parts_.joints_) add(joint.at);
  for (const auto& contact : parts_.contacts_) add(contact.at);
  double extent = (most - least).maxCoeff();
  for (const auto& body : parts_.bodies_) {
    extent = std::max({extent, 2 * body.sphere, vec(body.box).maxCoeff()});
    for (const double size : body.cylinder) extent = std::max(extent, size);
  }
  for (const auto& contact : parts_.contacts_)
    for (const auto& [name, values] : contact.values)
      if (name == "radius" && !values.empty()) extent = std::max(extent, 2 * values[0]);
  return extent > 0 ? std::min(1., extent / kUsual) : 1;
}

std::vector<BodyShape> Assembly::shapes_of(const Mechanism::BodyPart& body,
                                           const std::vector<Contact>& contacts) const {
  std::vector<BodyShape> out;
  if (body.sphere > 0) out.push_back(shapes::sphere(body.sphere));
  if (body.cylinder.size() == 2)
    out.push_back(shapes::cylinder(body.cylinder[0], body.cylinder[1], {.axis = body.axis}));
  if (!vec(body.box).isZero(0)) out.push_back(shapes::box(body.box));
  const auto from_centre = [&](const Point& at) { return point(vec(at) - vec(body.at)); };
  const double scale = drawn_scale();
  double size = 0.1 * scale;
  for (size_t i = 0; i < parts_.contacts_.size(); ++i) {
    const auto& contact = parts_.contacts_[i];
    if (contact.body != body.name) continue;
    const double drawn = body.cylinder.empty() ? body.sphere : body.cylinder[0];
    const ContactModel& model = *contacts[i].model;
    const double radius = model.radius();
    size = std::max(size, radius);
    if (radius > 0 && drawn == radius) {
      out.front().look.color = "dark";
      const std::vector<BodyShape> own = model.shapes(from_centre(contact.at));
      if (out.front().kind == "cylinder" && !own.empty() && own.front().kind == "wheel")
        out.front().kind = own.front().kind;
      continue;
    }
    std::vector<BodyShape> own = model.shapes(from_centre(contact.at));
    if (radius == 0)
      for (BodyShape& shape : own) shrink(shape, from_centre(contact.at), scale);
    std::ranges::move(own, std::back_inserter(out));
  }
  // Rods from the mass centre to its joints.
  for (const auto& joint : parts_.joints_) {
    if ((joint.child != body.name && joint.parent != body.name) || joint.parent == kWorld) continue;
    if (find_joint_kind(joint.kind)->joints == 0 || (vec(joint.at) - vec(body.at)).isZero(1e-12))
      continue;
    out.push_back(shapes::line({{0, 0, 0}, from_centre(joint.at)}));
  }
  if (out.empty()) out.push_back(shapes::sphere(0.3 * size));
  return out;
}

// A coupling of joints that one body carries: a line through them.
void Assembly::draw_couplings(const std::shared_ptr<Multibody>& system) {
  const Tree& tree = system->tree(system->drawn().data());
  for (const Coupling& coupling : system->all_rows().couplings) {
    std::vector<Point> points;
    int carrier = kGround;
    bool one_carrier = true;
    for (const size_t i : coupling.formula.used()) {
      int link = 0;
      if (i < coupling.links.size()) link = coupling.links[i];
      else
        while (tree.first(link) + tree.count(link) <=
               coupling.velocities[i - coupling.links.size()])
          ++link;
      if (tree.joint(link).dim() != 1 || tree.link(link).is_state) continue;
      if (!points.empty()) one_carrier = one_carrier && tree.parent(link) == carrier;
      carrier = tree.parent(link);
      points.push_back(point(tree.link(link).on_child.position));
    }
    if (coupling.affine || points.size() < 2 || !one_carrier) continue;
    model_.drawing.bodies.push_back({coupling.name,
                                     [system, carrier](std::span<const double> coordinates) {
                                       std::vector<double> g(system->drawn().size());
                                       system->geometry().from_coordinates(coordinates, g.data());
                                       const Rigid place = system->tree(g.data()).in_world(carrier);
                                       return Placement{place.position, place.rotation};
                                     },
                                     {shapes::line(points, {.color = "accent"})}});
  }
}

// Bodies are seen in the axes of the drawn pose, their mass centres as origins.
void Assembly::draw(const std::shared_ptr<Multibody>& system) {
  Drawing& drawing = model_.drawing;
  drawing.has_floor = !parts_.ground_height_;
  if (parts_.ground_height_) draw_ground(*system->all_rows().ground.height);
  const std::vector<Contact>& contacts = system->all_rows().contacts;
  for (const auto& body : parts_.bodies_) {
    const int link = body_links_.at(body.name);
    DrawnBody drawn{body.name,
                    [system, link, centre = vec(body.at)](std::span<const double> coordinates) {
                      std::vector<double> g(system->drawn().size());
                      system->geometry().from_coordinates(coordinates, g.data());
                      const Rigid place = system->tree(g.data()).in_world(link);
                      return Placement{place.apply(centre), place.rotation};
                    },
                    shapes_of(body, contacts)};
    if (link >= 0 && links_[static_cast<size_t>(link)].parent == mechanisms::kGround) drawn.trail();
    drawing.bodies.push_back(std::move(drawn));
  }
  draw_couplings(system);
  const auto draw_reaction = [&](const std::string& part, auto touch) {
    model_.forces.push_back({part, [system, part, touch](std::span<const double> coordinates,
                                                         std::span<const double> reactions) {
                               std::vector<double> g(system->drawn().size());
                               system->geometry().from_coordinates(coordinates, g.data());
                               const Vec3 at = touch(system->all_rows(), system->tree(g.data()));
                               return std::pair{at, system->reaction(part, g.data(), reactions)};
                             }});
  };
  for (size_t i = 0; i < parts_.contacts_.size(); ++i)
    draw_reaction(parts_.contacts_[i].name, [i](const ConstraintRows& rows, const Tree& tree) {
      return rows.touch(rows.contacts[i], tree);
    });
  for (size_t i = 0; i < parts_.loops_.size(); ++i)
    if (parts_.loops_[i].kind != "loop")
      draw_reaction(parts_.loops_[i].name, [i](const ConstraintRows& rows, const Tree& tree) {
        return rows.loops[i].touch(tree);
      });
}

}  // namespace hamel
