// Steps and states of a run with contacts, and where they switch.
#include <hamel/framework/run/run/contact_kernel.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <boost/math/tools/toms748_solve.hpp>

#include <hamel/framework/io/errors.hpp>

namespace hamel {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
// A step is looked at in so many parts.
constexpr int kParts = 5;
// A gap of this size, m, is closed at a start; a slip of this size, relative to what the energy
// allows, is none; and sigma.
constexpr double kClosedGap = 1e-9, kNoSlip = 1e-10, kSigma = 1e-7;

}  // namespace

KernelFactory contact_kernels(KernelFactory smooth, std::shared_ptr<const Geometry> geometry,
                              const SystemModel& system, std::shared_ptr<RunContacts> contacts) {
  auto model = std::make_shared<SystemModel>(system);
  return [smooth = std::move(smooth), geometry = std::move(geometry), model = std::move(model),
          contacts = std::move(contacts)](const KernelSetup& setup) -> std::unique_ptr<Kernel> {
    auto own = contacts != nullptr ? contacts : std::make_shared<RunContacts>(geometry, *model);
    return std::make_unique<ContactKernel>(smooth, setup, std::move(own));
  };
}

ContactKernel::ContactKernel(KernelFactory smooth, KernelSetup setup,
                             std::shared_ptr<RunContacts> contacts)
    : smooth_(std::move(smooth)),
      setup_(std::move(setup)),
      contacts_(std::move(contacts)),
      limit_(std::copysign(kNever, setup_.step)),
      references_(static_cast<size_t>(count()), Eigen::Vector2d(1, 0)),
      g_(setup_.geometry->size()),
      move_(g_) {
  time_ = setup_.from;
  coordinates_ = setup_.configuration;
  velocity_ = setup_.velocity;
  begin();
}

// From time_, coordinates_ and velocity_: in the modes that are known, else in those of the state.
void ContactKernel::begin() {
  failure_.clear();
  setup_.geometry->from_coordinates(coordinates_, g_.data());
  xi_ = Eigen::Map<const Eigen::VectorXd>(velocity_.data(),
                                          static_cast<Eigen::Index>(velocity_.size()));
  dynamics().evaluate(time_, g_.data(), xi_);
  events_.clear();
  int strikes = -1;
  for (int i = 0; i < count() && !contacts_->known(); ++i) {
    FollowedContact& follows = followed(i) = {};
    follows.speed = dynamics().slip_scale(i);
    contact(i) = {};
    contact(i).no_slip = kNoSlip * follows.speed;
    if (dynamics().gap(i) > kClosedGap) continue;
    const double rate = dynamics().gap_rate(i);
    if (std::abs(rate) <= 1e-9 * follows.speed) contact(i).mode = ContactMode::rolls;
    else if (rate > 0) follows.opened = time_;
    else strikes = i;
  }
  if (!contacts_->known()) {
    Snapshot start;
    start.time = time_;
    start.coordinates = coordinates_;
    start.velocity = velocity_;
    const ContactStates before = contacts_->states();
    failure_ = strikes >= 0 ? strike_all(strikes) : decide(-1);
    if (!failure_.empty()) contacts_->states() = before;
    if (!events_.empty()) contacts_->switches.push_back({events_, start, start});
    contacts_->set_known(true);
  }
  take_up(setup_.step);
  if (!contacts_->switches.empty()) state(contacts_->switches.back().after, {});
}

void ContactKernel::restart(double t, std::span<const double> coordinates,
                            std::span<const double> velocity, double step) {
  time_ = t;
  coordinates_.assign(coordinates.begin(), coordinates.end());
  velocity_.assign(velocity.begin(), velocity.end());
  setup_.step = step;
  limit_ = std::copysign(kNever, step);
  contacts_->set_known(false);
  before_ = nullptr;
  begin();
}

std::unique_ptr<Kernel> ContactKernel::another(const KernelSetup& setup) const {
  return std::make_unique<ContactKernel>(smooth_, setup, contacts_);
}

void ContactKernel::turn_back() {
  throw ConfigError(
      {"turn_back: a motion with friction or impacts is not determined backwards in time"});
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

Status ContactKernel::fail(const std::string& reason) const {
  return {false, steps_ + 1, now_->time(), 0, reason};
}

Status ContactKernel::advance(long steps) {
  for (long k = 0; k < steps; ++k) {
    if (!failure_.empty()) return fail(failure_);
    const double from = now_->time();
    before_ = nullptr;
    contacts_->keep_modes();
    Status status = now_->advance(1);
    if (!status.ok) {
      status.step = steps_ + 1;
      return status;
    }
    if (now_->time() == from) return {};
    ++steps_;
    if (const auto found = find(from, now_->time())) failure_ = apply(*found);
    else evaluate_node();
    if (failure_.empty()) failure_ = why_no_node();
  }
  return {};
}

// ---- gates along the last step ------------------------------------------------------------------

void ContactKernel::evaluate(const Snapshot& state) {
  std::copy(state.element.begin(), state.element.end(), g_.data());
  xi_ = Eigen::Map<const Eigen::VectorXd>(state.velocity.data(),
                                          static_cast<Eigen::Index>(state.velocity.size()));
  dynamics().evaluate(state.time, g_.data(), xi_);
}

// At the node: scales of velocities and directions of slip, and the gates.
void ContactKernel::evaluate_node() {
  at_node_ = gates(now_->time());
  follow_speeds();
}

void ContactKernel::follow_speeds() {
  for (int i = 0; i < count(); ++i) {
    FollowedContact& follows = followed(i);
    follows.speed = std::max(follows.speed, dynamics().slip_scale(i));
    contact(i).no_slip = kNoSlip * follows.speed;
    const Eigen::Vector2d s = dynamics().slip(i);
    Eigen::Vector2d& reference = references_[static_cast<size_t>(i)];
    reference = s.norm() > 10 * contact(i).no_slip ? Eigen::Vector2d(s / s.norm())
                                                   : contact(i).direction;
  }
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

ContactKernel::Gates ContactKernel::gates(double t) {
  static constexpr StateParts place = {.coordinates = false,
                                       .momentum = false,
                                       .energy = false,
                                       .measures = false};
  if (t == now_->time()) now_->state(snapshot_, place);
  else now_->interpolate(t, snapshot_);
  evaluate(snapshot_);
  dynamics().accelerate(contacts_->states());
  Gates out(static_cast<size_t>(count()), {kNever, kNever});
  for (int i = 0; i < count(); ++i) {
    auto& [first, second] = out[static_cast<size_t>(i)];
    const ContactLaw& law = dynamics().law(i);
    const ContactMode mode = contact(i).mode;
    const double opened = followed(i).opened;
    if (mode == ContactMode::open) {
      if (!law.normal) continue;
      first = dynamics().gap(i);
      if (t == opened) first = std::max(dynamics().gap_rate(i), 1e-300);
      else if (opened > -1e299) first /= std::abs(t - opened);
      continue;
    }
    if (law.normal) first = dynamics().normal_reaction(i);
    const double held = law.normal ? dynamics().normal_reaction(i) : law.load;
    if (mode == ContactMode::rolls)
      second = law.friction * held - dynamics().tangential_reaction(i).norm();
    else if (law.friction > 0)
      second = dynamics().slip(i).dot(references_[static_cast<size_t>(i)]) -
               kSigma * followed(i).speed;
  }
  return out;
}

ContactKernel::Switch ContactKernel::switch_of(int i, size_t gate) const {
  const ContactMode mode = contact(i).mode;
  if (mode == ContactMode::open) return Switch::strikes;
  if (gate == 0) return Switch::opens;
  return mode == ContactMode::rolls ? Switch::slides : Switch::stops;
}

std::optional<ContactKernel::Found> ContactKernel::find(double from, double to) {
  Gates last = at_node_;
  std::optional<Found> out;
  double begin = from;
  for (int part = 1; part <= kParts && !out; ++part) {
    const double end = part == kParts ? to : from + (to - from) * part / kParts;
    Gates now = gates(end);
    for (int i = 0; i < count(); ++i) {
      for (size_t gate = 0; gate < 2; ++gate) {
        const double before = last[static_cast<size_t>(i)][gate],
                     value = now[static_cast<size_t>(i)][gate];
        if (!(before >= 0 && value < 0)) continue;
        const auto inside = [&](double t) {
          if (t == begin) return before;
          if (t == end) return value;
          return gates(t)[static_cast<size_t>(i)][gate];
        };
        std::uintmax_t most = 200;
        const double width = 4e-16 * std::max(std::abs(end), std::abs(end - begin));
        const auto [a, b] = boost::math::tools::toms748_solve(
            inside, begin, end, before, value,
            [width](double x, double y) { return std::abs(y - x) <= width; }, most);
        if (!out || b < out->time) out = Found{b, i, switch_of(i, gate)};
      }
    }
    last = std::move(now);
    begin = end;
  }
  return out;
}

}  // namespace hamel
