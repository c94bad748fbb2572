// Switches of contacts in a run that is observed: their events, and what follows the energy.
#include <chrono>
#include <utility>

#include <hamel/framework/run/run/driver.hpp>

namespace hamel {

std::optional<ContactSwitch> Driver::take_switch() {
  if (plan_.contacts == nullptr || plan_.contacts->switches.empty()) return {};
  ContactSwitch out = std::move(plan_.contacts->switches.back());
  plan_.contacts->switches.clear();
  return out;
}

// Behind all that was before it; false: the run ends there.
bool Driver::observe_switch(const ContactSwitch& met) {
  plan_.contacts->look_back(false);
  bool stops = false;
  for (const auto& [name, time] : met.events) {
    result_.events.push_back(
        {name, time, met.before.coordinates, met.before.velocity, met.after.velocity});
    if (!stops && plan_.events->stops_at_switch(name)) {
      stops = true;
      result_.status.reason = "stopped at " + name;
    }
  }
  if (node_.step > 0) {
    if (recorder_ != nullptr) recorder_->impact(met.before, met.after);
    if (follower_ != nullptr) follower_->impact(met.before, met.after);
    if (plan_.events->any()) plan_.events->resume(met.after, "");
  }
  if (!stops) return true;
  result_.stopped_by_event = true;
  result_.last = met.after;
  if (plan_.recording && times_.empty()) {
    row_ = met.after;
    record(Clock::now());
  }
  return false;
}

}  // namespace hamel
