#include <hamel/framework/run/run/rows/run_recorder.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {
namespace {

double value_of(const Invariant& invariant, const Snapshot& state) {
  return invariant.energy ? state.energy : invariant.value(state.coordinates, state.velocity);
}

}  // namespace

Reason flaw_of(const Snapshot& state) {
  const auto finite = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
  };
  if (!finite(state.coordinates) || !finite(state.velocity) || !std::isfinite(state.energy) ||
      !std::isfinite(state.holonomic) || !std::isfinite(state.group_defect))
    return Reason::not_finite;
  return std::isfinite(state.constraint) ? Reason::converged : Reason::outside_domain;
}

RunRecorder::RunRecorder(const SystemModel& system, const Start& start, EnergyBalance balance,
                         std::shared_ptr<Reactions> reactions, std::shared_ptr<Reactions> motion,
                         PathLengths paths)
    : system_(system),
      start_(start),
      balance_(std::move(balance)),
      paths_(std::move(paths)),
      columns_(system, {.holonomic = system.mechanics->holonomic_rows() > 0,
                        .work = balance_.active(),
                        .reactions = reactions != nullptr,
                        .reaction_power = reactions != nullptr,
                        .exact = static_cast<bool>(system.exact),
                        .acceleration = motion != nullptr,
                        .modes = reactions != nullptr && reactions->contacts() != nullptr,
                        .paths = paths_.active(),
                        .friction_works = balance_.friction_count() > 0}),
      pulls_(system.contacts.size()),
      of_rows_(std::move(reactions)),
      motion_(std::move(motion)) {
  const auto& mechanics = system.mechanics;
  if (balance_.active()) {
    notes_.push_back(
        "work is done: the energy error is the defect of the energy balance; forces or moving "
        "constraints do it, and the error is relative to the largest energy");
  }
  const bool holonomic = mechanics->holonomic_rows() > 0;
  all_holonomic_ = holonomic && mechanics->holonomic_rows() == mechanics->constraint_count();
  drifts_ = mechanics->has_drift();
  if (holonomic) all_.holonomic_max = 0;
  if (of_rows_ != nullptr) {
    all_.reaction_work = 0;
    lambda_.resize(mechanics->constraint_count());
  }
  if (system.exact)
    all_.exact_error_final = all_.exact_error_max = all_.exact_velocity_error_max = 0;
}

void RunRecorder::begin(const Snapshot& start) {
  energy_start_ = start.energy;
  time_start_ = start.time;
  start_configuration_ = start.coordinates;
  for (const Invariant& invariant : system_.invariants) {
    all_.invariants.push_back({invariant.name, value_of(invariant, start), 0});
  }
  if (of_rows_ != nullptr) react(start, true);
}

void RunRecorder::impact(const Snapshot& before, const Snapshot& after) {
  energy_start_ += after.energy - before.energy;
  for (size_t i = 0; i < system_.invariants.size(); ++i)
    all_.invariants[i].start +=
        value_of(system_.invariants[i], after) - value_of(system_.invariants[i], before);
  if (balance_.active()) balance_.impact(before, after);
  if (paths_.active()) paths_.impact(after);
}

void RunRecorder::take(const Snapshot& state) {
  last_row_ = state.time;
  all_.take(state, energy_start_);
}

void RunRecorder::compare(const Snapshot& state) {
  // Work, error and paths are known when they are settled.
  if (balance_.active()) balance_.row(state);
  if (paths_.active()) paths_.row(state);
  StateExtras extras{.energy_start = energy_start_};
  if (of_rows_ != nullptr) {
    react(state);
    extras.reactions = {lambda_.data(), static_cast<std::size_t>(lambda_.size())};
    extras.reaction_power = power_;
  }
  if (motion_ != nullptr) {
    const Eigen::VectorXd& rate = motion_->acceleration(state);
    extras.acceleration = {rate.data(), static_cast<std::size_t>(rate.size())};
  }
  std::vector<double> modes;
  if (of_rows_ != nullptr && of_rows_->contacts() != nullptr) {
    modes = of_rows_->contacts()->mode_numbers();
    extras.modes = modes;
  }
  look_at_invariants(state);
  if (system_.exact)
    std::tie(extras.exact_error, extras.exact_velocity_error) = look_at_exact(state);
  const std::size_t at = rows_.size();
  rows_.resize(at + columns_.size());
  const std::size_t count = columns_.size() - columns_.output_count();
  for (std::size_t i = 0; i < count; ++i) rows_[at + i] = columns_.value(i, state, extras);
  settle();
}

void RunRecorder::look_at_invariants(const Snapshot& state) {
  for (size_t i = 0; i < system_.invariants.size(); ++i) {
    const double value = value_of(system_.invariants[i], state);
    update_max_abs(all_.invariants[i].drift_max, value - all_.invariants[i].start);
  }
}

std::pair<double, double> RunRecorder::look_at_exact(const Snapshot& state) {
  if (!exact_) exact_ = exact_from_start();
  const auto [element, velocity] = exact_(state.time - time_start_);
  const auto errors = all_.compare(state, element, velocity);
  if (!exact_lost_ && !std::isfinite(errors.first) && std::isfinite(state.energy)) {
    exact_lost_ = true;
    notes_.push_back(fmt::format(
        "the exact motion was not followed to t = {:.6g}: it turns too fast", state.time));
  }
  return errors;
}

// Completes rows whose work and paths are known; the end of a run may be none.
void RunRecorder::settle() {
  const std::size_t width = columns_.size(), all = rows_.size() / width, before = complete_;
  if (balance_.active()) settle_work(all);
  if (paths_.active()) settle_paths(all);
  complete_ = std::min(balance_.active() ? balanced_ : all, paths_.active() ? measured_ : all);
  for (std::size_t row = before; row < complete_; ++row)
    columns_.complete(std::span(rows_).subspan(row * width, width));
}

void RunRecorder::settle_work(std::size_t all) {
  const std::size_t energy_error = *columns_.find(StateColumns::Of::energy_error),
                    work = *columns_.find(StateColumns::Of::work);
  balance_.settled(settled_);
  const std::size_t first = columns_.find(StateColumns::Of::friction_work).value_or(0),
                    count = balance_.friction_count();
  for (std::size_t i = 0; i < settled_.size() && balanced_ < all; ++i) {
    double* row = rows_.data() + columns_.size() * balanced_++;
    row[energy_error] = settled_[i].defect / settled_[i].scale;
    row[work] = settled_[i].work;
    std::copy_n(balance_.friction_works().data() + i * count, count, row + first);
  }
}

void RunRecorder::settle_paths(std::size_t all) {
  paths_.settled(lengths_);
  const std::size_t count = paths_.count();
  for (std::size_t at = 0; at < lengths_.size() && measured_ < all; at += count) {
    double* row = rows_.data() + columns_.size() * measured_++;
    std::size_t next = at;
    for (std::size_t i = 0; i < columns_.size(); ++i)
      if (columns_.of(i) == StateColumns::Of::path) row[i] = lengths_[next++];
  }
}

void RunRecorder::drop_rows() {
  rows_.erase(rows_.begin(),
              rows_.begin() + static_cast<std::ptrdiff_t>(complete_ * columns_.size()));
  balanced_ -= std::min(balanced_, complete_);
  measured_ -= std::min(measured_, complete_);
  complete_ = 0;
}

void RunRecorder::follow_exact(double time) {
  if (!system_.exact) return;
  if (!exact_) exact_ = exact_from_start();
  exact_(time - time_start_);
}

ExactFlow RunRecorder::exact_from_start() const {
  return system_.exact({.configuration = start_configuration_, .velocity = start_.velocity});
}

// The start is the first state, and may be a row as well.
void RunRecorder::react(const Snapshot& state, bool start) {
  if (!start && state.time == time_) return;
  const Eigen::VectorXd& now = of_rows_->at(state);
  const double part = start ? 0 : state.time_offset / (state.time - time_);
  const bool modes = of_rows_->contacts() != nullptr;
  double power = modes ? of_rows_->contacts()->reaction_power() : 0;
  for (Eigen::Index j = 0; j < now.size() && !modes; ++j) {
    const double there = start ? now[j] : now[j] - part * (now[j] - lambda_[j]);
    power += there * state.constraint_rates[static_cast<size_t>(j)];
  }
  const double at = start ? state.time : state.time - state.time_offset;
  if (start) {
    second_power_ = power;
    second_time_ = at;
  } else {
    all_.reaction_work += (power_ + power) / 2 * (at - power_time_);
    if (odd_) add_second(power, at);
    odd_ = !odd_;
  }
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
                    system_.reactions.empty() ? fmt::format("lambda{}", row + 1)
                                              : system_.reactions[static_cast<size_t>(row)]));
  }
}

void RunRecorder::add_second(double power, double at) {
  second_work_ += (second_power_ + power) / 2 * (at - second_time_);
  second_power_ = power;
  second_time_ = at;
}

// Work of moving constraints, by the trapezoids over all states and over every second one: a
// third of the difference is the error of the first.
void RunRecorder::look_at_reaction_work() {
  if (!drifts_) return;
  if (odd_) add_second(power_, power_time_);
  const double error = std::abs(all_.reaction_work - second_work_) / 3;
  if (!(error > std::max(0.01 * std::abs(all_.reaction_work), 1e-12 * std::abs(energy_start_))))
    return;
  notes_.push_back(
      fmt::format("the work of reactions is summed over the rows, and known to about {:.1g} J: "
                  "record more rows, or take shorter steps",
                  error));
}

void RunRecorder::finish(const Snapshot& last) {
  finish_rows(last);
  if (all_holonomic_) all_.constraint_max = Measurements::kNone;  // of no row
}

void RunRecorder::finish_rows(const Snapshot& last) {
  if (last.time != last_row_) {
    all_.take(last, energy_start_);
    if (balance_.active()) balance_.row(last);
    if (paths_.active()) paths_.row(last);
    if (of_rows_ != nullptr) react(last);
    look_at_invariants(last);
    if (system_.exact) look_at_exact(last);
  }
  if (of_rows_ != nullptr) {
    look_at_reaction_work();
    all_.reaction_work += power_ * (time_ - power_time_);
  }
  if (paths_.active()) paths_.finish();
  if (balance_.active()) balance_.finish();
  settle();
  if (!balance_.active()) return;
  all_.balance(balance_.error_max(), balance_.work());
}

}  // namespace hamel
