// The system in one set of modes.
#include <utility>

#include <hamel/framework/contact/contact_dynamics.hpp>

namespace hamel {

ModeMechanics::ModeMechanics(std::shared_ptr<ContactDynamics> dynamics,
                             std::shared_ptr<const ContactStates> states)
    : dynamics_(std::move(dynamics)), states_(std::move(states)), rows_(dynamics_->rows(*states_)) {
  const int k = full().constraint_count(), first = k - full().holonomic_rows();
  for (const int row : rows_)
    if (row >= first) gaps_.push_back(row - first);
  all_rows_.resize(k, dim());
  all_b_.resize(k);
  all_gaps_.resize(k - first);
}

void ModeMechanics::rows_at(double t, const double* g, Matrix a, Vector b) const {
  full().constraints(t, g, all_rows_, all_b_);
  for (size_t i = 0; i < rows_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    a.row(at) = all_rows_.row(rows_[i]);
    b[at] = all_b_[rows_[i]];
  }
}

void ModeMechanics::gaps_at(const double* g, Vector out) const {
  full().holonomic(g, all_gaps_);
  for (size_t i = 0; i < gaps_.size(); ++i) out[static_cast<Eigen::Index>(i)] = all_gaps_[gaps_[i]];
}

void ModeMechanics::accelerate(double t, const double* g, ConstVector xi, Vector out) const {
  dynamics_->evaluate(t, g, xi);
  dynamics_->accelerate(*states_);
  out = dynamics_->acceleration();
}

}  // namespace hamel
