#include <hamel/systems/at_speed.hpp>

#include <numbers>

#include <hamel/framework/mechanics/motion_words.hpp>
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

std::optional<Start> start_at_speed(const SystemModel& model, double speed) {
  if (model.name == FallingDisk::name()) {
    const auto disk = typed<FallingDisk>(model);
    return disk.rolling(0.5 * std::numbers::pi, {0, 0, speed / disk.radius});
  }
  if (model.name == Segway::name()) return typed<Segway>(model).rolling(0, 0, speed);
  const MotionWords& words = words_of(model);
  if (words.start_parameters.empty() || words.start_parameters[0] != "speed") return {};
  return words.start_from(std::vector<double>{speed});
}

}  // namespace hamel
