// A run with contacts at a switch: what it does to the state, and the piece that follows.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/run/run/contacts/contact_kernel.hpp>

namespace hamel {
namespace {

// More switches than this within a part of 1e-6 of the run do not end.
constexpr long kMostSwitches = 1000;
// A gap of this many of its last step's lengths is closed together with another.
constexpr double kTogether = 1e-9;
// A slip above this many sigma V has turned, and not stopped.
constexpr double kSlow = 1e-6;
// A rate behind an impact that is this part of the speeds of the contact is round-off of them.
constexpr double kNoRate = 1e-14;
// A gap that opens by a rate which is this part of them begins no flight of its own.
constexpr double kNoFlight = 1e-12;

}  // namespace

// At the switch: the modes behind it, and the events. Where there are none the state before it is
// the last one.
std::string ContactKernel::apply(const Found& found) {
  const double step = std::max(now_->next_step(), usual_step_);
  interpolate(found.time, snapshot_);
  time_ = found.time;
  coordinates_ = snapshot_.coordinates;
  evaluate(snapshot_);
  catch_up();
  contacts_->switches.push_back({{}, snapshot_, {}});
  const size_t here = contacts_->switches.size() - 1;
  const ContactStates before = contacts_->states();
  const Eigen::VectorXd velocity = xi_;
  events_.clear();
  ends_ = -1e300;
  std::string why;
  const int i = found.contact;
  switch (found.what) {
    case Switch::strikes: why = strike_all(i); break;
    case Switch::bears:
      contact(i).mode = dynamics().slips(contact(i), i) ? ContactMode::slides : ContactMode::rolls;
      why = go_on({});
      break;
    case Switch::opens:
      contact(i).mode = ContactMode::open;
      followed(i).opened = time_;
      why = go_on({});
      break;
    case Switch::slides: {
      dynamics().accelerate(before);
      why = go_on(at_rims(i));
      break;
    }
    case Switch::grows: grow(i); break;
    case Switch::stops: why = stop_slip(i); break;
  }
  if (why.empty()) contacts_->name_changes(before, std::max(time_, ends_), events_);
  if (why.empty() && too_many(time_)) {
    why = fmt::format(
        "sticks_and_slips: contact '{}' has switched {} times within a millionth of the run at t = "
        "{:.10g}: the scheme nonsmooth takes it in steps of one size",
        dynamics().law(i).name, kMostSwitches, time_);
  }
  if (!why.empty()) {
    contacts_->states() = before;
    xi_ = velocity;
    dynamics().evaluate(time_, g_.data(), xi_);
  }
  velocity_.assign(xi_.begin(), xi_.end());
  Kernel* const old = now_;
  take_up(first_step(step));
  before_ = old;
  ContactSwitch& last = contacts_->switches[here];
  last.events = events_;
  state(last.after, {});
  return why;
}

// Contact `first`, and others that roll and whose reactions are on the rims of their cones with it,
// begin to slide against these.
std::vector<char> ContactKernel::at_rims(int first) {
  std::vector<char> out(static_cast<size_t>(count()), 0);
  for (int i = 0; i < count(); ++i) {
    if (contact(i).mode != ContactMode::rolls || dynamics().law(i).tangential.empty()) continue;
    if (!dynamics().yields_with(i, first)) continue;
    const Eigen::Vector2d l = dynamics().tangential_reaction(i);
    out[static_cast<size_t>(i)] = 1;
    if (!(l.norm() > 0)) continue;
    contact(i).direction = -l / l.norm();
    contact(i).mode = ContactMode::slides;
  }
  return out;
}

// Modes of the closed contacts at the state, which dynamics() has.
std::string ContactKernel::decide(const std::vector<char>& slides) {
  close_held();
  const ContactStates before = contacts_->states();
  for (ContactState& state : contacts_->states())
    if (state.mode != ContactMode::slides) state.begins = false;
  std::string why = dynamics().decide(contacts_->states(), slides);
  for (int i = 0; i < count(); ++i) {
    const ContactState& was = before[static_cast<size_t>(i)];
    if (contact(i).mode == ContactMode::open && was.mode != ContactMode::open)
      followed(i).opened = time_;
  }
  if (why.empty()) choose_ease(before);
  return why;
}

// Behind a switch of several contacts: in the modes that it leaves, where these are lawful, else in
// those of the contact problem, which is exact of one alone.
std::string ContactKernel::go_on(const std::vector<char>& slides) {
  const ContactStates before = contacts_->states();
  const auto closed = std::ranges::count_if(
      before, [](const ContactState& one) { return one.mode != ContactMode::open; });
  if (closed > 1) {
    ContactStates next = before;
    for (size_t i = 0; i < next.size(); ++i) {
      const auto at = static_cast<int>(i);
      if (i < slides.size() && slides[i] != 0) {
        next[i].mode = ContactMode::slides;
        next[i].begins = dynamics().law(at).tangential.size() == 2;
        next[i].ease = 0;
      } else if (next[i].mode == ContactMode::slides && !next[i].begins &&
                 !dynamics().slips(next[i], at)) {
        next[i].mode = ContactMode::rolls;  // it has stopped with another
      }
    }
    if (dynamics().continue_in(next, kClosedGap)) {
      contacts_->states() = next;
      choose_ease(before);
      return "";
    }
  }
  return decide(slides);
}

// Contacts at a height that others hold may bear again, whatever the switch is.
void ContactKernel::close_held() {
  for (int i = 0; i < count(); ++i)
    if (std::exchange(followed(i).held, false) && contact(i).mode == ContactMode::open)
      contact(i).mode = ContactMode::rolls;
}

// The impact of contact `first`, and of others whose gaps close with it.
std::string ContactKernel::strike_all(int first) {
  close_held();
  std::vector<char> strikes(static_cast<size_t>(count()), 0);
  std::vector<double> speeds(strikes.size(), 0);
  for (int i = 0; i < count(); ++i) {
    const double rate = dynamics().gap_rate(i);
    speeds[static_cast<size_t>(i)] = std::abs(rate);
    const bool together = contact(i).mode == ContactMode::open && dynamics().law(i).normal &&
                          rate < 0 && dynamics().gap(i) <= kTogether * std::abs(rate);
    if (i == first || together) strikes[static_cast<size_t>(i)] = 1;
  }
  std::string why = dynamics().strike(contacts_->states(), strikes, xi_);
  if (!why.empty()) return why;
  dynamics().evaluate(time_, g_.data(), xi_);
  for (int i = 0; i < count(); ++i) {
    const auto at = static_cast<size_t>(i);
    const bool was_closed = contact(i).mode != ContactMode::open && dynamics().law(i).normal;
    if (strikes[at] == 0 && !was_closed) continue;
    const double scale = strikes[at] != 0 ? speeds[at] : followed(i).speed;
    const bool leaves =
        dynamics().gap_rate(i) > std::max(1e-12 * scale, kNoRate * followed(i).speed);
    contact(i).mode = leaves ? ContactMode::open : ContactMode::rolls;
    if (leaves) followed(i).opened = time_;
    if (strikes[at] == 0) continue;
    events_.emplace_back(dynamics().law(i).name + ".strikes", time_);
    FollowedContact& follows = followed(i);
    const double between = follows.struck > -1e299 ? time_ - follows.struck : 0;
    const double ratio = follows.between > 0 ? between / follows.between : 1;
    follows.struck = time_;
    follows.between = between;
    if (leaves && ratio > 0 && ratio < 1) end_chatter(i, ratio);
  }
  return decide({});
}

// Impacts with intervals in a ratio r last R = t_1/(1 - r) more, t_1 = 2 v/a the next flight, and
// rise a R^2/2 at most.
void ContactKernel::end_chatter(int i, double ratio) {
  dynamics().accelerate(contacts_->states());
  const double a = -dynamics().gap_acceleration(i), v = dynamics().gap_rate(i);
  if (!(a > 0)) return;
  const double rest = 2 * v / a / (1 - ratio);
  if (!(a * rest * rest / 2 < setup_.errors.at(0))) return;
  ends_ = time_ + rest;
  dynamics().rest(contacts_->states(), i, xi_);
  dynamics().evaluate(time_, g_.data(), xi_);
  contact(i).mode = ContactMode::rolls;
  followed(i).opened = followed(i).struck = -1e300;
  followed(i).between = 0;
  contacts_->notes.push_back(fmt::format(
      "chatter: the impacts of contact '{}' accumulate at t = {:.12g}: it stays closed from t = "
      "{:.12g} on",
      dynamics().law(i).name, time_ + rest, time_));
}

// The slip that is left takes the time |s|/|s|' to end.
std::string ContactKernel::stop_slip(int i) {
  const Eigen::Vector2d s = dynamics().slip(i);
  if (s.norm() > kSlow * followed(i).scale()) {  // the direction of the slip has turned
    contact(i).direction = s / s.norm();
    return "";
  }
  dynamics().accelerate(contacts_->states());
  const double rate = dynamics().slip_rate(i).dot(s) / s.norm();
  const double left = std::abs(limit_ - time_);
  if (rate < 0) {
    const double more = std::min(s.norm() / -rate, left);
    move_ = more * xi_;
    Eigen::VectorXd turn(g_.size());
    setup_.geometry->tau(move_.data(), turn.data());
    setup_.geometry->compose(g_.data(), turn.data(), g_.data());
    setup_.geometry->normalise(g_.data());
    setup_.geometry->coordinates(g_.data(), coordinates_.data());
    xi_ += more * dynamics().acceleration();
    time_ += more;
    dynamics().evaluate(time_, g_.data(), xi_);
  }
  end_begun(i);
  contact(i).begins = false;
  if (dynamics().stop(contacts_->states(), i, xi_)) dynamics().evaluate(time_, g_.data(), xi_);
  contact(i).mode = ContactMode::rolls;
  return go_on({});
}

// The first step of a flight takes at most half of it.
double ContactKernel::first_step(double step) {
  dynamics().accelerate(contacts_->states());
  double out = step;
  for (int i = 0; i < count(); ++i) {
    if (contact(i).mode != ContactMode::open || followed(i).opened != time_ ||
        dynamics().height_of_held(contacts_->states(), i))
      continue;
    const double rate = dynamics().gap_rate(i), a = -dynamics().gap_acceleration(i);
    if (rate > kNoFlight * followed(i).speed && a > 0) out = std::min(out, rate / a);
  }
  return std::max(out, std::numeric_limits<double>::epsilon() * 4 * std::abs(time_));
}

// Where all contacts roll, by rows that are independent, the system itself, whose kernel takes the
// steps of an ideal one.
std::shared_ptr<const Mechanics> ContactKernel::mechanics_of(
    const std::shared_ptr<const ContactStates>& states) const {
  const auto& system = contacts_->system().mechanics;
  const auto rows = static_cast<int>(dynamics().rows(*states).size());
  if (all_roll() && rows == system->constraint_count()) return system;
  return std::make_shared<ModeMechanics>(contacts_->dynamics(), states);
}

bool ContactKernel::all_roll() const {
  return std::ranges::all_of(contacts_->states(), [](const ContactState& state) {
    return state.mode == ContactMode::rolls;
  });
}

// Continues from time_, coordinates_ and xi_ in the modes of the contacts.
void ContactKernel::take_up(double step) {
  std::vector<int> key;
  for (int i = 0; i < count(); ++i) key.push_back(static_cast<int>(contact(i).mode));
  velocity_.assign(xi_.begin(), xi_.end());
  std::vector<Piece>& list = pieces_[key];
  auto piece = std::find_if(list.begin(), list.end(),
                            [this](const Piece& one) { return one.kernel.get() != now_; });
  if (piece == list.end()) {
    Piece one;
    one.states = std::make_shared<ContactStates>(contacts_->states());
    KernelSetup setup = setup_;
    setup.mechanics = mechanics_of(one.states);
    setup.first_chosen = setup_.first_chosen && now_ == nullptr;
    setup.from = time_;
    setup.step = step;
    setup.configuration = coordinates_;
    setup.velocity = velocity_;
    const bool ideal = setup.mechanics == contacts_->system().mechanics;
    one.kernel = (ideal ? smooth_.ideal : smooth_.any)(setup);
    one.ideal = ideal;
    piece = list.insert(list.end(), std::move(one));
  } else {
    *piece->states = contacts_->states();
    piece->kernel->restart(time_, coordinates_, velocity_, step);
  }
  now_ = piece->kernel.get();
  now_states_ = piece->states;
  all_rolls_ = nullptr;
  before_node_.clear();
  const bool given =
      std::ranges::none_of(contacts_->system().contact_laws,
                           [](const ContactLaw& law) { return law.load_input.has_value(); });
  if (piece->ideal && given)
    all_rolls_ = std::make_unique<EquationsOfMotion<DynamicProblem>>(
        DynamicProblem(setup_.geometry, contacts_->system().mechanics));
  now_->set_end_time(limit_);
  evaluate_node();
}

bool ContactKernel::too_many(double t) {
  const double part = 1e-6 * std::abs(limit_ - setup_.from);
  if (!std::isfinite(part)) return false;
  if (!(std::abs(t - contacts_->window) <= part)) {
    contacts_->window = t;
    contacts_->met = 0;
  }
  return ++contacts_->met > kMostSwitches;
}

}  // namespace hamel
