#include <hamel/framework/run/run/at_speed.hpp>

#include <map>
#include <utility>

#include <hamel/framework/mechanics/motion_words.hpp>

namespace hamel {
namespace {

std::map<std::string, StartAtSpeed>& starts() {
  static std::map<std::string, StartAtSpeed> all;
  return all;
}

}  // namespace

void add_start_at_speed(const std::string& system, StartAtSpeed start) {
  starts()[system] = std::move(start);
}

std::optional<Start> start_at_speed(const SystemModel& model, double speed, double t) {
  if (const auto it = starts().find(model.name); it != starts().end())
    return it->second(model, speed);
  const MotionWords& words = words_of(model);
  if (!words.start_at_speed) return {};
  return words.start_at_speed(speed, t);
}

}  // namespace hamel
