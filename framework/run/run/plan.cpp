#include <hamel/framework/run/run/plan.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/framework/mechanics/motion_words.hpp>
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/schemes/composition.hpp>

namespace hamel {
namespace {

constexpr double kMaxNumbers = 5e8;  // 4 GB of doubles

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

std::vector<std::string> unused_options(const SchemeInfo& scheme, const Config& config) {
  std::vector<std::string> out;
  if (!scheme.uses_s) out.emplace_back("s");
  if (!scheme.places_forces) out.emplace_back("force_at");
  if (!scheme.explicit_step) return out;
  out.insert(out.end(), {"solver", "tolerance"});
  if (config.on_failure != "halve" || config.chooses_steps()) out.emplace_back("on_failure");
  return out;
}

Simulation::Plan Simulation::plan() const {
  Plan plan;
  plan.config = config_;
  plan.add(config_.mistakes());
  try {
    add_outputs(plan);
  } catch (const ConfigError& error) {
    plan.add(error.mistakes());
  }

  const bool compiled = kernel_ && config_.scheme == kernel_scheme_.name &&
                        config_.retraction == kernel_retraction_.name;
  const SchemeInfo* scheme = compiled ? &kernel_scheme_ : registry_->scheme(config_.scheme);
  if (scheme == nullptr) {
    plan.add({unknown_name("scheme", config_.scheme, registry_->schemes())});
  } else {
    plan.config.scheme = scheme->name;  // config_ may name an alias
    plan.keeps_rows = scheme->adapted;
    plan.unused = unused_options(*scheme, config_);
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
      plan.add({unknown_name("system", config_.system, registry_->systems_and_files())});
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
  plan.drive();
  const std::vector<std::string>& said = words_of(plan.system).notes;
  plan.notes.insert(plan.notes.end(), said.begin(), said.end());
  if (plan.system.group.dim == 0) {  // a product by name alone
    const std::string name = plan.system.group.name;
    if (auto group = registry_->group_or_product(name)) plan.system.group = *group;
    else plan.add({registry_->missing_group(name)});
  }
  if (plan.system.group.dim == 0) return plan;
  try {
    components_of(plan.system);  // a wrong shape() is said before anything runs
  } catch (const ConfigError& error) {
    plan.add(error.mistakes());
  }
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
    plan.kernel = plan.setup.inputs == nullptr ? kernel_ : driven_kernel_;
    if (!plan.kernel) plan.add({"inputs: the kernel of this run is compiled without them"});
  } else if (scheme != nullptr && geometry != nullptr) {
    const KernelFactory* own =
        registry_->kernel(group, *system.mechanics, config_.retraction, scheme->name);
    plan.kernel = own != nullptr ? *own : scheme->erased;
  }

  if (scheme != nullptr && geometry != nullptr) {
    plan.check_composition(*scheme, left_invariant);
    if (config_.chooses_steps()) plan.choose_steps(*scheme, left_invariant);
  }

  const double rows =
      config_.output_step       ? std::abs(config_.until - config_.from) / *config_.output_step
      : config_.chooses_steps() ? 0
                                : std::abs((config_.until - config_.from) / config_.step) /
                                      static_cast<double>(config_.every);
  const auto width = static_cast<double>(system.group.columns.size()) + 2 * system.group.dim + 7;
  const bool in_memory = records_.empty() && !rows_kept_;
  const double disk = numbers_that_fit(records_);
  const double times =
      config_.output_step ? kMaxNumbers * width : disk;  // of the rows: they are kept
  const double most = in_memory ? kMaxNumbers : std::min(disk, times);
  const char* where = in_memory || most < disk ? "memory holds" : "there is room for on the disk";
  if ((config_.output_step || rows < 9e15) && rows * width > most) {
    const bool resumed = !resumed_.empty();  // as it was run, and no other way
    const char* what = resumed ? "continue" : config_.output_step ? "output_step" : "every";
    std::string mistake =
        fmt::format("{}: {:.3g} rows would be recorded, more than {}", what, rows, where);
    if (!resumed && !config_.output_step && 2 * width <= most) {  // the first and the last
      mistake += fmt::format("; record every {:.0f} steps or more",
                             std::ceil(rows * static_cast<double>(config_.every) * width / most));
    }
    plan.add({mistake});
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
  plan.watch();
  if (!plan.mistakes.empty()) return plan;
  if (const double end = config_.from + static_cast<double>(config_.steps()) * config_.step;
      !config_.chooses_steps() &&
      std::abs(end - config_.until) > 1e-9 * std::abs(config_.until - config_.from)) {
    plan.notes.push_back(
        fmt::format("the run ends at t = {:.10g}: whole steps of {} do not reach {}", end,
                    config_.step, config_.until));
  }
  if (config_.no_exact || !impacts_.empty()) plan.system.exact = nullptr;
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

// The tolerances, where the scheme can do with them.
void Simulation::Plan::choose_steps(const SchemeInfo& scheme, bool left_invariant) {
  setup.relative = config.relative();
  setup.absolute = config.absolute();
  setup.first_chosen = scheme.estimates_error && config.step == Config().step;
  if (scheme.estimates_error || !scheme.defined(left_invariant)) return;
  const ClaimedOrder claim =
      scheme.claim(config.s, geometry->traits(), *mechanics, config.force_at);
  setup.order = claim.order;
  for (const Composition& c : compositions()) {
    if (c.name == config.compose && c.coefficients.size() > 1) setup.order = c.order;
  }
  if (scheme.varies_steps && claim.reversible) return;
  add(
      {fmt::format("rtol: {}{} takes steps of one size; dopri5, tsit5 and dop853 choose theirs by "
                   "the error, lift and "
                   "balance where they are reversible, at s = 0.5",
                   scheme.name, scheme.uses_s ? fmt::format(" with s = {}", config.s) : "")});
}

void Simulation::Plan::drive() {
  if (config.inputs.empty()) return;
  setup.inputs = make_inputs(system, config.inputs, {config.from, config.until}, mistakes);
  if (setup.inputs == nullptr) return;
  setup.inputs->enter(config.from, config.step);
  hamel::drive(system, setup.inputs);
}

}  // namespace hamel
