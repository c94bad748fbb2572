#include <hamel/framework/run/meter.hpp>

#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/mechanics/motion_words.hpp>

namespace hamel {

Meter::Meter(const SystemModel& system, const Start& start,
             std::shared_ptr<const Geometry> geometry, std::shared_ptr<const Mechanics> mechanics,
             const std::shared_ptr<const Mechanics>& acting, std::shared_ptr<const Inputs> inputs)
    : system_(system),
      start_(start),
      balance_(geometry, acting, std::move(inputs)),
      pulls_(system.contacts.size()),
      geometry_(std::move(geometry)) {
  if (balance_.active()) {
    notes_.push_back(
        "forces or moving constraints do work: the energy error is the defect of the energy "
        "balance, relative to the largest energy");
  }
  holonomic_ = mechanics->holonomic_rows() > 0;
  if (holonomic_) all_.holonomic_max = 0;
  if (geometry_ != nullptr && mechanics->rows() > 0) {
    motion_ = std::make_unique<EquationsOfMotion<Erased>>(Erased(geometry_, mechanics));
    all_.reaction_work = 0;
    g_.resize(geometry_->size());
    lambda_.resize(mechanics->rows());
  }
  if (system.exact)
    all_.exact_error_final = all_.exact_error_max = all_.exact_velocity_error_max = 0;
}

void Meter::add(const char* name, double value) {
  if (first_) columns_.push_back(name);
  row_.push_back(value);
}
void Meter::add(const std::vector<std::string>& names, std::span<const double> values) {
  if (first_) columns_.insert(columns_.end(), names.begin(), names.end());
  row_.insert(row_.end(), values.begin(), values.end());
}
void Meter::add_numbered(const char* name, std::span<const double> values) {
  for (size_t i = 1; first_ && i <= values.size(); ++i)
    columns_.push_back(name + std::to_string(i));
  row_.insert(row_.end(), values.begin(), values.end());
}

void Meter::take(const Snapshot& state) {
  if (first_) {
    energy_start_ = state.energy;
    time_start_ = state.time;
  }
  const double error = all_.take(state, energy_start_);
  row_.clear();
  add("t", state.time);
  add(system_.group.columns, state.coordinates);
  add_numbered("xi", state.velocity);
  add("energy", state.energy);
  add(kEnergyError.name, error);
  add(kConstraint.name, state.constraint);
  add(kGroupDefect.name, state.group_defect);
  add("iterations", static_cast<double>(state.iterations));
  add(kResidual.name, state.residual);
  if (holonomic_) add(kHolonomic.name, state.holonomic);
  add_numbered("mu", state.momentum);
}

void Meter::compare(const Snapshot& state) {
  if (balance_.active()) {
    balance_.row(state);
    add(kWork.name, 0);  // until finish
  }
  if (motion_ != nullptr) react(state);
  for (size_t i = 0; i < system_.invariants.size(); ++i) {
    const Invariant& invariant = system_.invariants[i];
    const double value = invariant.value(state.coordinates, state.velocity);
    if (first_) all_.invariants.push_back({invariant.name, value, 0});
    else raise(all_.invariants[i].drift_max, value - all_.invariants[i].start);
  }
  if (system_.exact) {
    if (first_)
      exact_ = system_.exact({.configuration = state.coordinates, .velocity = start_.velocity});
    const auto [element, velocity] = exact_(state.time - time_start_);
    const auto [error, velocity_error] = all_.compare(state, element, velocity);
    add(kExactError.name, error);
    add(kExactVelocityError.name, velocity_error);
    if (!exact_lost_ && !std::isfinite(error) && std::isfinite(state.energy)) {
      exact_lost_ = true;
      notes_.push_back(fmt::format(
          "the exact motion was not followed to t = {:.6g}: it turns too fast", state.time));
    }
  }
  first_ = false;
}

void Meter::react(const Snapshot& state) {
  geometry_->from_coordinates(state.coordinates, g_.data());
  xi_ = Eigen::Map<const Eigen::VectorXd>(state.velocity.data(),
                                          static_cast<Eigen::Index>(state.velocity.size()));
  motion_->solve(state.time, g_, xi_);
  const Eigen::VectorXd& now = motion_->reaction();
  const double part = first_ ? 0 : state.lag / (state.time - time_);
  double power = 0;
  for (Eigen::Index j = 0; j < now.size(); ++j) {
    const double there = first_ ? now[j] : now[j] - part * (now[j] - lambda_[j]);
    power += there * state.row_rates[static_cast<size_t>(j)];
  }
  const double at = first_ ? state.time : state.time - state.lag;
  if (!first_) all_.reaction_work += (power_ + power) / 2 * (at - power_time_);
  lambda_ = now;
  time_ = state.time;
  power_ = power;
  power_time_ = at;
  for (size_t i = 0; i < pulls_.size(); ++i) {
    const int row = system_.contacts[i];
    if (pulls_[i] || !(now[row] < -1e-9 * now.lpNorm<Eigen::Infinity>())) continue;
    pulls_[i] = true;
    notes_.push_back(
        fmt::format("the contact pulls from t = {:.6g} on, {} < 0: a body that is not held "
                    "would lift off",
                    state.time,
                    words_of(system_).reactions.empty()
                        ? fmt::format("lambda{}", row + 1)
                        : words_of(system_).reactions[static_cast<size_t>(row)]));
  }
  const std::span<const double> lambda(lambda_.data(), static_cast<size_t>(lambda_.size()));
  if (words_of(system_).reactions.empty()) add_numbered("lambda", lambda);
  else add(words_of(system_).reactions, lambda);
  add(kReactionPower.name, power);
}

Measurements Meter::finish(Trajectory& rows) {
  if (motion_ != nullptr) all_.reaction_work += power_ * (time_ - power_time_);
  if (balance_.active()) {
    const size_t error = rows.index(kEnergyError.name), work = rows.index(kWork.name);
    const std::vector<BalancedState> balance = balance_.rows();
    all_.balance(balance);
    for (size_t i = 0; i < rows.rows(); ++i) {
      rows.at(i, error) = balance[i].error;
      rows.at(i, work) = balance[i].work;
    }
  }
  return std::move(all_);
}

}  // namespace hamel
