#include <hamel/systems/straight_starts.hpp>

#include <numbers>

#include <hamel/framework/run/run/at_speed.hpp>
#include <hamel/systems/falling_disk.hpp>
#include <hamel/systems/segway.hpp>

namespace hamel {
namespace {

// The struct with the parameters of the model.
template <class S>
S typed(const SystemModel& model) {
  Parameters values;
  for (const Field& field : model.fields) values[field.name] = field.value;
  S system;
  detail::FieldWriter writer{values};
  system.fields(writer);
  return system;
}

}  // namespace

void add_starts_at_speed() {
  add_start_at_speed(FallingDisk::name(), [](const SystemModel& model, double speed) {
    const auto disk = typed<FallingDisk>(model);
    return disk.rolling(0.5 * std::numbers::pi, {0, 0, speed / disk.radius});
  });
  add_start_at_speed(Segway::name(), [](const SystemModel& model, double speed) {
    return typed<Segway>(model).rolling(0, 0, speed);
  });
}

}  // namespace hamel
