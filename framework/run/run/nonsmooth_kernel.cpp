#include <hamel/framework/run/run/nonsmooth_kernel.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>

namespace hamel {
namespace {

constexpr double kClosedAtStart = 1e-9;  // m, a gap

}  // namespace

KernelFactory nonsmooth_kernels(KernelFactory smooth, std::shared_ptr<const Geometry> geometry,
                                const SystemModel& system, std::shared_ptr<RunContacts> contacts) {
  auto model = std::make_shared<SystemModel>(system);
  return [smooth = std::move(smooth), geometry = std::move(geometry), model = std::move(model),
          contacts = std::move(contacts)](const KernelSetup& setup) -> std::unique_ptr<Kernel> {
    auto own = contacts != nullptr ? contacts : std::make_shared<RunContacts>(geometry, *model);
    own->drive(setup.inputs);
    return std::make_unique<NonsmoothKernel>(smooth, setup, std::move(own));
  };
}

NonsmoothKernel::NonsmoothKernel(KernelFactory smooth, KernelSetup setup,
                                 std::shared_ptr<RunContacts> contacts)
    : smooth_(std::move(smooth)),
      setup_(std::move(setup)),
      contacts_(std::move(contacts)),
      limit_(std::copysign(std::numeric_limits<double>::infinity(), setup_.step)),
      g_(setup_.geometry->size()),
      g1_(g_),
      on_(static_cast<size_t>(count())),
      strikes_(static_cast<size_t>(count())),
      no_speeds_(static_cast<size_t>(count())) {
  const Mechanics& system = dynamics().mechanics();
  gaps_.setZero(system.holonomic_rows());
  b_.setZero(system.constraint_count());
  rates_ = b_;
  a_.setZero(system.constraint_count(), system.dim());
  time_ = setup_.from;
  coordinates_ = setup_.configuration;
  velocity_ = setup_.velocity;
  setup_.geometry->from_coordinates(coordinates_, g_.data());
  xi_ = Eigen::Map<const Eigen::VectorXd>(velocity_.data(), std::ssize(velocity_));
  dynamics().evaluate(time_, g_.data(), xi_);  // rows that depend on others there are left out
  KernelSetup open = setup_;
  open.mechanics = std::make_shared<ModeMechanics>(
      contacts_->dynamics(), std::make_shared<ContactStates>(static_cast<size_t>(count())));
  lift_ = smooth_(open);
  begin();
}

// From time_, coordinates_ and velocity_, in the modes that are known, else in those of the state.
void NonsmoothKernel::begin() {
  setup_.geometry->from_coordinates(coordinates_, g_.data());
  xi_ = Eigen::Map<const Eigen::VectorXd>(velocity_.data(), std::ssize(velocity_));
  left_ = setup_.step;
  dynamics().evaluate(time_, g_.data(), xi_);
  ContactStates& states = contacts_->states();
  if (!contacts_->known()) {
    dynamics().accelerate(ContactStates(states.size()));
    for (int i = 0; i < count(); ++i) {
      ContactState& state = states[static_cast<size_t>(i)];
      const double speed = dynamics().speed_scale(i);
      state = {};
      state.no_slip = kNoSpeed * speed;
      const bool closed = dynamics().gap(i) <= kClosedAtStart &&
                          std::abs(dynamics().gap_rate(i)) <= kNoSpeed * speed;
      if (closed) state.mode = ContactMode::rolls;
    }
    const ContactStates closed = states;
    if (!dynamics().decide(states).empty()) states = closed;
    contacts_->set_known(true);
  }
  lift_->restart(time_, coordinates_, velocity_, left_);
  lift_->set_end_time(limit_);
}

void NonsmoothKernel::restart(double t, std::span<const double> coordinates,
                              std::span<const double> velocity, double step) {
  time_ = t;
  coordinates_.assign(coordinates.begin(), coordinates.end());
  velocity_.assign(velocity.begin(), velocity.end());
  setup_.step = step;
  limit_ = std::copysign(std::numeric_limits<double>::infinity(), step);
  contacts_->set_known(false);
  begin();
}

std::unique_ptr<Kernel> NonsmoothKernel::another(const KernelSetup& setup) const {
  return std::make_unique<NonsmoothKernel>(smooth_, setup, contacts_);
}

void NonsmoothKernel::turn_back() {
  throw ConfigError(
      {"turn_back: a motion with friction or impacts is not determined backwards in time"});
}

void NonsmoothKernel::set_end_time(double t) {
  limit_ = t;
  lift_->set_end_time(t);
}

void NonsmoothKernel::state(Snapshot& out, const StateParts& parts) const {
  lift_->state(out, parts);
  out.step = steps_;
  out.iterations = iterations_;
}

bool NonsmoothKernel::interpolate(double t, Snapshot& out) {
  if (t != time_) return false;
  state(out, {});
  return true;
}

Status NonsmoothKernel::fail(const std::string& reason, double residual) const {
  return {false, steps_ + 1, time_, residual, reason};
}

Status NonsmoothKernel::advance(long steps) {
  for (long k = 0; k < steps; ++k) {
    contacts_->keep_modes();
    if (Status status = take_one(); !status.ok) return status;
  }
  return {};
}

}  // namespace hamel
