// Assembly: ground with a height.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/assembly/assembly.hpp>

namespace hamel {

using namespace mechanisms;

Ground Assembly::ground() {
  Ground out{parts_.ground_rate_, vec(parts_.ground_velocity_)};
  if (!parts_.ground_height_) return out;
  const auto& part = *parts_.ground_height_;
  if (out.moves())
    wrong(part, "ground", "height: expected a ground at rest, without rate, velocity");
  std::map<std::string, double> constants;
  for (const auto& [name, value] : part.constants)
    if (name != "x" && name != "y") constants.emplace(name, value.front());
  try {
    out.height.emplace(part.name, std::vector<std::string>{"x", "y"}, constants);
    if (out.height->may_jump())
      wrong(part, "ground", "height: expected a formula that cannot jump");
  } catch (const ExpressionError& error) {
    wrong(part, "ground", fmt::format("height: {}", error.what()));
  }
  return out;
}

void Assembly::check_feet(ConstraintRows rows, Tree tree) {
  if (!rows.ground.height) return;
  rows.find_links(tree);
  tree.place(tree.drawn().data());
  for (size_t i = 0; i < rows.contacts.size(); ++i) {
    const Contact& contact = rows.contacts[i];
    if (contact.model->foot(contact, tree, rows.ground).allFinite()) continue;
    const auto& part = parts_.contacts_[i];
    wrong(
        part, part.kind,
        fmt::format("the ground below ({}) is steeper or more sharply curved than this contact can "
                    "touch at one point",
                    join(part.at)));
  }
}

// Lines along x and y: several times as far as the mechanism is large, and some turns of what
// rolls.
void Assembly::draw_ground(const Expression& height) {
  constexpr int lines = 24, points = 96;
  double far = 6 * extent_;
  for (const auto& contact : parts_.contacts_)
    for (const char* const length : {"radius", "semi_axes"})
      if (const auto of = contact.values.find(length); of != contact.values.end())
        for (const double x : of->second) far = std::max(far, 60 * x);
  std::vector<BodyShape> out;
  for (const bool along_x : {true, false}) {
    for (int i = 0; i <= lines; ++i) {
      std::vector<Point> line;
      for (int k = 0; k <= points; ++k) {
        const double u = far * (2.0 * k / points - 1), v = far * (2.0 * i / lines - 1),
                     x = along_x ? u : v, y = along_x ? v : u, z = height(std::array{x, y});
        if (std::isfinite(z)) line.push_back({x, y, z});
      }
      if (line.size() > 1) out.push_back(shapes::line(line, {.color = "light"}));
    }
  }
  model_.drawing.bodies.push_back({"ground",
                                   [](std::span<const double>) {
                                     return Placement{Vec3::Zero(), Mat<3, 3>::Identity()};
                                   },
                                   std::move(out)});
}

}  // namespace hamel
