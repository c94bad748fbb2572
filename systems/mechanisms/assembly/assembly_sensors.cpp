// Assembly: sensors at points of bodies.
#include <algorithm>
#include <set>

#include <fmt/format.h>

#include <hamel/framework/mechanics/output_formulas.hpp>
#include <hamel/systems/mechanisms/assembly/assembly.hpp>

namespace hamel {

using namespace mechanisms;

namespace {

// In the order of programs/sensor_formulas.hpp.
constexpr std::pair<const char*, const char*> kMeasured[] = {
    {"x", "m"},    {"y", "m"},     {"z", "m"},      {"vx", "m/s"},   {"vy", "m/s"},
    {"vz", "m/s"}, {"yaw", "rad"}, {"ax", "m/s^2"}, {"ay", "m/s^2"}, {"az", "m/s^2"}};
constexpr size_t kFirstAcceleration = 7;
constexpr int kFirstVelocity = 3;

}  // namespace

void Assembly::sense(const Multibody& system) {
  std::set<std::string> taken(model_.group.columns.begin(), model_.group.columns.end());
  taken.insert(model_.rates.begin(), model_.rates.end());
  taken.insert(model_.reactions.begin(), model_.reactions.end());
  for (const auto& part : parts_.sensors_) {
    const int link = link_of(part, "sensor", part.body);
    Sensor sensor{
        part.name,
        fmt::format("place, velocity, yaw, acceleration and path of a point of '{}'", part.body),
        {},
        {},
        kFirstAcceleration,
        kFirstVelocity,
        {}};
    for (const auto& [name, unit] : kMeasured) {
      sensor.columns.push_back(part.name + "." + name);
      sensor.units.emplace_back(unit);
      if (!taken.insert(sensor.columns.back()).second)
        wrong(part, "sensor", fmt::format("the name '{}' is taken", sensor.columns.back()));
    }
    if (!taken.insert(path_column(sensor)).second)
      wrong(part, "sensor", fmt::format("the name '{}' is taken", path_column(sensor)));
    sensor.value = system.sensor(link, vec(part.at));
    model_.sensors.push_back(std::move(sensor));
  }
}

void Assembly::add_outputs() {
  for (const auto& part : parts_.outputs_)
    model_.outputs.push_back({part.name, part.formula, part.unit, part.meaning, part.where});
  const std::vector<std::string> wrong = output_mistakes(model_);
  mistakes_.insert(mistakes_.end(), wrong.begin(), wrong.end());
}

}  // namespace hamel
