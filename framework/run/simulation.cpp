#include <hamel/framework/run/simulation.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <hamel/framework/mechanics/motion.hpp>
#include <hamel/framework/schemes/erased.hpp>
#include <hamel/framework/run/measures.hpp>
#include <hamel/framework/run/plan.hpp>

namespace hamel {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void fill_row(const Snapshot& state, double energy_start, std::vector<double>& row) {
  row.clear();
  row.push_back(state.time);
  row.insert(row.end(), state.coordinates.begin(), state.coordinates.end());
  row.insert(row.end(), state.velocity.begin(), state.velocity.end());
  row.insert(row.end(),
             {state.energy, energy_error(state.energy, energy_start), state.constraint,
              state.group_defect, static_cast<double>(state.iterations), state.residual});
  row.insert(row.end(), state.momentum.begin(), state.momentum.end());
}

double largest(const std::vector<double>& values) {
  double out = 0;
  for (const double x : values) raise(out, x);
  return out;
}

// After the loop, from the rows as recorded: invariants, and errors against the exact motion.
void compare_with_exact(Result& result) {
  const size_t first = 1, dim = static_cast<size_t>(result.system.group.dim),
               coordinates = result.system.group.columns.size();
  Trajectory& rows = result.trajectory;
  const auto element = [&](size_t i) { return rows.row(i).subspan(first, coordinates); };
  const auto velocity = [&](size_t i) { return rows.row(i).subspan(first + coordinates, dim); };

  for (const Invariant& invariant : result.system.invariants) {
    InvariantDrift drift{invariant.name, invariant.value(element(0), velocity(0)), 0};
    for (size_t i = 1; i < rows.rows(); ++i) {
      raise(drift.drift_max, std::abs(invariant.value(element(i), velocity(i)) - drift.start));
    }
    result.invariants.push_back(drift);
  }
  result.exact_error_final = result.exact_error_max = result.exact_velocity_error_max = kNaN;
  if (!result.system.exact) return;
  Start start;
  start.configuration.assign(element(0).begin(), element(0).end());
  start.velocity = result.config.start.velocity;
  const ExactFlow flow = result.system.exact(start);
  std::vector<double> error(rows.rows()), velocity_error(rows.rows());
  for (size_t i = 0; i < rows.rows(); ++i) {
    const auto [g, xi] = flow(rows.at(i, 0));
    error[i] = euclidean_distance(element(i), g);
    velocity_error[i] = euclidean_distance(velocity(i), xi);
  }
  result.exact_error_final = error.back();
  result.exact_error_max = largest(error);
  result.exact_velocity_error_max = largest(velocity_error);
  rows.add_column("exact_error", error);
  rows.add_column("exact_velocity_error", velocity_error);
}

// After the loop: the multipliers lambda of A xi = b at the recorded states, from the continuous equations
// there, and their power lambda . A v in the last step before each, A v recovered from the configurations
// (Snapshot::row_rates) and lambda interpolated to the same time, `lag` before the row: round-off where
// b = 0, the power that a moving constraint feeds in where it is not.
void add_reactions(Result& result, const std::shared_ptr<const Geometry>& geometry,
                   const std::shared_ptr<const Mechanics>& mechanics,
                   const std::vector<double>& rates, double lag) {
  result.reaction_work = kNaN;
  if (geometry == nullptr || mechanics->rows() == 0) return;
  Trajectory& rows = result.trajectory;
  const size_t n = static_cast<size_t>(result.system.group.dim),
               coordinates = result.system.group.columns.size();
  const Erased problem(geometry, mechanics);
  Motion<Erased> motion(problem);
  Eigen::VectorXd g(geometry->size());
  const auto k = static_cast<size_t>(mechanics->rows());
  std::vector<std::vector<double>> lambda(k, std::vector<double>(rows.rows()));
  std::vector<double> power(rows.rows());
  double work = 0, before = 0;  // the time of the last power
  for (size_t i = 0; i < rows.rows(); ++i) {
    geometry->from_coordinates(rows.row(i).subspan(1, coordinates), g.data());
    const Eigen::VectorXd xi = Eigen::Map<const Eigen::VectorXd>(
        rows.row(i).subspan(1 + coordinates, n).data(), static_cast<Eigen::Index>(n));
    const double t = rows.at(i, 0);
    motion.solve(t, g, xi);
    const Eigen::VectorXd& reaction = motion.reaction();
    const double part = i == 0 ? 0 : lag / (t - rows.at(i - 1, 0));
    for (size_t j = 0; j < k; ++j) {
      const double now = lambda[j][i] = reaction[static_cast<Eigen::Index>(j)];
      const double there = i == 0 ? now : now - part * (now - lambda[j][i - 1]);
      power[i] += there * rates[i * k + j];
    }
    const double time = i == 0 ? t : t - lag;
    if (i > 0) work += (power[i - 1] + power[i]) / 2 * (time - before);
    before = time;
  }
  result.reaction_work = work + power.back() * (rows.at(rows.rows() - 1, 0) - before);
  for (size_t j = 0; j < k; ++j) rows.add_column("lambda" + std::to_string(j + 1), lambda[j]);
  rows.add_column("reaction_power", power);
}

}  // namespace

Integration::Integration(std::unique_ptr<Kernel> kernel, Config config, SystemModel system,
                         std::vector<std::string> notes)
    : kernel_(std::move(kernel)),
      config_(std::move(config)),
      system_(std::move(system)),
      notes_(std::move(notes)) {}

const Snapshot& Integration::state() {
  kernel_->measure(state_);
  return state_;
}

Simulation::Simulation(const Registry& registry, std::string system) : registry_(&registry) {
  config_.system = std::move(system);
}
Simulation::Simulation(const Registry& registry, std::string name, Maker make)
    : registry_(&registry), make_(std::move(make)) {
  config_.system = std::move(name);
}

Simulation& Simulation::set(const std::string& name, std::vector<double> value) {
  config_.parameters[name] = std::move(value);
  return *this;
}
Simulation& Simulation::set(const std::string& name, std::initializer_list<double> value) {
  return set(name, std::vector<double>(value));
}
Simulation& Simulation::set(const std::string& name, double value) {
  return set(name, std::vector<double>{value});
}
Simulation& Simulation::start(Start start) {
  config_.start = std::move(start);
  return *this;
}
Simulation& Simulation::scheme(std::string name) {
  config_.scheme = std::move(name);
  return *this;
}
Simulation& Simulation::s(double value) {
  config_.s = value;
  return *this;
}
Simulation& Simulation::retraction(std::string name) {
  config_.retraction = std::move(name);
  return *this;
}
Simulation& Simulation::solver(std::string name, SolverOptions options) {
  config_.solver = std::move(name);
  config_.tolerance = options.tolerance;
  return *this;
}
Simulation& Simulation::on_failure(std::string policy) {
  config_.on_failure = std::move(policy);
  return *this;
}
Simulation& Simulation::compose(std::string name) {
  config_.compose = std::move(name);
  return *this;
}
Simulation& Simulation::step(double h) {
  config_.step = h;
  return *this;
}
Simulation& Simulation::until(double t) {
  config_.until = t;
  return *this;
}
Simulation& Simulation::every(long steps) {
  config_.every = steps;
  return *this;
}
Simulation& Simulation::config(Config config) {
  config_ = std::move(config);
  return *this;
}
Simulation& Simulation::observe(std::function<bool(const Snapshot&)> observer) {
  observer_ = std::move(observer);
  return *this;
}
Simulation& Simulation::progress(std::function<void(double)> report) {
  progress_ = std::move(report);
  return *this;
}
Simulation& Simulation::kernel(KernelFactory factory, SchemeInfo scheme,
                               RetractionInfo retraction) {
  config_.scheme = scheme.name;
  config_.retraction = retraction.name;
  kernel_ = std::move(factory);
  kernel_scheme_ = std::move(scheme);
  kernel_retraction_ = std::move(retraction);
  return *this;
}

std::vector<std::string> Simulation::mistakes() const { return plan().mistakes; }

Integration Simulation::build() const {
  Plan plan = this->plan();
  if (!plan.mistakes.empty()) throw ConfigError(plan.mistakes);
  return {plan.kernel(plan.setup), plan.config, plan.system, plan.notes};
}

Result Simulation::run() const {
  Plan plan = this->plan();
  if (!plan.mistakes.empty()) throw ConfigError(plan.mistakes);
  Result result;
  result.config = plan.config;
  result.system = plan.system;
  result.notes = plan.notes;
  const std::unique_ptr<Kernel> kernel = plan.kernel(plan.setup);
  const long steps = config_.steps(), every = config_.every;
  result.trajectory = Trajectory(columns_of(result.system));
  result.trajectory.reserve(static_cast<size_t>(steps / every + 2));

  Snapshot& state = result.last;
  std::vector<double> row;
  std::vector<double> rates;  // A v, row after row of the trajectory
  const bool held = plan.mechanics->holonomic_rows() > 0;
  double energy_start = 0, holonomic_max = held ? 0.0 : kNaN;
  const auto record = [&] {
    const long recorded = row.empty() ? -1 : state.step;
    kernel->measure(state);
    if (state.step == recorded) return true;  // nothing new: a chunk failed in its first step
    if (state.step == 0) energy_start = state.energy;
    fill_row(state, energy_start, row);
    if (held) raise(holonomic_max, state.holonomic);
    rates.insert(rates.end(), state.row_rates.begin(), state.row_rates.end());
    result.trajectory.append(row);
    return !observer_ || observer_(state);
  };
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  auto next_progress = begin + std::chrono::milliseconds(200);
  bool go_on = record();
  for (long done = 0; go_on && done < steps; done += every) {
    result.status = kernel->advance(std::min(every, steps - done));
    const bool wanted = record();
    if (!result.status.ok) break;
    if (!wanted) {
      result.status.reason = to_string(Reason::stopped);
      break;
    }
    if (progress_ && Clock::now() >= next_progress) {
      progress_(static_cast<double>(done) / static_cast<double>(steps));
      next_progress = Clock::now() + std::chrono::milliseconds(200);
    }
  }
  result.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  result.steps = state.step;
  result.stats = kernel->stats();
  result.constraint_max = largest(result.trajectory.column("constraint"));
  result.group_defect_max = largest(result.trajectory.column("group_defect"));
  result.energy_error_max = largest(result.trajectory.column("energy_error"));
  result.holonomic_max = holonomic_max;
  const double lag = (1 - plan.setup.s) * plan.setup.composition.back() * plan.setup.step;
  add_reactions(result, plan.geometry, plan.mechanics, rates, lag);
  compare_with_exact(result);
  return result;
}

}  // namespace hamel
