// Assembly: balls that roll on, or inside, another body.
#include <cmath>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/assembly/assembly.hpp>

namespace hamel {

using namespace mechanisms;

RollingSurface Assembly::surface(const Mechanism::LoopPart& part) {
  RollingSurface out;
  const char* const how = part.inside ? "inside" : "on";
  const auto refuse = [&](const std::string& why) {
    wrong(part, part.kind, fmt::format("{}: {}", how, why));
    return out;
  };
  if (part.kind != "ball") return refuse("for a ball; this kind of contact touches the ground");
  if (part.both) return refuse("expected one of on and inside");
  check_friction(part, part.kind, part.contact);
  if (part.contact.load)
    wrong(part, part.kind, "load: that of a ball on another body is a reaction; leave it out");
  if (part.contact.friction && part.contact.unilateral && !*part.contact.unilateral)
    wrong(part, part.kind, "unilateral: a contact with friction may open; leave friction out");
  if (!(part.radius > 0) || !std::isfinite(part.radius)) {
    wrong(part, part.kind, fmt::format("radius: got {}, expected above 0", part.radius));
    return out;
  }
  out.inside = part.inside;
  out.ball = part.radius;
  for (const auto& body : parts_.bodies_) {
    if (body.name != part.a) continue;
    if (body.sphere > 0) {
      out.radius = body.sphere;
    } else if (body.cylinder.size() == 2) {
      out.radius = body.cylinder[0];
      out.axis = direction(body, "body", "axis", body.axis);
    } else {
      return refuse(fmt::format("expected a body with a sphere or a cylinder, got '{}'", part.a));
    }
    out.centre = vec(body.at);
    if (part.inside && !(out.radius > out.ball))
      return refuse(fmt::format("a ball of radius {:g} m has no room in '{}', of radius {:g} m",
                                out.ball, part.a, out.radius));
    const Vec3 w = vec(part.at) - out.centre;
    if (!((w - w.dot(out.axis) * out.axis).norm() > 1e-9 * out.radius))
      return refuse(fmt::format("its centre is that of '{}' as drawn", part.a));
    return out;
  }
  return out;
}

}  // namespace hamel
