#include <hamel/framework/run/run/steps/restarted_kernel.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hamel {

RestartedKernel::RestartedKernel(KernelFactory factory, KernelSetup setup)
    : factory_(std::move(factory)),
      setup_(std::move(setup)),
      kernel_(factory_(setup_)),
      limit_(std::copysign(std::numeric_limits<double>::infinity(), setup_.step)),
      origin_(setup_.from) {}

void RestartedKernel::begin_anew() {
  Snapshot node;
  kernel_->state(node);
  past_ = stats();
  steps_ += node.step;
  whole_ += kernel_->whole_steps();
  setup_.from = node.time;
  setup_.step = kernel_->next_step();
  if (!setup_.errors.chooses_steps())
    setup_.from = origin_ + static_cast<double>(whole_ - origin_steps_) * setup_.step;
  kernel_->node(node);
  setup_.configuration = node.coordinates;
  setup_.velocity = node.velocity;
  make();
}

void RestartedKernel::start_again(const KernelSetup& setup) {
  setup_ = setup;
  replace();
  limit_ = std::copysign(std::numeric_limits<double>::infinity(), setup_.step);
  origin_ = setup_.from;
  origin_steps_ = steps_ = whole_ = 0;
  past_ = {};
}

void RestartedKernel::make() {
  setup_.first_chosen = false;
  if (setup_.inputs != nullptr) setup_.inputs->enter(setup_.from, setup_.step);
  replace();
  kernel_->set_end_time(limit_);
}

void RestartedKernel::replace() {
  auto another = kernel_->another(setup_);
  kernel_ = another != nullptr ? std::move(another) : factory_(setup_);
}

Status RestartedKernel::advance(long count) {
  Status status = kernel_->advance(count);
  if (!status.ok) status.step += steps_;
  return status;
}

void RestartedKernel::state(Snapshot& out, const StateParts& parts) const {
  kernel_->state(out, parts);
  out.step += steps_;
}

bool RestartedKernel::interpolate(double t, Snapshot& out) {
  if (!kernel_->interpolate(t, out)) return false;
  out.step += steps_;
  return true;
}

const SolverStats& RestartedKernel::stats() const {
  const SolverStats& now = kernel_->stats();
  all_ = past_;
  all_.iterations += now.iterations;
  all_.evaluations += now.evaluations;
  all_.iterations_max = std::max(all_.iterations_max, now.iterations_max);
  all_.residual_max = std::max(all_.residual_max, now.residual_max);
  all_.rejected += now.rejected;
  all_.fallbacks += now.fallbacks;
  for (const Fallback& f : now.first_fallbacks) {
    if (all_.first_fallbacks.size() == 20) break;
    all_.first_fallbacks.push_back({f.step + steps_, f.time, f.action});
  }
  return all_;
}

void RestartedKernel::set_end_time(double t) {
  limit_ = t;
  kernel_->set_end_time(t);
}

void RestartedKernel::restart(double t, std::span<const double> coordinates,
                              std::span<const double> velocity, double step) {
  kernel_->restart(t, coordinates, velocity, step);
  origin_ = t;
  origin_steps_ = whole_steps();
}

}  // namespace hamel
