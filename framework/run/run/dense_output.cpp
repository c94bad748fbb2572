#include <hamel/framework/run/run/dense_output.hpp>

#include <cmath>
#include <utility>

namespace hamel {

DenseOutput::DenseOutput(Kernel& kernel, KernelFactory factory, KernelSetup setup)
    : kernel_(kernel), factory_(std::move(factory)), setup_(std::move(setup)) {
  setup_.errors = {};
  setup_.first_chosen = false;
}

Status DenseOutput::at(double t, Snapshot& out) {
  const double now = kernel_.time(), h = now - kernel_.beginning_time();
  if (std::abs(t - now) <= 1e-12 * std::abs(h == 0 ? kernel_.next_step() : h)) {
    kernel_.measure(out);
    out.time = t;
    return {};
  }
  const bool ahead = (t - now) * kernel_.next_step() > 0;
  if (!ahead && kernel_.interpolate(t, out)) return {};
  const Status status = step_to(t, ahead);
  other_->measure(out);
  out.time = t;
  out.step = now_.step;
  return status;
}

Status DenseOutput::log(double t, StateLog& log) {
  const Status status = step_to(t, (t - kernel_.time()) * kernel_.next_step() > 0);
  if (!status.ok) return status;
  const std::size_t before = log.size();
  other_->log_to(&log, false);
  other_->log_state(other_->time());
  other_->log_to(nullptr, false);
  if (log.size() == before) return {};  // flawed
  double* state = log.numbers.data() + before * log.width;
  state[StateLog::kStep] = static_cast<double>(now_.step);
  state[StateLog::kTime] = t;
  return {};
}

// A step from the last node, or from the one before.
Status DenseOutput::step_to(double t, bool ahead) {
  kernel_.bare_state(now_);
  if (ahead) kernel_.node(begin_);
  else kernel_.beginning(begin_);
  if (other_ == nullptr) other_ = factory_(setup_);
  other_->restart(begin_.time, begin_.coordinates, begin_.velocity, t - begin_.time);
  other_->set_end_time(t);
  return other_->advance(1);
}

}  // namespace hamel
