#include <hamel/framework/inverse/step_map.hpp>

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/QR>

namespace hamel {

StepMap::StepMap(RunPlan plan, std::vector<std::size_t> inputs)
    : plan_(std::move(plan)),
      inputs_(std::move(inputs)),
      kernel_(plan_.kernel(plan_.setup)),
      n_(plan_.geometry->dim()),
      k_(plan_.system->mechanics->constraint_count()),
      m_(n_ - k_),
      columns_(plan_.geometry->columns()),
      inertia_(n_, n_),
      rows_(k_, n_),
      drift_(k_) {
  const auto size = static_cast<std::size_t>(plan_.geometry->size());
  for (std::vector<double>* x : {&base_.element, &target_.element, &other_, &tau_}) x->resize(size);
}

Eigen::VectorXd StepMap::start() const {
  Eigen::VectorXd out(state_size());
  std::ranges::copy(plan_.setup.configuration, out.data());
  std::ranges::copy(plan_.setup.velocity, out.data() + columns_);
  return out;
}

bool StepMap::step(double t, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs, double h,
                   Eigen::VectorXd& next) {
  for (std::size_t i = 0; i < inputs_.size(); ++i)
    plan_.setup.inputs->set(inputs_[i], inputs[static_cast<Eigen::Index>(i)]);
  const auto width = static_cast<std::size_t>(columns_);
  const std::span<const double> all(state.data(), static_cast<std::size_t>(state.size()));
  kernel_->restart(t, all.first(width), all.subspan(width), h);
  if (!kernel_->advance(1).ok) return false;
  kernel_->node(node_);
  next.resize(state.size());
  std::ranges::copy(node_.coordinates, next.data());
  std::ranges::copy(node_.velocity, next.data() + columns_);
  return next.allFinite();
}

void StepMap::matrices(double t, const double* element) {
  plan_.system->mechanics->inertia(element, inertia_);
  plan_.system->mechanics->constraints(t, element, rows_, drift_);
}

// xi - I^-1 A^T (A I^-1 A^T)^-1 (A xi - b).
void StepMap::project(double t, Eigen::VectorXd& state) {
  if (k_ == 0) return;
  plan_.geometry->from_coordinates({state.data(), static_cast<std::size_t>(columns_)},
                                   other_.data());
  matrices(t, other_.data());
  weighted_ = inertia_.ldlt().solve(rows_.transpose());
  auto xi = state.tail(n_);
  xi -= weighted_ * (rows_ * weighted_).ldlt().solve(rows_ * xi - drift_);
}

void StepMap::set(Frame& frame, double t, const Eigen::VectorXd& state) {
  if (frame.t == t && frame.state.size() == state.size() && frame.state == state) return;
  frame.state = state;
  frame.t = t;
  plan_.geometry->from_coordinates({state.data(), static_cast<std::size_t>(columns_)},
                                   frame.element.data());
  matrices(t, frame.element.data());
  Eigen::MatrixXd all = Eigen::MatrixXd::Identity(n_, n_);
  if (k_ > 0) all = Eigen::HouseholderQR<Eigen::MatrixXd>(rows_.transpose()).householderQ();
  frame.basis = all.rightCols(m_);
  const Eigen::MatrixXd reduced = frame.basis.transpose() * inertia_;
  frame.inverse = (reduced * frame.basis).ldlt().solve(reduced);
}

void StepMap::retract(double t, const Eigen::VectorXd& state, const Eigen::VectorXd& increment,
                      Eigen::VectorXd& out) {
  set(base_, t, state);
  out = state;
  out.tail(n_) += base_.basis * increment.segment(n_, m_);
  eta_ = increment.head(n_);
  if ((eta_.array() == 0).all()) return;
  plan_.geometry->tau(eta_.data(), tau_.data());
  plan_.geometry->compose(base_.element.data(), tau_.data(), other_.data());
  plan_.geometry->normalise(other_.data());
  plan_.geometry->coordinates(other_.data(), out.data());
  project(t, out);
}

bool StepMap::difference(double t, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                         Eigen::VectorXd& out) {
  set(target_, t, from);
  plan_.geometry->from_coordinates({to.data(), static_cast<std::size_t>(columns_)}, other_.data());
  plan_.geometry->inverse(target_.element.data(), tau_.data());
  plan_.geometry->compose(tau_.data(), other_.data(), other_.data());
  out.resize(n_ + m_);
  if (!plan_.geometry->tau_inverse(other_.data(), out.data())) return false;
  out.tail(m_) = target_.inverse * (to.tail(n_) - from.tail(n_));
  return true;
}

}  // namespace hamel
