#include <hamel/systems/mechanisms/programs/sensor_formulas.hpp>

#include <string>

#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/systems/mechanisms/programs/recorded_mechanism.hpp>

namespace hamel::mechanisms {

FilledProgram record_sensor(const MechanismParts& parts, int link, const Vec3& at) {
  const RecordedMechanism mechanism(parts);
  const BodyFormulas& bodies = mechanism.bodies;
  std::vector<Number> moving = mechanism.g, rates = bodies.element_rates();
  for (size_t i = 0; i < mechanism.xi.size(); ++i) {
    moving.push_back(mechanism.xi[i]);
    rates.push_back(mechanism.recording()->input("rate of xi" + std::to_string(i + 1)));
  }
  const Pose& root = bodies.root_in_world(link);
  const NumberVec3 point = bodies.point(link, at), place = root.apply(point);
  const NumberVec3 ahead = root.turn(bodies.direction(link, Vec3::UnitX()));
  const std::vector<Number> x(place.begin(), place.end());
  const std::vector<Number> v = graph::along(x, moving, rates);
  const std::vector<Number> a = graph::along(v, moving, rates);
  std::vector<Number> out = x;
  out.insert(out.end(), v.begin(), v.end());
  out.push_back(atan2(ahead[1], ahead[0]));
  out.insert(out.end(), a.begin(), a.end());
  return {mechanism.recording(), out};
}

}  // namespace hamel::mechanisms
