#include <hamel/framework/run/run/dense_output.hpp>

#include <cmath>
#include <utility>

namespace hamel {

DenseOutput::DenseOutput(Kernel& kernel, KernelFactory factory, KernelSetup setup)
    : kernel_(kernel), factory_(std::move(factory)), setup_(std::move(setup)) {
  setup_.rtol = setup_.atol = 0;
  setup_.first_chosen = false;
}

Status DenseOutput::at(double t, Snapshot& out) {
  kernel_.state(now_);
  kernel_.beginning(begin_);
  const double h = now_.time - begin_.time;
  if (std::abs(t - now_.time) <= 1e-12 * std::abs(h == 0 ? kernel_.next_step() : h)) {
    kernel_.measure(out);
    out.time = t;
    return {};
  }
  const bool ahead = (t - now_.time) * kernel_.next_step() > 0;
  if (!ahead && kernel_.interpolate(t, out)) return {};
  if (ahead) kernel_.node(begin_);
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
