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
  kernel_.bare_state(now_);
  if (ahead) kernel_.node(begin_);
  else kernel_.beginning(begin_);
  if (other_ == nullptr) other_ = factory_(setup_);
  other_->restart(begin_.time, begin_.coordinates, begin_.velocity, t - begin_.time);
  other_->set_end_time(t);
  const Status status = other_->advance(1);
  other_->measure(out);
  out.time = t;
  out.step = now_.step;
  return status;
}

}  // namespace hamel
