#include <hamel/framework/run/run/simulation.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/run/run/driver.hpp>
#include <hamel/framework/run/run/estimate_error.hpp>

namespace hamel {
namespace {

void add_notes(Result& result, long impacts) {
  constexpr double far = 0.3;
  const char* or_check = result.config.check ? "" : ", or check";
  if (result.rotation_per_step_max > far && !result.config.chooses_steps()) {
    result.notes.push_back(fmt::format(
        "take a smaller step{}: a step turns by up to {:.2g} rad, and more than {} rarely follows "
        "the motion, whatever the diagnostics say",
        or_check, result.rotation_per_step_max, far));
  }
  if (impacts > 0) {
    result.notes.push_back(fmt::format(
        "{} impact{} changed the state, which is no error of the energy or of an invariant; the "
        "run ends at t = {:.10g}",
        impacts, impacts > 1 ? "s" : "", result.last.time));
  }
  constexpr double percent = 0.01;
  // Where the energy is 0 at the start, or nearly, its change is compared with the kinetic energy.
  const Snapshot& last = result.last;
  double kinetic = 0;
  for (size_t i = 0; i < std::min(last.velocity.size(), last.momentum.size()); ++i)
    kinetic += 0.5 * last.velocity[i] * last.momentum[i];
  const bool small = std::any_of(
      result.invariants.begin(), result.invariants.end(), [&](const InvariantDrift& kept) {
        return kept.name == "energy" && std::abs(kept.start) + kept.drift_max < percent * kinetic;
      });
  if (!std::isfinite(result.work) && result.energy_error_max > percent && !small) {
    result.notes.push_back(
        fmt::format("take a smaller step{}: the energy changes by {:.2g} of its size though "
                    "nothing does work",
                    or_check, result.energy_error_max));
  }
}

// The limit of a run that leaves out constraints is another motion.
void check_error(const Registry& registry, const RunRequest& request, const OwnSystem* own,
                 const RunPlan& plan, Result& result) {
  if (!request.config.check || !result.status.ok) return;
  if (plan.keeps_rows || plan.setup.mechanics->constraint_count() == 0)
    return estimate_error(registry, request, own, result);
  result.notes.push_back(
      fmt::format("check: {} leaves out constraints: its limit is another motion, and nothing is "
                  "known of its error",
                  result.config.scheme));
}

}  // namespace

Simulation::Simulation(const Registry& registry, std::string system) : registry_(&registry) {
  request_.config.system = std::move(system);
}
Simulation::Simulation(const Registry& registry, std::string name, OwnSystem own)
    : registry_(&registry), own_(std::make_shared<const OwnSystem>(std::move(own))) {
  request_.config.system = std::move(name);
  if (!own_->kernel) return;
  request_.config.scheme = own_->scheme.name;
  request_.config.retraction = own_->retraction.name;
}
Simulation::Simulation(const Simulation&) = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(const Simulation&) = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Simulation& Simulation::set(const std::string& name, std::vector<double> value) {
  request_.config.parameters[name] = std::move(value);
  return *this;
}
Simulation& Simulation::input(const std::string& name, double value) {
  return input(name, InputSignal(value));
}
Simulation& Simulation::input(const std::string& name, InputSignal signal) {
  request_.config.inputs[name] = std::move(signal);
  return *this;
}
Simulation& Simulation::start(const std::string& name, double value) {
  request_.config.start_values.push_back(fmt::format("{}={}", name, value));
  return *this;
}
Simulation& Simulation::on_event(const std::string& name, Impact impact) {
  request_.config.events.push_back(name);
  request_.impacts[name] = std::move(impact);
  return *this;
}
Simulation& Simulation::config(Config config) {
  request_.config = std::move(config);
  return *this;
}
Simulation& Simulation::record_to(std::string path) {
  request_.records.push_back(std::move(path));
  return *this;
}

Simulation Simulation::unobserved() const {
  Simulation out = *this;
  out.request_.observer = {};
  out.request_.progress = {};
  out.request_.records.clear();
  out.request_.rows_kept.reset();
  out.request_.resumed.clear();
  Config& config = out.request_.config;
  config.output_times.clear();
  config.output_step.reset();
  config.check = false;
  config.no_exact = true;
  return out;
}

std::vector<std::string> Simulation::mistakes() const {
  Mistakes mistakes;
  plan_run(*registry_, request_, own_.get(), Rows::always, mistakes);
  return mistakes.all();
}

std::shared_ptr<const SystemModel> Simulation::system() const {
  Mistakes mistakes;
  const std::optional<PlannedSystem> planned =
      plan_system(*registry_, request_.config.completed(), own_.get(), mistakes);
  mistakes.refuse();
  return planned->model;
}

Run Simulation::build() const {
  Mistakes mistakes;
  RunPlan plan = plan_run(*registry_, request_, own_.get(), Rows::asked_for, mistakes);
  mistakes.refuse();
  return {std::make_unique<Driver>(std::move(plan), request_),
          std::make_shared<const Simulation>(*this)};
}

Result Simulation::run() const {
  Result out = run_unread();
  return std::move(out.read());
}

Result Simulation::run_unread() const {
  Mistakes mistakes;
  RunPlan plan = plan_run(*registry_, request_, own_.get(), Rows::always, mistakes);
  mistakes.refuse();
  RunRequest request = request_;
  request.to_be_read = true;
  if (request_.progress && request_.config.check)
    request.progress = [this](double done) {
      request_.progress(done / check_work(request_.config.completed(), 3));
    };
  Driver driver(std::move(plan), std::move(request));
  if (!request_.resumed.empty()) driver.resume(RunFile(request_.resumed));
  driver.complete();
  Result& result = driver.end();
  if (LoggedRows* rows = driver.unread()) rows->then = [](Result& out) { add_notes(out, 0); };
  else add_notes(result, driver.impacts_met());
  check_error(*registry_, request_, own_.get(), driver.plan(), result);
  driver.close();
  return std::move(result);
}

}  // namespace hamel
