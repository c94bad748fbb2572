#include <hamel/framework/plan.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/composition.hpp>
#include <hamel/framework/frame.hpp>

namespace hamel {
namespace {

constexpr double kMaxNumbers = 5e8;  // 4 GB of doubles

std::vector<double> to_vector(const Eigen::VectorXd& v) { return {v.begin(), v.end()}; }

bool finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

// "stop", "halve", "retry:<solver>"; returns what is wrong.
std::vector<std::string> read_on_failure(const Config& config, const Registry& registry,
                                         KernelSetup& setup) {
  const std::string& policy = config.on_failure;
  if (policy == "stop") return {};
  if (policy == "halve") {
    setup.on_failure = OnFailure::halve;
    return {};
  }
  const std::string retry = "retry:";
  if (!policy.starts_with(retry)) {
    return {unknown_name("on_failure", policy, {"stop", "halve", "retry:<solver>"})};
  }
  const std::string other = policy.substr(retry.size());
  const SolverInfo* solver = registry.solver(other);
  if (solver == nullptr) return {"on_failure: " + registry.missing_solver(other)};
  if (other == config.solver) {
    return {fmt::format("on_failure: got '{}', expected another solver than '{}'", policy, other)};
  }
  setup.on_failure = OnFailure::retry;
  setup.fallback_name = other;
  if (solver->make) setup.fallback = solver->make();
  return {};
}

}  // namespace

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

Simulation::Plan Simulation::plan() const {
  Plan plan;
  plan.config = config_;
  plan.add(config_.mistakes());

  const bool compiled = kernel_ && config_.scheme == kernel_scheme_.name &&
                        config_.retraction == kernel_retraction_.name;
  const SchemeInfo* scheme = compiled ? &kernel_scheme_ : registry_->scheme(config_.scheme);
  if (scheme == nullptr) plan.add({unknown_name("scheme", config_.scheme, registry_->schemes())});
  const SolverInfo* solver = registry_->solver(config_.solver);
  if (solver == nullptr) plan.add({registry_->missing_solver(config_.solver)});
  else if (solver->make) plan.setup.solver = solver->make();
  plan.add(read_on_failure(config_, *registry_, plan.setup));
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

}  // namespace hamel
