// Steps and states of a run with contacts, and where they switch.
#include <hamel/framework/run/run/contacts/contact_kernel.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>

namespace hamel {
namespace {

// A gap that would open so far against the forces, m, is that of a rate which is round-off.
constexpr double kNoRise = 1e-18;

constexpr double kNever = std::numeric_limits<double>::infinity();
// At a start a slip of this size, relative to what the energy allows, is none.
constexpr double kNoSlip = 1e-10;

}  // namespace

ContactKernel::ContactKernel(SmoothKernels smooth, KernelSetup setup,
                             std::shared_ptr<RunContacts> contacts)
    : KernelOfContacts(std::move(smooth), std::move(setup), std::move(contacts)),
      slips_(static_cast<size_t>(count())),
      begun_(static_cast<size_t>(count())),
      looks_(6),
      move_(g_) {
  ContactKernel::begin();
}

void ContactKernel::begin() {
  before_ = nullptr;
  rolls_on_ = rolled_ = false;
  before_node_.clear();
  failure_.clear();
  evaluate_start();
  events_.clear();
  int strikes = -1;
  if (!contacts_->known()) dynamics().accelerate(ContactStates(static_cast<size_t>(count())));
  for (int i = 0; i < count() && !contacts_->known(); ++i) {
    FollowedContact& follows = followed(i) = {};
    follows.speed = dynamics().speed_scale(i);
    contact(i) = {};
    contact(i).no_slip = kNoSlip * follows.speed;
    if (dynamics().gap(i) > kClosedGap) continue;
    const double rate = dynamics().gap_rate(i);
    const double rise = rate * rate / (2 * dynamics().acceleration_scale(i));
    if (std::abs(rate) <= 1e-9 * follows.speed || rise <= kNoRise)
      contact(i).mode = ContactMode::rolls;
    else if (rate > 0) follows.opened = time_;
    else strikes = i;
  }
  if (!contacts_->known()) {
    Snapshot start;
    start.time = time_;
    start.coordinates = coordinates_;
    start.velocity = velocity_;
    const ContactStates before = contacts_->states();
    failure_ = strikes >= 0 ? strike_all(strikes) : decide({});
    if (!failure_.empty()) contacts_->states() = before;
    if (!events_.empty()) contacts_->switches.push_back({events_, start, start});
    contacts_->set_known(true);
  }
  take_up(setup_.step);
  if (!contacts_->switches.empty()) state(contacts_->switches.back().after, {});
}

std::unique_ptr<Kernel> ContactKernel::another(const KernelSetup& setup) const {
  return std::make_unique<ContactKernel>(smooth_, setup, contacts_);
}

void ContactKernel::set_end_time(double t) {
  limit_ = t;
  now_->set_end_time(t);
}

void ContactKernel::state(Snapshot& out, const StateParts& parts) const {
  now_->state(out, parts);
  out.step = steps_;
}

bool ContactKernel::interpolate(double t, Snapshot& out) {
  if (t == now_->time()) state(out, {});
  else if (!of_last_step().interpolate(t, out)) return false;
  out.step = steps_;
  return true;
}

bool ContactKernel::motion_within(double t, Snapshot& out) {
  return of_last_step().motion_within(t, out);
}

const SolverStats& ContactKernel::stats() const {
  all_ = {};
  for (const auto& [modes, list] : pieces_) {
    for (const Piece& piece : list) {
      const SolverStats& one = piece.kernel->stats();
      all_.iterations += one.iterations;
      all_.evaluations += one.evaluations;
      all_.iterations_max = std::max(all_.iterations_max, one.iterations_max);
      all_.residual_max = std::max(all_.residual_max, one.residual_max);
      all_.rejected += one.rejected;
    }
  }
  return all_;
}

// The step from the node before, to the end of a slip: friction behind that is another one, which
// no stage should have, so that the error of the step is that of the motion before it.
Status ContactKernel::take_again(double from, double end) {
  if (std::abs(end - from) < 1e-12 * std::max(std::abs(from), std::abs(now_->time() - from)))
    return {};
  now_->beginning(snapshot_);
  const std::vector<double> coordinates = snapshot_.coordinates, velocity = snapshot_.velocity;
  now_->restart(from, coordinates, velocity, end - from);
  stop_ = end;
  now_->set_end_time(end);
  evaluate_node();
  return now_->advance(1);
}

Status ContactKernel::fail(const std::string& reason) const {
  return {false, steps_ + 1, now_->time(), 0, reason};
}

Status ContactKernel::advance(long steps) {
  for (long k = 0; k < steps; ++k) {
    if (!failure_.empty()) return fail(failure_);
    const double from = now_->time();
    before_ = nullptr;
    if (!rolls_on_) contacts_->keep_modes();
    Status status = now_->advance(1);
    std::optional<Found> found;
    if (status.ok && now_->time() != from) found = find(from, now_->time());
    usual_step_ = now_->next_step();
    if (status.ok && found && found->what == Switch::stops) {
      status = take_again(from, found->time);
      if (status.ok) found = find(from, now_->time());
    }
    if (!status.ok) {
      status.step = steps_ + 1;
      return status;
    }
    if (now_->time() == from) return {};
    ++steps_;
    if (!found && now_->time() == stop_) found = stop_found();
    take_node(found);
  }
  return {};
}

// At the end of a step: the modes behind a switch that ended it, else what is known of the node.
void ContactKernel::take_node(const std::optional<Found>& found) {
  if (now_->time() == stop_ || found) stop_ = kNever;
  if (found) failure_ = apply(*found);
  else evaluate_node();
  now_->set_end_time(limit_);
  if (std::isfinite(stop_)) now_->set_end_time(stop_);
  if (!rolls_on_ && failure_.empty()) failure_ = why_no_node();
}

}  // namespace hamel
