// Impacts: contacts that strike, beside others that are closed.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/contact/contact_dynamics.hpp>

namespace hamel {

// The contact problem (4) of the contacts that strike and, `beside`, of those that are closed.
void ContactDynamics::set_up_impact(const ContactStates& states, const std::vector<char>& strikes,
                                    bool beside) {
  at_end_ = false;
  on_.clear();
  blocks_.clear();
  block_contacts_.clear();
  for (int i = 0; i < count(); ++i) {
    const bool closed = states[static_cast<size_t>(i)].mode != ContactMode::open;
    if (law(i).normal && (strikes[static_cast<size_t>(i)] != 0 || (beside && closed)))
      add_block(i, false, {0, 0});
  }
  for (size_t k = 0; k < blocks_.size(); ++k) {
    const auto i = static_cast<size_t>(block_contacts_[k]);
    blocks_[k].friction = laws_[i].friction;
    for (int j = 0; j < blocks_[k].size(); ++j) {
      const int row = on_[static_cast<size_t>(blocks_[k].first + j)].row;
      const double of_strike = j == 0 ? laws_[i].restitution : laws_[i].tangential_restitution;
      const double e = strikes[i] != 0 ? of_strike : 0;
      c_[blocks_[k].first + j] = (1 + e) * (row_times(row, xi_) - b_[row]);
    }
  }
}

// Why the impact depends on an order: two of its contacts are coupled; "" where none are.
std::string ContactDynamics::why_coupled() const {
  double coupling = 0, size = 0;
  for (const Row& row : on_)
    for (size_t j = 0; j < on_.size(); ++j) {
      const double entry =
          std::abs(row_times(row.row, responses_.col(static_cast<Eigen::Index>(j))));
      double& most = row.contact == on_[j].contact ? size : coupling;
      most = std::max(most, entry);
    }
  if (!(coupling > 1e-12 * size)) return "";
  return fmt::format(
      "simultaneous_impacts: {} are closed at once at t = {:.10g} and coupled ({:.3g} of {:.3g} "
      "1/kg): the impact depends on their order, which rigid bodies do not have; the "
      "scheme nonsmooth takes them as one",
      names_of_blocks(), time_, coupling, size);
}

std::string ContactDynamics::solve_impact(Eigen::VectorXd& xi) {
  find_metric();
  if (std::string why = solve_problem("impulse"); !why.empty()) return why;
  xi = xi_;
  for (size_t i = 0; i < on_.size(); ++i)
    xi +=
        problem().p()[static_cast<Eigen::Index>(i)] * responses_.col(static_cast<Eigen::Index>(i));
  return "";
}

// Does no closed contact but those that strike have to push at the velocity xi behind them?
bool ContactDynamics::others_leave(const ContactStates& states, const std::vector<char>& strikes,
                                   const Eigen::VectorXd& xi) {
  for (int i = 0; i < count(); ++i) {
    const auto at = static_cast<size_t>(i);
    if (!law(i).normal || strikes[at] != 0 || states[at].mode == ContactMode::open) continue;
    const int row = *law(i).normal;
    if (!(row_times(row, xi) - b_[row] >= -1e-12 * scale_at(i, xi_))) return false;
  }
  return true;
}

std::string ContactDynamics::strike(const ContactStates& states, const std::vector<char>& strikes,
                                    Eigen::VectorXd& xi) {
  set_up_impact(states, strikes, true);
  const std::string why = why_coupled();
  if (why.empty()) return solve_impact(xi);
  // Without impulses at the others, where these leave.
  set_up_impact(states, strikes, false);
  if (why_coupled().empty() && solve_impact(xi).empty() && others_leave(states, strikes, xi))
    return "";
  // Without friction and restitution: the velocity nearest to xi, in the metric, that none forbids.
  set_up_impact(states, strikes, true);
  const bool one_velocity = std::ranges::all_of(block_contacts_, [&](int i) {
    return law(i).friction == 0 &&
           (strikes[static_cast<size_t>(i)] == 0 || law(i).restitution == 0);
  });
  return one_velocity ? solve_impact(xi) : why;
}

}  // namespace hamel
