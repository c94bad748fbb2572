#include <hamel/framework/simulate.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <hamel/framework/composition.hpp>
#include <hamel/framework/frame.hpp>

namespace hamel {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kMaxNumbers = 5e8;  // 4 GB of doubles

std::vector<double> to_vector(const Eigen::VectorXd& v) { return {v.begin(), v.end()}; }

bool finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

std::vector<std::string> columns_of(const SystemModel& system) {
  std::vector<std::string> out = {"t"};
  out.insert(out.end(), system.group.columns.begin(), system.group.columns.end());
  for (int i = 1; i <= system.group.dim; ++i) out.push_back(fmt::format("xi{}", i));
  for (const char* name :
       {"energy", "energy_error", "constraint", "group_defect", "iterations", "residual"}) {
    out.emplace_back(name);
  }
  for (int i = 1; i <= system.group.dim; ++i) out.push_back(fmt::format("mu{}", i));
  return out;
}

void fill_row(const Snapshot& state, double energy_start, std::vector<double>& row) {
  row.clear();
  row.push_back(state.time);
  row.insert(row.end(), state.coordinates.begin(), state.coordinates.end());
  row.insert(row.end(), state.velocity.begin(), state.velocity.end());
  const double scale = energy_start != 0 ? std::abs(energy_start) : 1.0;
  row.insert(row.end(),
             {state.energy, (state.energy - energy_start) / scale, state.constraint,
              state.group_defect, static_cast<double>(state.iterations), state.residual});
  row.insert(row.end(), state.momentum.begin(), state.momentum.end());
}

double distance(std::span<const double> a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i < b.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

double largest(const std::vector<double>& values) {
  double out = 0;
  for (double x : values) out = std::isfinite(x) ? std::max(out, std::abs(x)) : kNaN;
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
      drift.drift_max = std::max(drift.drift_max,
                                 std::abs(invariant.value(element(i), velocity(i)) - drift.start));
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
    error[i] = distance(element(i), g);
    velocity_error[i] = distance(velocity(i), xi);
  }
  result.exact_error_final = error.back();
  result.exact_error_max = largest(error);
  result.exact_velocity_error_max = largest(velocity_error);
  rows.add_column("exact_error", error);
  rows.add_column("exact_velocity_error", velocity_error);
}

}  // namespace

// Everything that a run needs, or everything that is wrong.
struct Simulation::Plan {
  std::vector<std::string> mistakes, notes;
  Config config;
  SystemModel system;
  KernelSetup setup;
  KernelFactory kernel;

  void add(const std::vector<std::string>& more) {
    mistakes.insert(mistakes.end(), more.begin(), more.end());
  }
};

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

Simulation::Plan Simulation::plan() const {
  Plan plan;
  plan.config = config_;
  plan.add(config_.mistakes());

  const bool compiled = kernel_ && config_.scheme == kernel_scheme_.name &&
                        config_.retraction == kernel_retraction_.name;
  const SchemeInfo* scheme = compiled ? &kernel_scheme_ : registry_->scheme(config_.scheme);
  if (scheme == nullptr) plan.add({unknown_name("scheme", config_.scheme, registry_->schemes())});
  const SolverInfo* solver = registry_->solver(config_.solver);
  if (solver == nullptr) plan.add({unknown_name("solver", config_.solver, registry_->solvers())});
  else if (solver->make) plan.setup.solver = solver->make();
  std::vector<std::string> tables;
  for (const Composition& c : compositions()) {
    tables.push_back(c.name);
    if (c.name == config_.compose) plan.setup.composition = c.coefficients;
  }
  if (std::find(tables.begin(), tables.end(), config_.compose) == tables.end()) {
    plan.add({unknown_name("composition", config_.compose, tables)});
  }

  // The system with its parameters; nothing below makes sense without it.
  Maker make = make_;
  if (!make) {
    const SystemInfo* info = registry_->system(config_.system);
    if (info == nullptr) {
      plan.add({unknown_name("system", config_.system, registry_->systems())});
      return plan;
    }
    make = info->make;
  }
  try {
    plan.system = make(config_.parameters);
  } catch (const ConfigError& error) {
    plan.add(error.mistakes());
    return plan;
  } catch (const std::invalid_argument& error) {
    plan.add({fmt::format("{}: {}", config_.system, error.what())});
    return plan;
  }
  const SystemModel& system = plan.system;
  const int n = system.group.dim;
  const auto matrix_mistakes = check_system_matrices(system.inertia, system.constraints, n);
  plan.add(matrix_mistakes);

  // The start: the user's, else the system's own, else rest at the identity.
  Start& start = plan.config.start;
  if (!start.velocity.empty() && !start.momentum.empty()) {
    plan.add({"start: give velocity or momentum, not both"});
  }
  if (start.velocity.empty() && start.momentum.empty()) {
    start.velocity = system.start.velocity;
    start.momentum = system.start.momentum;
    if (start.velocity.empty() && start.momentum.empty()) {
      plan.add(
          {fmt::format("start: {} has no default start; give velocity or momentum", system.name)});
    }
  }
  if (start.configuration.empty()) start.configuration = system.start.configuration;
  if (start.configuration.empty()) start.configuration = system.group.identity;
  try {
    start.configuration = system.group.element(start.configuration);
  } catch (const std::invalid_argument& error) {
    plan.add({fmt::format("configuration: {}", error.what())});
  }
  for (const auto& [name, values] :
       {std::pair{"velocity", &start.velocity}, std::pair{"momentum", &start.momentum}}) {
    if (values->empty()) continue;
    if (values->size() != static_cast<size_t>(n)) {
      plan.add({fmt::format("{}: got {} values, expected {} for {}", name, values->size(), n,
                            system.group.name)});
    } else if (!finite(*values)) {
      plan.add({fmt::format("{}: {} is not finite", name, join(*values))});
    }
  }

  // The kernel compiled for this group, number of directions, retraction and scheme.
  const int m = n - static_cast<int>(system.constraints.rows());
  if (compiled) {
    plan.kernel = kernel_;
  } else if (registry_->group(system.group.name) == nullptr) {
    plan.add(
        {fmt::format("group '{}' has no compiled kernels: call hamel::add_group<...>() once, or "
                     "use simulate<Scheme, Retraction>(system)",
                     system.group.name)});
  } else if (registry_->retraction(system.group.name, config_.retraction) == nullptr) {
    plan.add({unknown_name("retraction of " + system.group.name, config_.retraction,
                           registry_->retractions(system.group.name))});
  } else if (scheme != nullptr && matrix_mistakes.empty()) {
    const KernelFactory* factory = registry_->kernel(system.group.name, scheme->adapted ? m : n,
                                                     config_.retraction, config_.scheme);
    if (factory != nullptr) plan.kernel = *factory;
    else
      plan.add({fmt::format("no kernel for {} with {} and {}", system.group.name,
                            config_.retraction, config_.scheme)});
  }

  const double rows = std::abs(config_.until / config_.step) / static_cast<double>(config_.every);
  if (rows * static_cast<double>(columns_of(system).size()) > kMaxNumbers) {
    plan.add(
        {fmt::format("every: {:.3g} rows would be recorded, more than memory holds; record "
                     "every {:.0f} steps or more",
                     rows,
                     std::ceil(rows * static_cast<double>(config_.every) *
                               static_cast<double>(columns_of(system).size()) / kMaxNumbers))});
  }
  if (!plan.mistakes.empty()) return plan;

  // mu_bar = E^T mu, and what the projection dropped.
  const Eigen::MatrixXd frame = hamel_frame(system.inertia, system.constraints);
  const bool by_velocity = !start.velocity.empty();
  const auto& given = by_velocity ? start.velocity : start.momentum;
  const Eigen::VectorXd datum = Eigen::Map<const Eigen::VectorXd>(given.data(), n);
  const Eigen::VectorXd mu = by_velocity ? Eigen::VectorXd(system.inertia * datum) : datum;
  const Eigen::VectorXd mu_bar = frame.transpose() * mu, velocity = frame * mu_bar;
  const Eigen::VectorXd dropped =
      datum - (by_velocity ? velocity : Eigen::VectorXd(system.inertia * velocity));
  if (dropped.norm() > 1e-12 * datum.norm()) {
    plan.notes.push_back(fmt::format("the start's {} was projected onto {}: dropped ({})",
                                     by_velocity ? "velocity" : "momentum",
                                     by_velocity ? "d" : "d*", join(to_vector(dropped))));
  }
  start.velocity = to_vector(velocity);
  start.momentum.clear();
  for (const Field& field : system.fields) plan.config.parameters[field.name] = field.value;

  const Eigen::MatrixXd whole = hamel_frame(system.inertia, Eigen::MatrixXd(0, n));
  plan.setup.inertia = system.inertia;
  plan.setup.constraints = system.constraints;
  plan.setup.frame = scheme->adapted ? frame : whole;
  plan.setup.momentum =
      scheme->adapted ? mu_bar : Eigen::VectorXd(whole.transpose() * (system.inertia * velocity));
  plan.setup.s = config_.s;
  plan.setup.step = config_.step;
  plan.setup.tolerance = config_.tolerance;
  plan.setup.configuration = start.configuration;
  return plan;
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
  double energy_start = 0;
  const auto record = [&] {
    const long recorded = row.empty() ? -1 : state.step;
    kernel->measure(state);
    if (state.step == recorded) return true;  // nothing new: a chunk failed in its first step
    if (state.step == 0) energy_start = state.energy;
    fill_row(state, energy_start, row);
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
  compare_with_exact(result);
  return result;
}

}  // namespace hamel
