// Contacts of a run that begin to slide, (5) of contact_dynamics.hpp.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/run/run/contacts/contact_kernel.hpp>

namespace hamel {
namespace {

// A slip that is this part of one that has grown has grown too.
constexpr double kGrownToo = 0.5;
// eps of (5) beside the slip at which it would make the error of a step.
constexpr double kEase = 1;
// A slip that turns slowly lags by less than this part of eps.
constexpr double kLags = 1e-3;

}  // namespace

// The slip of contact `first`, and of others that began with it, has grown.
void ContactKernel::grow(int first) {
  for (int i = 0; i < count(); ++i) {
    ContactState& state = contact(i);
    const Eigen::Vector2d s = dynamics().slip(i);
    if (i != first && !(state.begins && s.norm() > kGrownToo * grown(i))) continue;
    state.begins = false;
    if (s.norm() > 0) state.direction = s / s.norm();
  }
}

// eps^2 d'/a is a part of what a step may be off, for directions d that turn once in the run.
void ContactKernel::choose_ease(const ContactStates& before) {
  bool accelerated = false;
  for (int i = 0; i < count(); ++i) {
    ContactState& state = contact(i);
    if (!state.begins || state.mode != ContactMode::slides) continue;
    const ContactState& was = before[static_cast<size_t>(i)];
    if (was.begins && was.mode == ContactMode::slides) continue;
    state.ease = 0;
    if (!std::exchange(accelerated, true)) dynamics().accelerate(contacts_->states());
    const double left = std::abs(limit_ - time_), speed = followed(i).scale();
    const double way = std::isfinite(left) ? dynamics().friction_acceleration(i) * left : speed;
    state.ease = kEase * std::sqrt(setup_.errors.at(speed) * way);
    begun_[static_cast<size_t>(i)] = {.since = time_};
  }
}

// At the node: of a slip that begins the part that is not along its friction, s - |s| e.
void ContactKernel::follow_begun() {
  for (int i = 0; i < count(); ++i) {
    const ContactState& state = contact(i);
    if (!state.begins || state.mode != ContactMode::slides || !(state.ease > 0)) continue;
    Begun& begun = begun_[static_cast<size_t>(i)];
    const Eigen::Vector2d s = dynamics().slip(i);
    const Eigen::Vector2d e = s + state.ease * dynamics().first_direction(i);
    if (e.norm() > 0) begun.across = std::max(begun.across, (s - s.norm() / e.norm() * e).norm());
  }
}

// Notes a contact whose slip ends before it has grown, across its friction by more than the lag of
// (5), once.
void ContactKernel::end_begun(int i) {
  const auto& [since, across] = begun_[static_cast<size_t>(i)];
  if (!contact(i).begins || !(across > kLags * contact(i).ease)) return;
  const std::string said = fmt::format("slow slip: contact '{}'", dynamics().law(i).name);
  if (std::ranges::any_of(contacts_->notes,
                          [&](const std::string& note) { return note.starts_with(said); }))
    return;
  contacts_->notes.push_back(fmt::format(
      "{} slides from t = {:.10g} to {:.10g}, but no faster than {:.2g}: the direction of its "
      "friction there is left to the error of the run, and velocities behind it may be off by as "
      "much; a smaller tolerance, or the scheme nonsmooth, decides",
      said, since, time_, kGrown * contact(i).ease));
}

}  // namespace hamel
