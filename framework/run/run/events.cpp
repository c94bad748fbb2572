#include <hamel/framework/run/run/events.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <boost/math/tools/toms748_solve.hpp>

#include <hamel/framework/mechanics/quantity_names.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/data/event_formula.hpp>
#include <hamel/framework/run/run/rows/reactions.hpp>

namespace hamel {
namespace {

// Where a parabola turns above this part of the lower end of a step, the event turns far from 0.
constexpr double kTurnsFar = 0.8;

// "2_x1=1.5": columns whose names no formula may have, too.
std::optional<Event> plane(const SystemModel& system, const std::string& text) {
  const size_t equal = text.find('=');
  if (equal == std::string::npos) return {};
  const auto place = QuantityNames(system).find(text.substr(0, equal));
  const char* const last = text.data() + text.size();
  double value = 0;
  const auto [end, error] = std::from_chars(text.data() + equal + 1, last, value);
  if (!place || *place >= system.group.columns.size() || error != std::errc() || end != last)
    return {};
  return Event{text, "this column crosses this value", 0,
               [i = *place, value](double, std::span<const double> g, std::span<const double>) {
                 return g[i] - value;
               }};
}

// The time behind the crossing of zero between two ends of opposite sign, the later one's side of
// the bracket.
template <class Inside>
double crossing_time(const Inside& inside, ValueAt before, ValueAt now) {
  const auto value = [&](double t) {
    return t == before.time ? before.value : t == now.time ? now.value : inside(t);
  };
  const double width = 1e-12 * std::abs(now.time - before.time);
  std::uintmax_t most = 100;
  const bool forward = now.time > before.time;
  const ValueAt low = forward ? before : now, high = forward ? now : before;
  const auto [a, b] = boost::math::tools::toms748_solve(
      value, low.time, high.time, low.value, high.value,
      [width](double x, double y) { return std::abs(y - x) <= width; }, most);
  return forward ? b : a;
}

// The ones of a step in order of time, up to the first that ends the run.
void sort_and_cut(std::vector<Events::Found>& found, double sign) {
  std::stable_sort(found.begin(), found.end(),
                   [sign](const Events::Found& a, const Events::Found& b) {
                     return sign * a.state.time < sign * b.state.time;
                   });
  const auto stop =
      std::find_if(found.begin(), found.end(), [](const Events::Found& f) { return f.stops; });
  if (stop != found.end()) found.erase(stop + 1, found.end());
}

}  // namespace

std::vector<Event> events_of(const SystemModel& system) {
  std::vector<Event> out = system.events;
  for (const int row : system.contacts) {
    std::string name = "contact_lost";
    if (!system.reactions.empty()) {  // front.reaction3 -> front.contact_lost
      const std::string& reaction = system.reactions[static_cast<size_t>(row)];
      name = reaction.substr(0, reaction.rfind('.') + 1) + name;
    } else if (system.contacts.size() > 1) {
      name += std::to_string(row + 1);
    }
    out.push_back({name, "the normal reaction ceases to push", -1, {}});
  }
  for (const ContactLaw& law : system.contact_laws) {
    const auto add = [&](const char* what, const char* meaning) {
      out.push_back({law.name + "." + what, meaning, 0, {}});
    };
    if (law.friction > 0 || !law.of_joint) {
      add(law.slides_name(), law.of_joint ? "the joint begins to move" : "it begins to slide");
      add(law.rolls_name(), law.of_joint ? "the joint ceases to move" : "it ceases to slide");
    }
    if (!law.normal) continue;
    add("opens", "it opens");
    add("strikes", "it closes with an impact");
  }
  return out;
}

Events::Events(const SystemModel& system, std::shared_ptr<Reactions> reactions,
               const std::vector<std::string>& names, const std::vector<std::string>& stops,
               std::vector<std::string>& mistakes)
    : contacts_(system.contacts), reactions_(std::move(reactions)) {
  const std::vector<Event> known = events_of(system);
  for (const std::string& name : names) watch(system, known, name, false, mistakes);
  for (const std::string& name : stops) watch(system, known, name, true, mistakes);
}

// An event that is stated. False where the name is none's, or its reaction is not at hand.
bool Events::watch_stated(const SystemModel& system, const std::vector<Event>& known,
                          const std::string& name, bool stop) {
  const auto found = std::ranges::find(known, name, &Event::name);
  if (found == known.end()) return false;
  const auto i = static_cast<size_t>(found - known.begin());
  const size_t contacts_end = system.events.size() + contacts_.size();
  if (i >= contacts_end) {  // which the contacts of the run find
    if (stop) switch_stops_.push_back(name);
  } else if (i < system.events.size()) {
    watched_.push_back({known[i], stop});
  } else if (reactions_ == nullptr) {
    return false;
  } else {
    watched_.push_back({known[i], stop, contacts_[i - system.events.size()]});
  }
  return true;
}

void Events::watch(const SystemModel& system, const std::vector<Event>& known,
                   const std::string& name, bool stop, std::vector<std::string>& mistakes) {
  const auto same =
      std::ranges::find_if(watched_, [&name](const Watched& w) { return w.event.name == name; });
  if (same != watched_.end()) {
    same->stops = same->stops || stop;
    return;
  }
  if (watch_stated(system, known, name, stop)) return;
  const size_t before = mistakes.size();
  std::optional<Event> event = plane(system, name);
  if (!event) event = event_of_formula(system, name, mistakes);
  const std::string_view option = "events";
  for (size_t i = before; i < mistakes.size() && stop; ++i)
    if (mistakes[i].starts_with(option)) mistakes[i].replace(0, option.size(), "stop_at");
  if (event) watched_.push_back({std::move(*event), stop});
  if (event || mistakes.size() > before) return;
  std::vector<std::string> offered;
  for (const Event& e : known) offered.push_back(e.name);
  offered.emplace_back("FORMULA=FORMULA (or <, >)");
  mistakes.push_back(unknown_name("event of " + system.name, name, offered));
}

double Events::value(const Watched& w, const Snapshot& state) const {
  if (w.contact()) return reactions_->at(state)[w.row];
  return w.event.value(state.time, state.coordinates, state.velocity);
}

double Events::value(const std::string& name, const Snapshot& state) const {
  const auto found =
      std::ranges::find_if(watched_, [&name](const Watched& w) { return w.event.name == name; });
  return found == watched_.end() ? std::numeric_limits<double>::quiet_NaN() : value(*found, state);
}

void Events::begin(const Snapshot& state, std::vector<std::string>& mistakes) {
  time_ = state.time;
  for (Watched& w : watched_) {
    w.before = value(w, state);
    if (!std::isfinite(w.before))
      mistakes.push_back(fmt::format("{}: {} is {} at the start", w.stops ? "stop_at" : "events",
                                     w.event.name, w.before));
  }
}

std::vector<Events::Found> Events::lost_at_start(const Snapshot& state) const {
  std::vector<Found> out;
  for (const Watched& w : watched_) {
    if (!w.contact()) continue;
    double largest = 0;
    for (const int row : contacts_)
      largest = std::max(largest, std::abs(reactions_->at(state)[row]));
    if (value(w, state) < -1e-9 * largest) out.push_back({state, w.event.name, w.stops});
  }
  return out;
}

void Events::resume(const Snapshot& state, const std::string& met) {
  time_ = state.time;
  for (Watched& w : watched_) {
    w.before = w.event.name == met ? 0 : value(w, state);
    w.earlier = std::numeric_limits<double>::quiet_NaN();
  }
}

// The middle of the step is looked at where nodes do not show that the event turns elsewhere, or
// far from 0.
template <class Inside>
std::optional<ValueAt> Events::dip(const Watched& w, ValueAt now, const Inside& inside) const {
  const double sign = w.before > 0 ? 1 : -1, h = now.time - time_;
  const ValueAt before = {time_, std::abs(w.before)}, end = {now.time, std::abs(now.value)};
  if (std::isfinite(w.earlier)) {
    const Parabola p({earlier_time_, sign * w.earlier}, before, end);
    const double part = (p.time - time_) / h;
    const bool turns = p.curvature > 0 && part > -0.5 && part < 1.5;
    if (!turns || p.least > kTurnsFar * std::min(before.value, end.value)) return {};
  }
  const auto value = [&](double t) { return sign * inside(t); };
  const ValueAt middle = {time_ + h / 2, value(time_ + h / 2)};
  if (middle.value < 0) return middle;
  const auto least = find_dip(value, before, middle, end);
  return least && least->value < 0 ? least : std::nullopt;
}

template <class Inside, class Add>
void Events::crossings(const Watched& w, ValueAt now, const Inside& inside, const Add& add) const {
  const ValueAt before = {time_, w.before};
  if (before.value * now.value < 0 || (now.value == 0 && before.value != 0)) add(before, now);
  if (!(before.value * now.value > 0)) return;
  if (const auto least = dip(w, now, inside)) {
    const ValueAt other = {least->time, std::copysign(least->value, -before.value)};
    add(before, other);
    add(other, now);
  }
}

Status Events::look(const Snapshot& state, DenseOutput& dense, std::vector<Found>& found) {
  found.clear();
  Status status;
  Snapshot at;
  double shown = std::numeric_limits<double>::quiet_NaN();  // the time of that state
  const auto show = [&](double t) {  // where several events look at one time: once
    if (t == shown) return true;
    if (const Status there = dense.at(t, at); !there.ok) status = there;
    shown = status.ok ? t : std::numeric_limits<double>::quiet_NaN();
    return status.ok;
  };
  const double forward = state.time >= time_ ? 1 : -1;
  for (Watched& w : watched_) {
    const auto inside = [&](double t) {
      show(t);
      return value(w, at);
    };
    // Direction of the change in time, also in a run back; a contact that pulls ends either run.
    const double direction = w.contact() ? w.event.direction : forward * w.event.direction;
    const auto add = [&](ValueAt before, ValueAt now) {
      if (before.value * direction > 0) return;
      const double crossing = now.value == 0 ? now.time : crossing_time(inside, before, now);
      if (!status.ok) return;
      if (show(crossing)) found.push_back({at, w.event.name, w.stops});
    };
    const ValueAt now = {state.time, value(w, state)};
    crossings(w, now, inside, add);
    if (!status.ok) return status;
    w.earlier = w.before != 0 ? w.before : std::numeric_limits<double>::quiet_NaN();
    w.before = now.value != 0 ? now.value : -w.before;
  }
  sort_and_cut(found, forward);
  earlier_time_ = time_;
  time_ = state.time;
  return status;
}

}  // namespace hamel
