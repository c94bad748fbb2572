#include <hamel/framework/run/run/plan/plan.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/run/run/contacts/contact_kernel.hpp>
#include <hamel/framework/run/run/contacts/nonsmooth_kernel.hpp>
#include <hamel/framework/schemes/composition.hpp>
#include <hamel/framework/schemes/nonsmooth.hpp>

namespace hamel {
namespace {

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

void plan_composition(const Config& config, Method& method, Mistakes& mistakes) {
  std::vector<std::string> names;
  for (const Composition& c : compositions()) {
    names.push_back(c.name);
    if (c.name != config.compose) continue;
    method.setup.composition = c.coefficients;
    if (c.coefficients.size() > 1) method.composition_order = c.order;
  }
  if (std::find(names.begin(), names.end(), config.compose) == names.end())
    mistakes.add(unknown_name("composition", config.compose, names));
}

// The function that makes the system; empty, with a mistake, where there is none of this name.
std::function<SystemModel(const Parameters&)> maker_of(const Registry& registry,
                                                       const Config& config, const OwnSystem* own,
                                                       Mistakes& mistakes) {
  if (own != nullptr) return own->make;
  if (names_file(config.system)) return data_system_maker(registry, config.system);
  if (const SystemInfo* info = registry.system(config.system)) return info->make;
  mistakes.add(unknown_name("system", config.system, registry.systems_and_files()));
  return {};
}

// A composition has its order only over a reversible step.
void check_composition(const Config& config, const SchemeInfo& scheme, const ClaimedOrder& claim,
                       Mistakes& mistakes) {
  if (config.compose == "none" || config.force || claim.reversible) return;
  mistakes.add(
      fmt::format("compose: {} raises the order of a reversible step, and {} with s = {} and {} "
                  "claims none here: "
                  "take s = 0.5 where the scheme has it, or force it",
                  config.compose, scheme.name, config.s, config.retraction));
}

// The tolerances, where the scheme can choose its steps by them.
void choose_steps(const Config& config, const SchemeInfo& scheme, const ClaimedOrder& claim,
                  Method& method, Mistakes& mistakes) {
  method.setup.errors = config.errors();
  if (config.step_max) method.setup.largest = *config.step_max;
  method.setup.first_chosen = scheme.estimates_error && !config.step;
  if (scheme.estimates_error) return;
  method.setup.order = method.composition_order > 0 ? method.composition_order : claim.order;
  if (scheme.varies_steps && claim.reversible) return;
  mistakes.add(
      fmt::format("rtol: {}{} takes steps of one size; dopri5, tsit5 and dop853 choose theirs by "
                  "the error, lift and "
                  "balance where they are reversible, at s = 0.5",
                  scheme.name, scheme.uses_s ? fmt::format(" with s = {}", config.s) : ""));
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

Method plan_method(const Registry& registry, const Config& config, const OwnSystem* own,
                   Mistakes& mistakes) {
  Method out;
  out.compiled = own != nullptr && own->kernel && config.scheme == own->scheme.name &&
                 config.retraction == own->retraction.name;
  out.scheme = out.compiled ? &own->scheme : registry.scheme(config.scheme);
  out.setup.s = config.s;
  if (out.scheme == nullptr) {
    mistakes.add(unknown_name("scheme", config.scheme, registry.schemes()));
  } else {
    out.unused = unused_options(*out.scheme, config);
    if (!out.scheme->uses_s) out.setup.s = out.scheme->fixed_s;
  }
  const SolverInfo* solver = registry.solver(config.solver);
  if (solver == nullptr) mistakes.add(registry.missing_solver(config.solver));
  else if (solver->make) out.setup.solver = solver->make();
  mistakes.add(read_on_failure(config, registry, out.setup));
  plan_composition(config, out, mistakes);
  if (config.force_at != "nodes" && config.force_at != "base")
    mistakes.add(unknown_name("force_at", config.force_at, {"nodes", "base"}));
  if (config.force_at == "base") out.setup.force_at = ForceAt::base;
  out.setup.from = config.from;
  out.setup.step = config.step_or_usual();
  out.setup.tolerance = config.tolerance;
  return out;
}

std::optional<PlannedSystem> plan_system(const Registry& registry, const Config& config,
                                         const OwnSystem* own, Mistakes& mistakes) {
  const auto make = maker_of(registry, config, own, mistakes);
  if (!make) return {};
  PlannedSystem out;
  try {
    out.model = std::make_shared<SystemModel>(make(config.parameters));
  } catch (const ConfigError& error) {
    mistakes.add(error.mistakes());
    return {};
  } catch (const std::invalid_argument& error) {
    mistakes.add(fmt::format("{}: {}", config.system, error.what()));
    return {};
  }
  SystemModel& system = *out.model;
  mistakes.add(out_of_range(system.name, system.fields));
  out.notes = no_rigid_body(system.name, system.fields);
  if (!config.inputs.empty()) {
    out.inputs = make_inputs(system, config.inputs, {config.from, config.until}, mistakes.all());
    if (out.inputs != nullptr) {
      out.inputs->enter(config.from, config.step_or_usual());
      drive(system, out.inputs);
    }
  }
  try {
    if (!registry.complete(system)) mistakes.add(registry.missing_group(system.group.name));
  } catch (const ConfigError& error) {
    mistakes.add(error.mistakes());
  }
  const std::vector<std::string>& notes = system.notes;
  out.notes.insert(out.notes.end(), notes.begin(), notes.end());
  if (!system.has_names) return {};
  return out;
}

KernelFactory plan_kernel(const Registry& registry, const Config& config, const OwnSystem* own,
                          const PlannedSystem& planned,
                          const std::shared_ptr<const Geometry>& geometry, Method& method,
                          Mistakes& mistakes) {
  if (method.scheme == nullptr) return {};
  const SchemeInfo& scheme = *method.scheme;
  const Mechanics& mechanics = *planned.model->mechanics;
  KernelFactory out;
  if (!scheme.defined(mechanics.left_invariant())) {
    mistakes.add(
        fmt::format("scheme: {} is defined for left-invariant systems only; lift and balance are "
                    "offered here",
                    scheme.name));
    return out;
  }
  if (!planned.model->contact_laws.empty()) {
    const SchemeInfo* registered = registry.scheme(scheme.name);
    method.erased = true;
    if (registered != nullptr) out = registered->erased;
    else
      mistakes.add(fmt::format("scheme: {} is not registered, as contacts need it", scheme.name));
  } else if (method.compiled) {
    out = planned.inputs == nullptr ? own->kernel : own->driven;
    if (!out) mistakes.add("inputs: the kernel of this run is compiled without them");
  } else if (geometry != nullptr) {
    const KernelFactory* compiled =
        registry.kernel(planned.model->group.name, mechanics, config.retraction, scheme.name);
    method.erased = compiled == nullptr;
    out = compiled != nullptr ? *compiled : scheme.erased;
  }
  if (geometry == nullptr) return out;
  const ClaimedOrder claim =
      scheme.claim(method.setup.s, geometry->traits(), mechanics, config.force_at);
  check_composition(config, scheme, claim, mistakes);
  if (config.chooses_steps()) choose_steps(config, scheme, claim, method, mistakes);
  return out;
}

namespace {

// The geometry of the run; null, with a mistake, where group or retraction are not registered.
std::shared_ptr<const Geometry> plan_geometry(const Registry& registry, const Config& config,
                                              const OwnSystem* own, const Method& method,
                                              const std::string& group, Mistakes& mistakes) {
  if (method.compiled) return own->retraction.geometry;
  auto out = registry.geometry(group, config.retraction);
  if (out != nullptr) return out;
  const auto offered = registry.retractions_or_common(group);
  if (offered.empty()) {
    mistakes.add(
        fmt::format("group '{}' is not registered: call hamel::add_group<...>() once, or "
                    "use simulate<Scheme, Retraction>(system)",
                    group));
  } else {
    mistakes.add(unknown_name("retraction of " + group, config.retraction, offered));
  }
  return out;
}

// The exact motion, where the run can be compared with it.
void restrict_exact(const RunRequest& request, SystemModel& system,
                    std::vector<std::string>& notes) {
  if (request.config.no_exact || !request.impacts.empty()) system.exact = nullptr;
  if (request.config.from == 0 || !system.exact || system.mechanics->autonomous()) return;
  system.exact = nullptr;
  notes.emplace_back("the exact motion is known from t = 0 on only: there is no comparison");
}

void note_end_and_unused(const Config& config, const Method& method,
                         std::vector<std::string>& notes) {
  const double step = config.step_or_usual();
  const double end = config.from + static_cast<double>(config.steps()) * step;
  if (!config.chooses_steps() &&
      std::abs(end - config.until) > 1e-9 * std::abs(config.until - config.from)) {
    notes.push_back(fmt::format("the run ends at t = {:.10g}: whole steps of {} do not reach {}",
                                end, step, config.until));
  }
  if (config.step && config.chooses_steps() && !method.scheme->estimates_error)
    notes.emplace_back("step is not the first one: the reversible control begins with its own");
  if (config.step_max && !config.chooses_steps())
    notes.emplace_back("step_max is not used by steps of one size");
  for (const std::string& option : method.unused) {
    if (!config.is_default(option))
      notes.push_back(fmt::format("{} is not used by {}", option, method.scheme->name));
  }
}

// The resolved configuration.
Config resolved(Config config, const Method& method, const SystemModel& system,
                const Start& start) {
  config.scheme = method.scheme->name;  // it may have been an alias
  config.s = method.setup.s;
  config.start = start;
  config.speed.reset();
  config.start_values.clear();
  for (const Field& field : system.fields)
    if (!field.value.empty()) config.parameters[field.name] = field.value;
  return config;
}

}  // namespace

KernelFactory RunPlan::run_kernel() const {
  return contacts == nullptr ? kernel : with_contacts(smooth, geometry, *system, contacts);
}

RunPlan plan_run(const Registry& registry, const RunRequest& request, const OwnSystem* own,
                 Rows rows, Mistakes& mistakes) {
  const Config config = request.config.completed();
  RunPlan plan;
  plan.recording = keeps_rows(request, rows);
  mistakes.add(config.mistakes());
  plan.outputs = plan_outputs(request, mistakes);
  Method method = plan_method(registry, config, own, mistakes);
  const std::optional<PlannedSystem> planned = plan_system(registry, config, own, mistakes);
  if (!planned) return plan;
  SystemModel& system = *planned->model;
  PlannedStart start = plan_start(system, config, mistakes);
  plan.geometry = plan_geometry(registry, config, own, method, system.group.name, mistakes);
  check_contacts(system, config, method.scheme, mistakes);
  evaluate_start(system, planned->inputs, plan.geometry.get(), config, start, mistakes);
  if (planned->inputs != nullptr && plan.geometry != nullptr && mistakes.none())
    check_jumps_of_rates(system, *planned->inputs, *plan.geometry, config, start, mistakes);
  plan.kernel = plan_kernel(registry, config, own, *planned, plan.geometry, method, mistakes);
  if (plan.recording) check_rows(request, system.group, mistakes);
  if (method.scheme != nullptr && !method.scheme->takes_massless_links() && mistakes.none() &&
      !is_definite(start.inertia)) {
    mistakes.add(fmt::format(
        "scheme: {} needs a definite inertia; with massless links lift, balance and the "
        "explicit schemes are offered",
        method.scheme->name));
  }
  if (!mistakes.none()) return plan;

  project_start(system, start);
  plan.config = resolved(config, method, system, start.start);
  plan.keeps_rows = method.scheme->adapted;
  plan.compiled = !method.erased;
  plan.unused = method.unused;
  if (!system.contact_laws.empty()) {
    plan.contacts = std::make_shared<RunContacts>(plan.geometry, system);
    const KernelFactory* compiled = registry.kernel(system.group.name, *system.mechanics,
                                                    config.retraction, plan.config.scheme);
    plan.smooth = {plan.kernel, compiled != nullptr ? *compiled : plan.kernel};
    plan.with_contacts = method.scheme->name == Nonsmooth::name()
                             ? &kernels_with_contacts<NonsmoothKernel>
                             : &kernels_with_contacts<ContactKernel>;
    plan.kernel = plan.with_contacts(plan.smooth, plan.geometry, system, nullptr);
    system.exact = nullptr;
  }
  plan.reactions = reactions_of(plan.geometry, system.mechanics, planned->inputs, plan.contacts);
  if (!system.sensors.empty() && plan.geometry != nullptr)
    plan.motion = plan.reactions != nullptr
                      ? plan.reactions
                      : std::make_shared<Reactions>(plan.geometry, system.mechanics,
                                                    planned->inputs, plan.contacts);
  plan.events = std::make_unique<Events>(system, plan.reactions, config.events, config.stop_at,
                                         mistakes.all());
  plan.events->begin(state_of(start.start, config.from), mistakes.all());
  plan.notes = planned->notes;
  plan.notes.insert(plan.notes.end(), start.notes.begin(), start.notes.end());
  note_end_and_unused(config, method, plan.notes);
  restrict_exact(request, system, plan.notes);
  if (request.config.leaves_method()) {
    plan.notes.push_back(
        fmt::format("no scheme or step given: {} at rtol = {:g}{}", config.scheme, *config.rtol,
                    config.check || system.exact ? "" : "; error unknown (--check)"));
  }
  plan.setup = std::move(method.setup);
  plan.setup.geometry = plan.geometry;
  plan.setup.mechanics = system.mechanics;
  plan.setup.inputs = planned->inputs;
  plan.setup.configuration = start.start.configuration;
  plan.setup.velocity = start.start.velocity;
  plan.system = planned->model;
  return plan;
}

}  // namespace hamel
