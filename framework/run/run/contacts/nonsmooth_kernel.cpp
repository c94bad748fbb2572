#include <hamel/framework/run/run/contacts/nonsmooth_kernel.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/components.hpp>

namespace hamel {
namespace {

constexpr double kClosedAtStart = 1e-9;  // m, a gap

}  // namespace

NonsmoothKernel::NonsmoothKernel(SmoothKernels smooth, KernelSetup setup,
                                 std::shared_ptr<RunContacts> contacts)
    : KernelOfContacts(std::move(smooth), std::move(setup), std::move(contacts)),
      g1_(g_),
      on_(static_cast<size_t>(count())),
      strikes_(static_cast<size_t>(count())),
      no_speeds_(static_cast<size_t>(count())),
      middle_(g_),
      pressed_(static_cast<size_t>(count())),
      all_open_(static_cast<size_t>(count())) {
  const Mechanics& system = dynamics().mechanics();
  const std::vector<std::string> units = units_of_element(contacts_->system().group);
  for (size_t i = 0; i < units.size(); ++i)
    if (units[i] == "m") lengths_.push_back(i);
  for (const Component& one : components_of(contacts_->system()))
    is_place_.push_back(one.unit == "m/s" ? 1 : 0);
  is_place_.resize(static_cast<size_t>(system.dim()), 0);
  gaps_.setZero(system.holonomic_rows());
  b_.setZero(system.constraint_count());
  rates_ = b_;
  a_.setZero(system.constraint_count(), system.dim());
  evaluate_start();  // rows that depend on others there are left out
  KernelSetup open = setup_;
  open.mechanics = std::make_shared<ModeMechanics>(
      contacts_->dynamics(), std::make_shared<ContactStates>(static_cast<size_t>(count())));
  lift_ = smooth_.any(open);
  NonsmoothKernel::begin();
}

void NonsmoothKernel::begin() {
  left_ = setup_.step;
  fresh_ = true;
  evaluate_start();
  moved_.setZero(xi_.size());
  forget_steps();
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
  put_lift(Nearby::node, velocity_, left_);
}

void NonsmoothKernel::put_lift(Nearby to, std::span<const double> velocity, double size) {
  if (fresh_ || size != lift_->next_step()) lift_->restart(time_, coordinates_, velocity, size);
  else lift_->restart_near(to, time_, coordinates_, velocity);
  lift_->set_end_time(limit_);
}

std::unique_ptr<Kernel> NonsmoothKernel::another(const KernelSetup& setup) const {
  return std::make_unique<NonsmoothKernel>(smooth_, setup, contacts_);
}

void NonsmoothKernel::set_end_time(double t) {
  limit_ = t;
  lift_->set_end_time(t);
}

void NonsmoothKernel::state(Snapshot& out, const StateParts& parts) const {
  lift_->state(out, parts);
  out.step = steps_;
  out.iterations = iterations_;
  if (!parts.measures || steps_ == 0) return;
  // Measures of the step, which lift has left for the node.
  out.constraint_rates = measured_.constraint_rates;
  out.constraint = measured_.constraint;
  out.time_offset = measured_.time_offset;
  out.rotation = measured_.rotation;
  out.residual = measured_.residual;
}

const SolverStats& NonsmoothKernel::stats() const {
  stats_ = lift_->stats();
  stats_.iterations_max = most_;
  return stats_;
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
    const auto before = lift_->stats().iterations;
    if (Status status = take_one(); !status.ok) return status;
    most_ = std::max(most_, static_cast<int>(lift_->stats().iterations - before));
  }
  return {};
}

}  // namespace hamel
