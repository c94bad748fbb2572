// Impulses at the ends of a step of fixed size.
#include <hamel/framework/contact/contact_dynamics.hpp>

namespace hamel {

void ContactDynamics::set_up_impulses(const ContactStates& states, const std::vector<ImpulseOf>& on,
                                      double time, bool along_slip) {
  at_end_ = !along_slip;
  on_.clear();
  blocks_.clear();
  block_contacts_.clear();
  force_.setZero();
  for (int i = 0; i < count(); ++i) {
    const auto at = static_cast<size_t>(i);
    if (on[at] == ImpulseOf::none) continue;
    const ContactState& state = states[at];
    const Eigen::Vector2d s = slip(i);
    const bool slips = state.mode == ContactMode::slides && s.norm() > state.no_slip;
    const bool known = along_slip && slips && !law(i).tangential.empty();
    const bool alone = on[at] == ImpulseOf::normal;
    const Eigen::Vector2d d =
        known && !alone ? Eigen::Vector2d(s / s.norm()) : Eigen::Vector2d(0, 0);
    const size_t before = blocks_.size();
    if (known && !law(i).normal) {
      sliding_row(i, d, column_);
      force_ += time * column_;
    } else {
      add_block(i, known || alone, d);
    }
    if (blocks_.size() == before) continue;
    ContactBlock& block = blocks_.back();
    block.friction = state.mode == ContactMode::rolls ? law(i).holding() : law(i).friction;
    block.bound = time * block.friction * law(i).load;
  }
  metric_.solve(force_, no_rates_, free_);
}

void ContactDynamics::impulse_metric(Eigen::MatrixXd& out) const {
  out.resize(impulse_count(), impulse_count());
  for (int i = 0; i < impulse_count(); ++i)
    for (int j = 0; j < impulse_count(); ++j)
      out(i, j) = row_times(impulse_row(i), responses_.col(j));
}

bool ContactDynamics::impulses_depend(const Eigen::MatrixXd& g) {
  k_.topLeftCorner(g.rows(), g.cols()) = g;
  return dependent();
}

std::string ContactDynamics::solve_impulses(const Eigen::MatrixXd& g, const Eigen::VectorXd& c,
                                            bool near, ContactStates& states) {
  const auto m = static_cast<Eigen::Index>(on_.size());
  if (m == 0) return "";
  k_.topLeftCorner(m, m) = g;
  c_.head(m) = c;
  if (std::string why = solve_problem("impulse", near); !why.empty()) return why;
  for (size_t k = 0; k < blocks_.size(); ++k)
    take_answer(states[static_cast<size_t>(block_contacts_[k])], k);
  return "";
}

}  // namespace hamel
