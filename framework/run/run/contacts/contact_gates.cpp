// Gates of contacts along the last step, and the first that crosses 0.
//
// A step is looked at in five parts; a crossing is located to round-off by the method of Alefeld,
// Potra and Shi, as in events.hpp, and where a gate has a minimum between two looks a parabola
// finds whether it dips below 0.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <boost/math/tools/toms748_solve.hpp>

#include <hamel/framework/run/run/contacts/contact_kernel.hpp>

namespace hamel {
namespace {

constexpr double kNoGate = std::numeric_limits<double>::infinity();
constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();
constexpr size_t kParts = 5;
// A slip of this part of the velocities of the run is none; sigma.
constexpr double kSmallSlip = 1e-10, kSigma = 1e-7;
// A change of a gate in a step, as a part of it, that needs no second look.
constexpr double kLittle = 0.1;
// A velocity that is this part of what forces alone would do in a step is that of rest.
constexpr double kAtRest = 1e-6;
// A reaction outside its cone by this part of the largest is no round-off.
constexpr double kPulls = 1e-6;
// A gap that turns at less than this part of its largest value grazes.
constexpr double kGrazes = 1e-9;

}  // namespace

void ContactKernel::evaluate(const Snapshot& state) {
  std::copy(state.element.begin(), state.element.end(), g_.data());
  xi_ = Eigen::Map<const Eigen::VectorXd>(state.velocity.data(),
                                          static_cast<Eigen::Index>(state.velocity.size()));
  dynamics().evaluate(state.time, g_.data(), xi_);
}

// At the node: scales of velocities and directions of slip, and the gates.
void ContactKernel::evaluate_node() {
  if (rolls_on_) return;
  gates(now_->time(), at_node_);
  rolled_ = false;
  follow_begun();
  follow_speeds();
  find_held();
  // The gates of slips along the directions that they have now: those of the last node may be
  // opposite, so that a slip would seem to have ended already.
  for (int i = 0; i < count(); ++i) {
    double& slip = at_node_[static_cast<size_t>(i)][1];
    if (contact(i).mode != ContactMode::slides || contact(i).begins || !std::isfinite(slip))
      continue;
    slip = slip_left(i);
  }
}

// Open contacts whose heights others hold at 0 (four wheels, of which one bears nothing): their
// gates are what these heights would be if contacts gave way.
void ContactKernel::find_held() {
  for (int i = 0; i < count(); ++i) {
    followed(i).held = false;
    if (contact(i).mode != ContactMode::open || !(std::abs(dynamics().gap(i)) < kClosedGap))
      continue;
    const std::optional<double> height = dynamics().height_of_held(contacts_->states(), i);
    followed(i).held = height.has_value();
    if (height) at_node_[static_cast<size_t>(i)][0] = *height;
  }
}

// Above what it would end at, too.
double ContactKernel::grown(int i) const {
  return std::max(kGrown * contact(i).ease, 10 * kSigma * followed(i).scale());
}

// A slip that is small already, behind the end of another, ends at less.
double ContactKernel::slip_left(int i) {
  const auto& [reference, least] = slips_[static_cast<size_t>(i)];
  return dynamics().slip(i).dot(reference) - least;
}

void ContactKernel::follow_speeds() {
  for (int i = 0; i < count(); ++i) {
    FollowedContact& follows = followed(i);
    follows.speed = std::max(follows.speed, dynamics().speed_scale(i));
    if (!(follows.speed > follows.rest))
      follows.rest = kAtRest * dynamics().acceleration_scale(i) * std::abs(now_->next_step());
    contact(i).no_slip = kSmallSlip * follows.scale();
    const Eigen::Vector2d s = dynamics().slip(i);
    auto& [reference, least] = slips_[static_cast<size_t>(i)];
    const bool slips = dynamics().slips(contact(i), i);
    least = kSigma * follows.scale();
    if (slips && s.norm() <= least) least = s.norm() / 2;
    if (contact(i).begins && contact(i).mode == ContactMode::slides)
      take_direction(i, dynamics().first_direction(i));
    reference = slips ? Eigen::Vector2d(s / s.norm()) : contact(i).direction;
    if (!slips || contact(i).begins || contact(i).mode != ContactMode::slides) continue;
    take_direction(i, reference);
  }
}

void ContactKernel::take_direction(int i, const Eigen::Vector2d& direction) {
  contact(i).direction = direction;
  (*now_states_)[static_cast<size_t>(i)].direction = direction;
}

// A contact that slides with a coefficient that is not positive has no motion, or several.
std::string ContactKernel::why_no_node() {
  for (int i = 0; i < count(); ++i) {
    if (contact(i).mode != ContactMode::slides || !dynamics().law(i).normal) continue;
    const double coefficient = dynamics().coefficient(i);
    if (coefficient > 0) continue;
    return fmt::format(
        "painleve: contact '{}' slides at t = {:.10g} with a coefficient of its normal reaction of "
        "{:.4g}, not positive, with friction = {}: rigid bodies have no unique motion here; a "
        "smaller friction has",
        dynamics().law(i).name, now_->time(), coefficient, dynamics().law(i).friction);
  }
  return "";
}

// The state at a time of the last step into snapshot_.
void ContactKernel::look_at(double t, bool near) {
  static constexpr StateParts place = {
      .coordinates = false, .momentum = false, .energy = false, .measures = false};
  if (t == now_->time()) now_->state(snapshot_, place);
  else if (!near || !now_->motion_within(t, snapshot_)) now_->interpolate(t, snapshot_);
}

void ContactKernel::rolling_gates(double t, Gates& out, bool near) {
  look_at(t, near);
  std::copy(snapshot_.element.begin(), snapshot_.element.end(), g_.data());
  xi_ = Eigen::Map<const Eigen::VectorXd>(snapshot_.velocity.data(), xi_.size());
  all_rolls_->solve(t, g_, xi_);
  const Eigen::VectorXd& reaction = all_rolls_->reaction();
  out.resize(static_cast<size_t>(count()));
  for (int i = 0; i < count(); ++i) {
    auto& [first, second, third] = out[static_cast<size_t>(i)];
    const ContactLaw& law = dynamics().law(i);
    first = law.normal ? reaction[*law.normal] : kNoGate;
    second = third = kNoGate;
    if (law.tangential.empty()) continue;
    double squares = 0;
    for (const int row : law.tangential) squares += reaction[row] * reaction[row];
    second = law.holding() * (law.normal ? first : law.load) - std::sqrt(squares);
  }
}

void ContactKernel::gates(double t, Gates& out, bool near) {
  look_at(t, near);
  evaluate(snapshot_);
  dynamics().accelerate(contacts_->states());
  out.assign(static_cast<size_t>(count()), {kNoGate, kNoGate, kNoGate});
  for (int i = 0; i < count(); ++i) {
    auto& [first, second, third] = out[static_cast<size_t>(i)];
    const ContactLaw& law = dynamics().law(i);
    const ContactMode mode = contact(i).mode;
    const double opened = followed(i).opened;
    if (mode == ContactMode::open) {
      if (!law.normal) continue;
      if (followed(i).held) {
        first = dynamics().height_of_held(contacts_->states(), i).value_or(kNoGate);
        continue;
      }
      first = dynamics().gap(i);
      followed(i).height = std::max(followed(i).height, first);
      if (t == opened) first = std::max(dynamics().gap_rate(i), 1e-300);
      else if (opened > -1e299) first /= std::abs(t - opened);
      continue;
    }
    if (law.normal) first = dynamics().normal_reaction(i);
    if (law.tangential.empty()) continue;
    if (mode == ContactMode::rolls) second = dynamics().hold_left(i);
    else if (contact(i).begins) {
      second = grown(i) - dynamics().slip(i).norm();
      third = dynamics().slip(i).dot(contact(i).direction) + kSigma * followed(i).scale();
    } else if (law.friction > 0) second = slip_left(i);
  }
}

ContactKernel::Switch ContactKernel::switch_of(int i, size_t gate) const {
  const ContactMode mode = contact(i).mode;
  if (mode == ContactMode::open) return followed(i).held ? Switch::bears : Switch::strikes;
  if (gate == 0) return Switch::opens;
  if (mode == ContactMode::rolls) return Switch::slides;
  return contact(i).begins && gate == 1 ? Switch::grows : Switch::stops;
}

// At the node, to which a step was taken again: a contact that has nearly ceased to slip.
std::optional<ContactKernel::Found> ContactKernel::stop_found() {
  gates(now_->time(), one_);
  const Gates& here = one_;
  for (int i = 0; i < count(); ++i) {
    if (contact(i).mode != ContactMode::slides || contact(i).begins) continue;
    if (here[static_cast<size_t>(i)][1] <= slips_.at(static_cast<size_t>(i)).least)
      return Found{now_->time(), i, Switch::stops};
  }
  return {};
}

double ContactKernel::gate(int contact, size_t which, double t) {
  gates(t, one_);
  return one_[static_cast<size_t>(contact)][which];
}

// Between two times with values of either sign, which a look leaves open by the error of the step.
double ContactKernel::locate(int contact, size_t which, ValueAt before, ValueAt after) {
  if (before.time > now_->beginning_time()) before.value = gate(contact, which, before.time);
  if (after.time < now_->time()) after.value = gate(contact, which, after.time);
  if (!(before.value >= 0)) return before.time;
  if (!(after.value < 0)) return after.time;
  const auto inside = [&](double t) {
    if (t == before.time) return before.value;
    if (t == after.time) return after.value;
    return gate(contact, which, t);
  };
  std::uintmax_t most = 200;
  const double width = 4e-16 * std::max(std::abs(after.time), std::abs(after.time - before.time));
  return boost::math::tools::toms748_solve(
             inside, before.time, after.time, before.value, after.value,
             [width](double x, double y) { return std::abs(y - x) <= width; }, most)
      .second;
}

// Notes a contact that comes this near and does not strike, once.
void ContactKernel::graze(int i, double t) {
  if (contact(i).mode != ContactMode::open || followed(i).held) return;
  gates(t, one_);
  const double gap = dynamics().gap(i);
  const std::string said = fmt::format("grazing: contact '{}'", dynamics().law(i).name);
  if (!(gap < kGrazes * followed(i).height) ||
      std::ranges::any_of(contacts_->notes,
                          [&](const std::string& note) { return note.starts_with(said); }))
    return;
  contacts_->notes.push_back(
      fmt::format("{} comes within {:.2g} at t = {:.10g} and does not strike: whether it does is "
                  "left to the error of the run",
                  said, gap, t));
}

// Is a dip behind an opening the round-off of a gap that begins with its third derivative, as of a
// ball that leaves a dome?
bool ContactKernel::leaves(int i, double opened, double dip) {
  if (contact(i).mode != ContactMode::open || followed(i).held || followed(i).opened != opened)
    return false;
  gates(dip, one_);
  return dynamics().gap(i) > -kGrazes * followed(i).height;
}

// A gate's crossing between the last two of three looks, the first of them NaN where there are two:
// a change of its sign, or a dip.
std::optional<double> ContactKernel::crossing(int contact, size_t which, ValueAt first,
                                              ValueAt before, ValueAt now) {
  if (before.value >= 0 && now.value < 0) return locate(contact, which, before, now);
  if (!(first.value >= 0 && before.value > 0)) return {};
  const auto least =
      find_dip([&](double t) { return gate(contact, which, t); }, first, before, now);
  if (!least) return {};
  if (!(least->value < 0)) {
    if (which == 0) graze(contact, least->time);
    return {};
  }
  if (which == 0 && leaves(contact, first.time, least->time)) return {};
  return locate(contact, which, least->time < before.time ? first : before, *least);
}

// By looks at its end and, where the values at the last three nodes differ by a tenth, its middle:
// all are larger than three times their change. A gate that changes so little over two steps has no
// room to dip to 0 in one of them, as long as the steps resolve it.
bool ContactKernel::stays(double from, double to) {
  const auto changes_by = [this](double part, const Gates& third) {
    for (size_t i = 0; i < end_.size(); ++i) {
      for (size_t which = 0; which < 3; ++which) {
        const double a = at_node_[i][which], b = end_[i][which], c = third[i][which];
        const double least = std::min({a, b, c}), most = std::max({a, b, c});
        if (std::isnan(a + b + c)) return true;
        if (std::isfinite(least) && !(least * part > most - least)) return true;
      }
    }
    return false;
  };
  rolling_gates(to, end_, false);
  if (before_node_.empty() || changes_by(kLittle, before_node_)) {
    rolling_gates(from + (to - from) / 2, middle_, true);
    if (changes_by(1. / 3, middle_)) return false;
  }
  before_node_.swap(at_node_);
  at_node_.swap(end_);
  return true;
}

// Is a reaction outside its cone between two looks, where a switch left it at the round-off of 0?
bool ContactKernel::pulls(int i, size_t which, const Gates& before, const Gates& now) const {
  const ContactMode mode = contact(i).mode;
  const auto at = static_cast<size_t>(i);
  if (mode == ContactMode::open || which > (mode == ContactMode::rolls ? 1 : 0)) return false;
  if (!(before[at][which] < 0)) return false;
  double most = 0;
  for (int k = 0; k < count(); ++k)
    if (contact(k).mode != ContactMode::open && dynamics().law(k).normal)
      most = std::max(most, std::abs(now[static_cast<size_t>(k)][0]));
  return now[at][which] < -kPulls * most;
}

void ContactKernel::catch_up() {
  if (std::exchange(rolled_, false)) follow_speeds();
}

std::optional<ContactKernel::Found> ContactKernel::find(double from, double to) {
  rolls_on_ = all_rolls_ != nullptr && stays(from, to);
  if (rolls_on_) {
    rolled_ = true;
    return {};
  }
  before_node_.clear();
  std::array<double, kParts + 1> times;
  std::vector<Gates>& values = looks_;
  times[0] = from;
  values[0] = at_node_;
  std::optional<Found> out;
  for (size_t part = 1; part <= kParts && !out; ++part) {
    times[part] = part == kParts ? to : from + (to - from) * static_cast<double>(part) / kParts;
    gates(times[part], values[part], true);
    for (int i = 0; i < count(); ++i) {
      for (size_t which = 0; which < 3; ++which) {
        const auto sample = [&](size_t k) {
          return ValueAt{times[k], values[k][static_cast<size_t>(i)][which]};
        };
        if (!std::isfinite(sample(part - 1).value)) continue;
        const ValueAt first = part > 1 ? sample(part - 2) : ValueAt{kNoTime, kNoTime};
        const auto t = crossing(i, which, first, sample(part - 1), sample(part));
        if (t && (!out || *t < out->time)) out = Found{*t, i, switch_of(i, which)};
        if (!out && pulls(i, which, values[part - 1], values[part]))
          out = Found{times[part], i, switch_of(i, which)};
      }
    }
  }
  return out;
}

}  // namespace hamel
