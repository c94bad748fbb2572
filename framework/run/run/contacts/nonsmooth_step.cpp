// A step of the scheme nonsmooth: what it begins with, impulses at its end, and modes behind it.
#include <algorithm>
#include <cmath>
#include <utility>

#include <hamel/framework/run/run/contacts/nonsmooth_kernel.hpp>

namespace hamel {

// Open contacts whose gap the step has crossed are on from now on.
bool NonsmoothKernel::others_strike() {
  const Mechanics& system = dynamics().mechanics();
  const int first = system.constraint_count() - system.holonomic_rows();
  bool out = false;
  for (int i = 0; i < count(); ++i) {
    const auto at = static_cast<size_t>(i);
    if (on_[at] != ImpulseOf::none || !dynamics().law(i).normal) continue;
    if (!(gaps_[*dynamics().law(i).normal - first] < 0)) continue;
    on_[at] = ImpulseOf::normal;
    strikes_[at] = 1;
    out = true;
  }
  return out;
}

// Does its bounce last a step? A shorter one is none: the forces, which close the gap at a rate a,
// end it after 2 e v/a.
bool NonsmoothKernel::bounces(const ContactLaw& law, int row) const {
  const auto unstruck = Eigen::Map<const Eigen::VectorXd>(unstruck_.velocity.data(), xi_.size());
  const double closes = rates_[row] - (a_.row(row).dot(unstruck) - b_[row]);
  return rates_[row] < 0 && 2 * law.restitution * -rates_[row] > closes;
}

// Q of these contacts, of those that strike P + Q, and xi1 behind it.
std::string NonsmoothKernel::solve_end(const std::vector<ImpulseOf>& on, double h) {
  dynamics().set_up_impulses(states_, on, h / 2, false);
  const int m = dynamics().impulse_count();
  dynamics().impulse_metric(metric_);
  dynamics().mechanics().constraints(end_.time, g1_.data(), a_, b_);
  done_.setZero(m);
  at_end_.resize(m);
  for (int i = 0; i < m; ++i) {
    const int contact = dynamics().impulse_contact(i), row = dynamics().impulse_row(i);
    const ContactLaw& law = dynamics().law(contact);
    at_end_[i] = a_.row(row).dot(xi1_) - b_[row];
    if (strikes_[static_cast<size_t>(contact)] == 0) continue;
    if (row == law.normal) {
      if (bounces(law, row)) at_end_[i] += law.restitution * rates_[row];
      for (Eigen::Index j = 0; j < p_.size(); ++j)
        if (rows_of_p_[static_cast<size_t>(j)].row == row) done_[i] = p_[j];
    } else if (bounces(law, *law.normal)) {
      at_end_[i] += law.tangential_restitution * rates_[row];
    }
  }
  at_end_.noalias() -= metric_.lazyProduct(done_);
  // Several contacts go on as they did; of one all solutions are counted.
  const bool near = m > 0 && dynamics().impulse_contact(0) != dynamics().impulse_contact(m - 1);
  if (std::string why = dynamics().solve_impulses(metric_, at_end_, near, states_); !why.empty())
    return why;
  for (int i = 0; i < m; ++i)
    xi1_ += (dynamics().impulses()[i] - done_[i]) * dynamics().impulse_response(i);
  return "";
}

// Modes of the contacts at the node, and events where they change.
void NonsmoothKernel::take_modes(const ContactStates& before) {
  for (int i = 0; i < count(); ++i) {
    ContactState& state = states_[static_cast<size_t>(i)];
    const double none = no_speeds_[static_cast<size_t>(i)];
    state.no_slip = std::max(state.no_slip, none);
    if (dynamics().law(i).normal && dynamics().gap_rate(i) > none) state.mode = ContactMode::open;
    const Eigen::Vector2d s = dynamics().slip(i);
    if (state.mode == ContactMode::slides && s.norm() > state.no_slip) {
      state.direction = s / s.norm();
      state.begins = false;
    }
  }
  contacts_->states() = states_;
  ContactSwitch met;
  bool struck = false;
  for (int i = 0; i < count(); ++i) {
    const auto at = static_cast<size_t>(i);
    if (strikes_[at] == 0 || !(rates_[*dynamics().law(i).normal] < -no_speeds_[at])) continue;
    struck = true;
    met.events.emplace_back(dynamics().law(i).name + ".strikes", time_);
  }
  contacts_->name_changes(before, time_, met.events);
  if (met.events.empty()) return;
  state(met.after, {});
  met.before = struck ? unstruck_ : met.after;
  met.before.coordinates = met.after.coordinates;  // where no contact is below the ground
  met.before.element = met.after.element;
  contacts_->switches.push_back(std::move(met));
}

std::string NonsmoothKernel::end_step() {
  const double h = end_.time - time_;
  std::vector<ImpulseOf>& on = on_at_end_;
  on = on_;
  std::fill(pressed_.begin(), pressed_.end(), 0.);
  modes_before_ = contacts_->states();
  const ContactStates& before = modes_before_;
  const Mechanics& system = dynamics().mechanics();
  const int first = system.constraint_count() - system.holonomic_rows();
  for (Eigen::Index j = 0; j < p_.size(); ++j) {
    const auto at = static_cast<size_t>(j);
    if (rows_of_p_[at].row >= first) pressed_[static_cast<size_t>(rows_of_p_[at].contact)] = p_[j];
  }
  states_ = before;
  for (size_t i = 0; i < on.size(); ++i) {
    if (on[i] == ImpulseOf::none) continue;
    on[i] = ImpulseOf::all;
    const ContactLaw& law = dynamics().law(static_cast<int>(i));
    if (strikes_[i] != 0)  // with the friction of what slides
      states_[i].mode = law.tangential.empty() ? ContactMode::rolls : ContactMode::slides;
    const bool leaves = law.normal && !(pressed_[i] > 0) &&
                        gaps_[*law.normal - first] > std::abs(h) * no_speeds_[i];
    if (!leaves) continue;
    on[i] = ImpulseOf::none;
    states_[i].mode = ContactMode::open;
  }
  xi1_ = Eigen::Map<const Eigen::VectorXd>(end_.velocity.data(), std::ssize(end_.velocity));
  dynamics().evaluate(end_.time, g1_.data(), xi1_);
  unpushed_ = xi1_;
  std::string why = solve_end(on, h);
  bool let_go = false;
  for (size_t i = 0; i < on.size() && why.empty(); ++i) {
    const ContactLaw& law = dynamics().law(static_cast<int>(i));
    let_go |= before[i].mode == ContactMode::rolls && states_[i].mode == ContactMode::slides &&
              law.holding() > law.friction;
  }
  if (let_go) {
    xi1_ = unpushed_;
    why = solve_end(on, h);
  }
  if (!why.empty()) return why;
  time_ = end_.time;
  xi_ = xi1_;
  coordinates_ = end_.coordinates;
  velocity_.assign(xi_.begin(), xi_.end());
  g_ = g1_;
  dynamics().evaluate(time_, g_.data(), xi_);
  const bool ends = std::abs(h) >= std::abs(left_) * (1 - 1e-12);
  left_ = ends ? setup_.step : left_ - h;
  if (ends) ++whole_;
  ++steps_;
  lift_->state(measured_, {});
  put_lift(Nearby::node, velocity_, left_);
  take_modes(before);
  return "";
}

// The speeds at contacts below which there is none: of what the energy and a step's forces allow.
void NonsmoothKernel::find_no_speeds() {
  dynamics().evaluate(time_, g_.data(), xi_);
  dynamics().accelerate(all_open_);
  for (int i = 0; i < count(); ++i)
    no_speeds_[static_cast<size_t>(i)] =
        kNoSpeed *
        (dynamics().speed_scale(i) + std::abs(length_) * dynamics().acceleration_scale(i));
}

Status NonsmoothKernel::take_one() {
  const Mechanics& system = dynamics().mechanics();
  lift_->state(before_, {});
  before_.step = steps_;
  iterations_ = 0;
  if (Status status = find_length(); !status.ok || length_ == 0) {
    status.step = steps_ + 1;
    put_lift(Nearby::step, velocity_, left_);
    return status;
  }
  system.constraints(time_, g_.data(), a_, b_);
  rates_.noalias() = a_.lazyProduct(xi_) - b_;
  for (int i = 0; i < count(); ++i) {
    const auto at = static_cast<size_t>(i);
    const bool on = !dynamics().law(i).normal || contacts_->states()[at].mode != ContactMode::open;
    on_[at] = on ? ImpulseOf::all : ImpulseOf::none;
    strikes_[at] = 0;
  }
  find_no_speeds();
  states_ = contacts_->states();
  Status status = press();
  if (status.ok && others_strike()) {
    lift_->state(unstruck_, {});
    do status = press();
    while (status.ok && others_strike());
  }
  if (!status.ok || end_.time == time_) {
    status.step = steps_ + 1;
    forget_steps();
    put_lift(Nearby::step, velocity_, left_);
    return status;
  }
  if (std::string why = end_step(); !why.empty()) {
    forget_steps();
    put_lift(Nearby::step, velocity_, left_);
    return fail(why);
  }
  return {};
}

}  // namespace hamel
