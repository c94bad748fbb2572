// A step of the scheme nonsmooth: impulses at its beginning, and at its end.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/run/run/nonsmooth_kernel.hpp>

namespace hamel {
namespace {

// Secants of P; changes of gamma, relative to its terms, that end them, and that still will do.
constexpr int kSecants = 40;
constexpr double kSolved = 1e-15, kWillDo = 1e-11;
// Moves of gamma whose secant is not round-off.
constexpr double kSecant = 1e-6;

}  // namespace

Status NonsmoothKernel::take_step(const Eigen::VectorXd& p) {
  pushed_ = xi_ + given_;
  for (Eigen::Index i = 0; i < p.size(); ++i) pushed_ += p[i] * responses_.col(i);
  lift_->restart(time_, coordinates_, std::span(pushed_.data(), velocity_.size()), length_);
  lift_->set_end_time(limit_);
  const Status status = lift_->advance(1);
  if (!status.ok) return status;
  lift_->node(end_);
  setup_.geometry->from_coordinates(end_.coordinates, g1_.data());
  dynamics().mechanics().holonomic(g1_.data(), gaps_);
  return status;
}

// An input that jumps or bends within a step ends it there.
Status NonsmoothKernel::find_length() {
  length_ = left_;
  if (setup_.inputs == nullptr) return {};
  const Status status = lift_->advance(1);  // from the node
  length_ = lift_->time() - time_;
  return status;
}

Status NonsmoothKernel::find_gamma(Eigen::VectorXd& out) {
  const Mechanics& system = dynamics().mechanics();
  const double h = end_.time - time_;
  Eigen::VectorXd middle(g_.size()), move(xi_.size());
  setup_.geometry->inverse(g_.data(), middle.data());
  setup_.geometry->compose(middle.data(), g1_.data(), middle.data());
  if (!setup_.geometry->tau_inverse(middle.data(), move.data()))
    return fail("nonsmooth: the step leaves the domain of the retraction");
  const Eigen::VectorXd half = move / 2;
  setup_.geometry->tau(half.data(), middle.data());
  setup_.geometry->compose(g_.data(), middle.data(), middle.data());
  system.constraints(time_ + h / 2, middle.data(), a_, b_);
  const int first = system.constraint_count() - system.holonomic_rows();
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const int row = rows_of_p_[static_cast<size_t>(i)];
    if (row >= first) out[i] = gaps_[row - first] / h;
    else out[i] = a_.row(row).dot(move) / h - b_[row];
  }
  return {};
}

// The impulses P of the contacts that are on, and the step behind them.
Status NonsmoothKernel::press() {
  dynamics().evaluate(time_, g_.data(), xi_);
  double speed = 0;  // that the energy allows
  for (int i = 0; i < count(); ++i)
    if (on_[static_cast<size_t>(i)] != ImpulseOf::none)
      speed = std::max(speed, dynamics().speed_scale(i));
  dynamics().set_up_impulses(contacts_->states(), on_, length_ / 2, true);
  const int m = dynamics().impulse_count();
  given_ = dynamics().given_change();
  responses_.resize(xi_.size(), m);
  rows_of_p_.resize(static_cast<size_t>(m));
  contacts_of_p_.resize(static_cast<size_t>(m));
  for (int i = 0; i < m; ++i) {
    responses_.col(i) = dynamics().impulse_response(i);
    rows_of_p_[static_cast<size_t>(i)] = dynamics().impulse_row(i);
    contacts_of_p_[static_cast<size_t>(i)] = dynamics().impulse_contact(i);
  }
  dynamics().impulse_metric(metric_);
  p_.setZero(m);
  Status status = take_step(p_);
  if (!status.ok || m == 0) return status;
  gamma_.resize(m);
  if (status = find_gamma(gamma_); !status.ok) return status;
  Eigen::VectorXd now(m), move(m), missed(m), best = p_;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kSecants; ++k) {
    const Eigen::VectorXd c = gamma_ - metric_ * p_;
    states_ = contacts_->states();
    if (std::string why = dynamics().solve_impulses(metric_, c, k > 0, states_); !why.empty())
      return fail(why);
    move = dynamics().impulses() - p_;
    p_ += move;
    status = take_step(p_);
    if (!status.ok) return status;
    ++iterations_;
    if (status = find_gamma(now); !status.ok) return status;
    missed = now - gamma_ - metric_ * move;
    const double size = std::max(c.lpNorm<Eigen::Infinity>(), speed);
    const double error = size > 0 ? missed.lpNorm<Eigen::Infinity>() / size : 0;
    gamma_ = now;
    if (error < least) {
      least = error;
      best = p_;
    } else if (least < kWillDo) {
      break;
    }
    if (error <= kSolved) break;
    if (dynamics().shared() || !((metric_ * move).lpNorm<Eigen::Infinity>() > kSecant * size))
      continue;
    const Eigen::VectorXd weighted = metric_.diagonal().cwiseProduct(move);
    metric_ += missed * weighted.transpose() / weighted.dot(move);
  }
  if (!(least <= kWillDo))
    return fail(fmt::format("nonsmooth: the impulses of the step were not found in {} secants: "
                            "smaller steps",
                            kSecants),
                least);
  if (p_ == best) return status;
  p_ = best;
  return take_step(p_);
}

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
  Eigen::VectorXd done = Eigen::VectorXd::Zero(m), c(m);
  for (int i = 0; i < m; ++i) {
    const int contact = dynamics().impulse_contact(i), row = dynamics().impulse_row(i);
    const ContactLaw& law = dynamics().law(contact);
    c[i] = a_.row(row).dot(xi1_) - b_[row];
    if (strikes_[static_cast<size_t>(contact)] == 0) continue;
    if (row == law.normal) {
      if (bounces(law, row)) c[i] += law.restitution * rates_[row];
      for (Eigen::Index j = 0; j < p_.size(); ++j)
        if (rows_of_p_[static_cast<size_t>(j)] == row) done[i] = p_[j];
    } else if (bounces(law, *law.normal)) {
      c[i] += law.tangential_restitution * rates_[row];
    }
  }
  c -= metric_ * done;
  if (std::string why = dynamics().solve_impulses(metric_, c, false, states_); !why.empty())
    return why;
  for (int i = 0; i < m; ++i)
    xi1_ += (dynamics().impulses()[i] - done[i]) * dynamics().impulse_response(i);
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
  std::vector<ImpulseOf> on = on_;
  std::vector<double> pressed(on_.size(), 0);  // by P
  const ContactStates before = contacts_->states();
  const Mechanics& system = dynamics().mechanics();
  const int first = system.constraint_count() - system.holonomic_rows();
  for (Eigen::Index j = 0; j < p_.size(); ++j) {
    const auto at = static_cast<size_t>(j);
    if (rows_of_p_[at] >= first) pressed[static_cast<size_t>(contacts_of_p_[at])] = p_[j];
  }
  states_ = before;
  for (size_t i = 0; i < on.size(); ++i) {
    if (on[i] == ImpulseOf::none) continue;
    on[i] = ImpulseOf::all;
    const ContactLaw& law = dynamics().law(static_cast<int>(i));
    if (strikes_[i] != 0)  // with the friction of what slides
      states_[i].mode = law.tangential.empty() ? ContactMode::rolls : ContactMode::slides;
    const bool leaves =
        law.normal && !(pressed[i] > 0) && gaps_[*law.normal - first] > std::abs(h) * no_speeds_[i];
    if (!leaves) continue;
    on[i] = ImpulseOf::none;
    states_[i].mode = ContactMode::open;
  }
  xi1_ = Eigen::Map<const Eigen::VectorXd>(end_.velocity.data(), std::ssize(end_.velocity));
  dynamics().evaluate(end_.time, g1_.data(), xi1_);
  const Eigen::VectorXd unpushed = xi1_;
  std::string why = solve_end(on, h);
  bool let_go = false;
  for (size_t i = 0; i < on.size() && why.empty(); ++i) {
    const ContactLaw& law = dynamics().law(static_cast<int>(i));
    let_go |= before[i].mode == ContactMode::rolls && states_[i].mode == ContactMode::slides &&
              law.holding() > law.friction;
  }
  if (let_go) {
    xi1_ = unpushed;
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
  lift_->restart(time_, coordinates_, velocity_, left_);
  lift_->set_end_time(limit_);
  take_modes(before);
  return "";
}

// The speeds at contacts below which there is none: of what the energy and a step's forces allow.
void NonsmoothKernel::find_no_speeds() {
  dynamics().evaluate(time_, g_.data(), xi_);
  dynamics().accelerate(ContactStates(static_cast<size_t>(count())));
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
    lift_->restart(time_, coordinates_, velocity_, left_);
    lift_->set_end_time(limit_);
    return status;
  }
  system.constraints(time_, g_.data(), a_, b_);
  rates_ = a_ * xi_ - b_;
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
    lift_->restart(time_, coordinates_, velocity_, left_);
    lift_->set_end_time(limit_);
    return status;
  }
  if (std::string why = end_step(); !why.empty()) {
    lift_->restart(time_, coordinates_, velocity_, left_);
    return fail(why);
  }
  return {};
}

}  // namespace hamel
