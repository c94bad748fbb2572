// The events of a run: functions of the state that cross zero, found in each step and located on
// the dense output.
//
// A bracket [t_k, t_{k+1}] in which an event changes its sign in its direction is narrowed to 1e-12
// of the step by the method of Alefeld, Potra and Shi (Boost.Math, toms748). An event that crosses
// twice within one step is looked for where a parabola through three nodes turns in the step or
// near it, below 0.8 of the values at the step's ends; one that varies faster than the steps is not
// seen. Source: Alefeld, Potra, Shi, Algorithm 748, ACM Trans. Math. Software 21 (1995).
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/run/record/result.hpp>
#include <hamel/framework/run/run/dense_output.hpp>
#include <hamel/framework/run/run/dip.hpp>

namespace hamel {

class Reactions;

class Events {
 public:
  /// Events of the system by name, and formulas of the state (event_formula.hpp): "x=1.5",
  /// "x^2+y^2=radius^2", "theta>1". Adds to mistakes what is no event. reactions: of the run, null
  /// without.
  Events(const SystemModel& system, std::shared_ptr<Reactions> reactions,
         const std::vector<std::string>& names, const std::vector<std::string>& stops,
         std::vector<std::string>& mistakes);
  bool any() const { return !watched_.empty(); }
  /// Does the run end where a contact switches with this name?
  bool stops_at_switch(const std::string& name) const {
    return std::ranges::find(switch_stops_, name) != switch_stops_.end();
  }

  /// At the start; adds to mistakes an event that is not finite there.
  void begin(const Snapshot& state, std::vector<std::string>& mistakes);
  /// After an event that changed the state: it is not met again at once.
  void resume(const Snapshot& state, const std::string& met);
  /// Events of the step that leads to `state`, by time, up to the first that stops the run.
  struct Found {
    Snapshot state;
    std::string name;
    bool stops;
  };
  Status look(const Snapshot& state, DenseOutput& dense, std::vector<Found>& found);
  /// The value of an event that is watched, which crosses 0 there.
  double value(const std::string& name, const Snapshot& state) const;
  /// Contacts that pull at the start already: there is no crossing to be found.
  std::vector<Found> lost_at_start(const Snapshot& state) const;

  template <class Archive>
  void serialize(Archive& archive) {
    for (Watched& w : watched_) archive(w.before, w.earlier);
    archive(time_, earlier_time_);
  }

 private:
  struct Watched {
    Event event;
    bool stops;
    int row = -1;       // of a contact, whose normal reaction is the value
    double before = 0;  // its value, of the last state where it was not 0
    // Its value at the node before that; NaN where there is none since it last jumped.
    double earlier = std::numeric_limits<double>::quiet_NaN();
    bool contact() const { return row >= 0; }
  };
  double value(const Watched& w, const Snapshot& state) const;
  // A look in the step to `now` at which the event has the other sign than at its ends.
  template <class Inside>
  std::optional<ValueAt> dip(const Watched& w, ValueAt now, const Inside& inside) const;
  // add(before, after): for each crossing in the step to `now`.
  template <class Inside, class Add>
  void crossings(const Watched& w, ValueAt now, const Inside& inside, const Add& add) const;
  bool watch_stated(const SystemModel& system, const std::vector<Event>& known,
                    const std::string& name, bool stop);
  void watch(const SystemModel& system, const std::vector<Event>& known, const std::string& name,
             bool stop, std::vector<std::string>& mistakes);

  std::vector<Watched> watched_;
  std::vector<std::string> switch_stops_;
  std::vector<int> contacts_;             // rows of the system's, watched or not
  std::shared_ptr<Reactions> reactions_;  // null where there are none
  double time_ = 0, earlier_time_ = 0;
};

/// Events of a system, its own and those of its contacts, without a value: "contact_lost", where
/// a normal reaction ceases to push; switches of a contact with a law, "contact.slides".
std::vector<Event> events_of(const SystemModel& system);

}  // namespace hamel
