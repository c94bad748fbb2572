#include <hamel/framework/run/plan.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/framework/run/data_system.hpp>
#include <hamel/framework/schemes/composition.hpp>

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

std::vector<std::string> unused_options(const SchemeInfo& scheme, const std::string& on_failure) {
  std::vector<std::string> out;
  if (!scheme.uses_s) out.emplace_back("s");
  if (!scheme.places_forces) out.emplace_back("force_at");
  if (!scheme.explicit_step) return out;
  out.insert(out.end(), {"solver", "tolerance"});
  if (on_failure != "halve") out.emplace_back("on_failure");
  return out;
}

Simulation::Plan Simulation::plan() const {
  Plan plan;
  plan.config = config_;
  plan.add(config_.mistakes());

  const bool compiled = kernel_ && config_.scheme == kernel_scheme_.name &&
                        config_.retraction == kernel_retraction_.name;
  const SchemeInfo* scheme = compiled ? &kernel_scheme_ : registry_->scheme(config_.scheme);
  if (scheme == nullptr) {
    plan.add({unknown_name("scheme", config_.scheme, registry_->schemes())});
  } else {
    plan.config.scheme = scheme->name;  // config_ may name an alias
    plan.keeps_rows = scheme->adapted;
    plan.unused = unused_options(*scheme, config_.on_failure);
    if (!scheme->uses_s) plan.config.s = scheme->fixed_s;
  }
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
  const std::string& place = config_.force_at;
  if (place != "nodes" && place != "base") {
    plan.add({unknown_name("force_at", place, {"nodes", "base"})});
  }
  plan.setup.forces_at_base = place == "base";

  // The system with its parameters, which everything below needs.
  Maker make = make_;
  if (!make && config_.system.ends_with(".toml")) {
    make = data_system_maker(*registry_, config_.system);
  }
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
  plan.add(out_of_range(plan.system.name, plan.system.fields));
  plan.notes = no_rigid_body(plan.system.name, plan.system.fields);
  if (plan.system.group.dim == 0) {  // a product by name alone
    const std::string name = plan.system.group.name;
    if (auto group = registry_->group_or_product(name)) plan.system.group = *group;
    else plan.add({registry_->missing_group(name)});
  }
  if (plan.system.group.dim == 0) return plan;
  plan.fill_start();
  const SystemModel& system = plan.system;
  const std::string& group = system.group.name;

  // The kernel: the user's own, the one compiled for this problem, or the erased one.
  const auto& geometry = plan.geometry =
      compiled ? kernel_retraction_.geometry : registry_->geometry(group, config_.retraction);
  if (!compiled) {
    const auto offered = registry_->retractions_or_common(group);
    if (offered.empty()) {
      plan.add(
          {fmt::format("group '{}' is not registered: call hamel::add_group<...>() once, or "
                       "use simulate<Scheme, Retraction>(system)",
                       group)});
    } else if (geometry == nullptr) {
      plan.add({unknown_name("retraction of " + group, config_.retraction, offered)});
    }
  }
  plan.look_at_start();
  const bool left_invariant = system.mechanics->left_invariant();
  if (scheme != nullptr && !scheme->defined(left_invariant)) {
    plan.add(
        {fmt::format("scheme: {} is defined for left-invariant systems only; lift and balance are "
                     "offered here",
                     scheme->name)});
  } else if (compiled) {
    plan.kernel = kernel_;
  } else if (scheme != nullptr && geometry != nullptr) {
    const KernelFactory* own =
        registry_->kernel(group, *system.mechanics, config_.retraction, scheme->name);
    plan.kernel = own != nullptr ? *own : scheme->erased;
  }

  if (scheme != nullptr && geometry != nullptr) plan.check_composition(*scheme, left_invariant);

  const double rows =
      std::abs((config_.until - config_.from) / config_.step) / static_cast<double>(config_.every);
  const auto width = static_cast<double>(system.group.columns.size()) + 2 * system.group.dim + 7;
  if (rows < 9e15 && rows * width > kMaxNumbers) {
    plan.add({fmt::format(
        "every: {:.3g} rows would be recorded, more than memory holds; record "
        "every {:.0f} steps or more",
        rows, std::ceil(rows * static_cast<double>(config_.every) * width / kMaxNumbers))});
  }
  if (scheme != nullptr && !scheme->steps_admissible && plan.mistakes.empty() &&
      !is_definite(plan.inertia)) {
    plan.add(
        {fmt::format("scheme: {} needs a definite inertia; with massless links lift and "
                     "balance are offered",
                     scheme->name)});
  }
  if (!plan.mistakes.empty()) return plan;
  plan.project();
  if (const double end = config_.from + static_cast<double>(config_.steps()) * config_.step;
      std::abs(end - config_.until) > 1e-9 * std::abs(config_.until - config_.from)) {
    plan.notes.push_back(
        fmt::format("the run ends at t = {:.10g}: whole steps of {} do not reach {}", end,
                    config_.step, config_.until));
  }
  if (config_.no_exact) plan.system.exact = nullptr;
  if (config_.from != 0 && plan.system.exact && !plan.mechanics->autonomous()) {
    plan.system.exact = nullptr;
    plan.notes.push_back("the exact motion is known from t = 0 on only: there is no comparison");
  }
  plan.setup.from = config_.from;
  for (const std::string& option : plan.unused) {
    if (config_.text(option) != Config().text(option)) {
      plan.notes.push_back(fmt::format("{} is not used by {}", option, plan.config.scheme));
    }
  }
  plan.setup.s = plan.config.s;
  plan.setup.step = config_.step;
  plan.setup.tolerance = config_.tolerance;
  for (const Field& field : system.fields) plan.config.parameters[field.name] = field.value;
  return plan;
}

// A composition has its order only over a reversible step.
void Simulation::Plan::check_composition(const SchemeInfo& scheme, bool left_invariant) {
  if (config.compose == "none" || config.force || !scheme.defined(left_invariant)) return;
  const ClaimedOrder claim =
      scheme.claim(config.s, geometry->traits(), *mechanics, config.force_at);
  if (claim.reversible) return;
  add(
      {fmt::format("compose: {} raises the order of a reversible step, and {} with s = {} and {} "
                   "claims none here: "
                   "take s = 0.5 where the scheme has it, or force it",
                   config.compose, scheme.name, config.s, config.retraction)});
}

// The user's start, else the system's own, else rest at the identity.
void Simulation::Plan::fill_start() {
  Start& start = config.start;
  if (!start.velocity.empty() && !start.momentum.empty()) {
    add({"start: give velocity or momentum, not both"});
  }
  if (start.velocity.empty() && start.momentum.empty()) {
    start.velocity = system.start.velocity;
    start.momentum = system.start.momentum;
    if (start.velocity.empty() && start.momentum.empty()) {
      add({fmt::format("start: {} has no default start; give velocity or momentum", system.name)});
    }
  }
  if (start.configuration.empty()) start.configuration = system.start.configuration;
  if (start.configuration.empty()) start.configuration = system.group.identity;
  try {
    start.configuration = system.group.element(start.configuration);
  } catch (const std::invalid_argument& error) {
    add({fmt::format("configuration: {}", error.what())});
    start.configuration = system.group.identity;
  }
  const auto n = static_cast<size_t>(system.group.dim);
  for (const auto& [name, values] :
       {std::pair{"velocity", &start.velocity}, std::pair{"momentum", &start.momentum}}) {
    if (values->empty()) continue;
    if (values->size() != n) {
      add({fmt::format("{}: got {} values, expected {} for {}", name, values->size(), n,
                       system.group.name)});
    } else if (!finite(*values)) {
      add({fmt::format("{}: {} is not finite", name, join(*values))});
    }
  }
}

// I, A and b where the run starts, checked.
void Simulation::Plan::look_at_start() {
  const int n = system.group.dim;
  mechanics = system.mechanics;
  inertia = Eigen::MatrixXd::Identity(n, n);
  constraints.resize(0, n);
  Eigen::VectorXd g;
  if (geometry != nullptr) {
    g.resize(geometry->size());
    geometry->from_coordinates(config.start.configuration, g.data());
  } else if (!mechanics->left_invariant()) {
    return;
  }
  constraints.resize(mechanics->rows(), mechanics->dim());
  inertia.resize(mechanics->dim(), mechanics->dim());
  drift.resize(mechanics->rows());
  mechanics->inertia(g.data(), inertia);
  mechanics->constraints(config.from, g.data(), constraints, drift);
  Eigen::VectorXd phi(mechanics->holonomic_rows());
  mechanics->holonomic(g.data(), phi);
  if (phi.size() > 0 && !(phi.lpNorm<Eigen::Infinity>() < 1e-13)) satisfy(phi, g);
  add(check_system_matrices(inertia, constraints, n));
}

// Onto phi(g) = 0 by Newton's method, g <- g tau(-I^-1 A^T (A I^-1 A^T)^-1 phi), A the rows of phi: the start may be the
// last state of a run whose scheme keeps phi only to its order.
void Simulation::Plan::satisfy(Eigen::VectorXd phi, Eigen::VectorXd& g) {
  constexpr double most = 0.01;
  const Eigen::Index held = phi.size();
  const double off = phi.lpNorm<Eigen::Infinity>();
  for (int k = 0; k < 10 && off <= most && !(phi.lpNorm<Eigen::Infinity>() < 1e-15); ++k) {
    const Eigen::MatrixXd a = constraints.bottomRows(held);
    const Eigen::MatrixXd reach = inertia.ldlt().solve(a.transpose());
    const Eigen::VectorXd move = -reach * (a * reach).ldlt().solve(phi);
    Eigen::VectorXd turn(g.size());
    geometry->tau(move.data(), turn.data());
    geometry->compose(g.data(), turn.data(), g.data());
    mechanics->inertia(g.data(), inertia);
    mechanics->constraints(config.from, g.data(), constraints, drift);
    mechanics->holonomic(g.data(), phi);
  }
  if (!(phi.lpNorm<Eigen::Infinity>() < 1e-12)) {
    add({fmt::format("configuration: {} does not satisfy the holonomic constraint, phi = {:.3g}",
                     join(config.start.configuration), off)});
    return;
  }
  geometry->coordinates(g.data(), config.start.configuration.data());
  if (off > 1e-9) {
    notes.push_back(fmt::format(
        "the start's configuration was moved onto the holonomic constraint: phi was {:.3g}", off));
  }
}

// The admissible start, E^T I xi = E^T mu, and what the projection dropped.
void Simulation::Plan::project() {
  Start& start = config.start;
  const Eigen::Index n = inertia.rows();
  const Eigen::MatrixXd frame = hamel_frame(inertia, constraints);
  const bool by_velocity = !start.velocity.empty();
  const auto& given = by_velocity ? start.velocity : start.momentum;
  const Eigen::VectorXd datum = Eigen::Map<const Eigen::VectorXd>(given.data(), n);
  const Eigen::VectorXd mu = by_velocity ? Eigen::VectorXd(inertia * datum) : datum;
  const Eigen::VectorXd mu_bar = frame.transpose() * mu;
  Eigen::VectorXd velocity = frame * mu_bar;
  if (drift.size() > 0) {  // E y + xi_b with A xi_b = b and E^T I xi_b = 0
    const Eigen::VectorXd some =
        constraints.transpose() * (constraints * constraints.transpose()).ldlt().solve(drift);
    velocity += some - frame * (frame.transpose() * (inertia * some));
  }
  const Eigen::VectorXd dropped =
      datum - (by_velocity ? velocity : Eigen::VectorXd(inertia * velocity));
  if (dropped.norm() > 1e-12 * datum.norm()) {
    notes.push_back(fmt::format("the start's {} was projected onto {}: dropped ({})",
                                by_velocity ? "velocity" : "momentum", by_velocity ? "d" : "d*",
                                join(to_vector(dropped))));
  }
  start.velocity = to_vector(velocity);
  start.momentum.clear();

  setup.geometry = geometry;
  setup.mechanics = mechanics;
  setup.velocity = velocity;
  setup.configuration = start.configuration;
}

}  // namespace hamel
