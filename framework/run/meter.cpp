#include <hamel/framework/run/meter.hpp>

namespace hamel {
namespace {

// Either the names or the values of what it is called with.
struct Names {
  std::vector<std::string>& out;
  void operator()(const char* name, double) { out.emplace_back(name); }
  void operator()(const std::vector<std::string>& names, const std::vector<double>&) {
    out.insert(out.end(), names.begin(), names.end());
  }
  template <class List>
  void operator()(const std::string& name, long count, const List&) {
    for (long i = 1; i <= count; ++i) out.push_back(name + std::to_string(i));
  }
};
struct Values {
  std::vector<double>& out;
  void operator()(const char*, double value) { out.push_back(value); }
  void operator()(const std::vector<std::string>&, const std::vector<double>& values) {
    out.insert(out.end(), values.begin(), values.end());
  }
  template <class List>
  void operator()(const char*, long, const List& values) {
    out.insert(out.end(), values.begin(), values.end());
  }
};

// The columns of a state, in order.
template <class Row>
void state_columns(const SystemModel& system, const Snapshot& state, double energy_error, Row row) {
  row("t", state.time);
  row(system.group.columns, state.coordinates);
  row("xi", system.group.dim, state.velocity);
  row("energy", state.energy);
  row(kEnergyError.name, energy_error);
  row(kConstraint.name, state.constraint);
  row(kGroupDefect.name, state.group_defect);
  row("iterations", static_cast<double>(state.iterations));
  row(kResidual.name, state.residual);
  row("mu", system.group.dim, state.momentum);
}

// Those of the constraint's reactions, and of the exact motion.
template <class Row>
void reaction_columns(const Eigen::VectorXd& lambda, double power, Row row) {
  row("lambda", lambda.size(), lambda);
  row(kReactionPower.name, power);
}
template <class Row>
void exact_columns(double error, double velocity_error, Row row) {
  row(kExactError.name, error);
  row(kExactVelocityError.name, velocity_error);
}

}  // namespace

std::vector<std::string> columns_of(const SystemModel& system) {
  std::vector<std::string> out;
  state_columns(system, {}, 0, Names{out});
  return out;
}

Meter::Meter(const SystemModel& system, const Start& start,
             std::shared_ptr<const Geometry> geometry, std::shared_ptr<const Mechanics> mechanics,
             double lag)
    : system_(system),
      start_(start),
      columns_(columns_of(system)),
      geometry_(std::move(geometry)),
      lag_(lag) {
  if (mechanics->holonomic_rows() > 0) all_.holonomic_max = 0;
  if (geometry_ != nullptr && mechanics->rows() > 0) {
    motion_ = std::make_unique<Motion>(geometry_, mechanics);
    all_.reaction_work = 0;
    g_.resize(geometry_->size());
    lambda_.resize(mechanics->rows());
    reaction_columns(lambda_, 0, Names{columns_});
  }
  if (system.exact) {
    all_.exact_error_final = all_.exact_error_max = all_.exact_velocity_error_max = 0;
    exact_columns(0, 0, Names{columns_});
  }
}

void Meter::take(const Snapshot& state) {
  if (first_) energy_start_ = state.energy;
  row_.clear();
  state_columns(system_, state, all_.take(state, energy_start_), Values{row_});
}

void Meter::compare(const Snapshot& state) {
  if (motion_ != nullptr) react(state);
  for (size_t i = 0; i < system_.invariants.size(); ++i) {
    const Invariant& invariant = system_.invariants[i];
    const double value = invariant.value(state.coordinates, state.velocity);
    if (first_) all_.invariants.push_back({invariant.name, value, 0});
    else raise(all_.invariants[i].drift_max, value - all_.invariants[i].start);
  }
  if (system_.exact) {
    if (first_) exact_ = system_.exact({.configuration = state.coordinates, .velocity = start_.velocity});
    const auto [element, velocity] = exact_(state.time);
    const auto [error, velocity_error] = all_.compare(state, element, velocity);
    exact_columns(error, velocity_error, Values{row_});
  }
  first_ = false;
}

void Meter::react(const Snapshot& state) {
  geometry_->from_coordinates(state.coordinates, g_.data());
  xi_ = Eigen::Map<const Eigen::VectorXd>(state.velocity.data(),
                                          static_cast<Eigen::Index>(state.velocity.size()));
  (*motion_)(state.time, g_.data(), xi_);
  const Eigen::VectorXd& now = motion_->reaction();
  const double part = first_ ? 0 : lag_ / (state.time - time_);
  double power = 0;
  for (Eigen::Index j = 0; j < now.size(); ++j) {
    const double there = first_ ? now[j] : now[j] - part * (now[j] - lambda_[j]);
    power += there * state.row_rates[static_cast<size_t>(j)];
  }
  const double at = first_ ? state.time : state.time - lag_;
  if (!first_) all_.reaction_work += (power_ + power) / 2 * (at - power_time_);
  lambda_ = now;
  time_ = state.time;
  power_ = power;
  power_time_ = at;
  reaction_columns(lambda_, power, Values{row_});
}

Measurements Meter::finish() {
  if (motion_ != nullptr) all_.reaction_work += power_ * (time_ - power_time_);
  return std::move(all_);
}

}  // namespace hamel
