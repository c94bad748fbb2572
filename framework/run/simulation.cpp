#include <hamel/framework/run/simulation.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/run/meter.hpp>
#include <hamel/framework/run/plan.hpp>

namespace hamel {
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

namespace {

void add_notes(Result& result) {
  constexpr double far = 0.3;
  if (result.rotation_per_step_max > far) {
    result.notes.push_back(fmt::format(
        "a step turns by up to {:.2g} rad: more than {} rarely follows the motion, whatever "
        "the diagnostics say; take a smaller step, or check",
        result.rotation_per_step_max, far));
  }
  constexpr double percent = 0.01;
  if (!std::isfinite(result.work) && result.energy_error_max > percent) {
    result.notes.push_back(
        fmt::format("the energy changes by {:.2g} of its size though nothing does work: take a "
                    "smaller step, or check",
                    result.energy_error_max));
  }
}

}  // namespace

Result Simulation::run() const {
  Plan plan = this->plan();
  if (!plan.mistakes.empty()) throw ConfigError(plan.mistakes);
  Result result;
  result.config = plan.config;
  result.system = plan.system;
  result.unused = plan.unused;
  result.notes = plan.notes;
  const std::unique_ptr<Kernel> kernel = plan.kernel(plan.setup);
  const long steps = config_.steps(), every = config_.every;
  const double lag = (1 - plan.setup.s) * plan.setup.composition.back() * plan.setup.step;
  const std::shared_ptr<const Mechanics> acting =
      plan.keeps_rows ? plan.mechanics : std::make_shared<UnconstrainedMechanics>(plan.mechanics);
  Meter meter(result.system, result.config.start, plan.geometry, plan.mechanics, acting, lag);
  using Clock = std::chrono::steady_clock;
  Clock::duration comparing{};  // is no part of the time of a run
  Snapshot& state = result.last;
  const auto record = [&] {
    const long recorded = result.trajectory.rows() == 0 ? -1 : state.step;
    kernel->measure(state);
    if (state.step == recorded) return true;  // nothing new: a chunk failed in its first step
    meter.take(state);
    const auto begin = Clock::now();
    meter.compare(state);
    comparing += Clock::now() - begin;
    if (recorded < 0) {
      result.trajectory = Trajectory(meter.columns());
      result.trajectory.reserve(static_cast<size_t>(steps / every + 2));
    }
    result.trajectory.append(meter.row());
    return !observer_ || observer_(state);
  };
  Snapshot node;
  const auto look = [&] {
    kernel->state(node);
    meter.node(node);
  };
  const auto advance = [&](long count) {
    if (!meter.wants_nodes()) return kernel->advance(count);
    Status status;
    for (long i = 0; i < count && (status = kernel->advance(1)).ok; ++i) look();
    return status;
  };
  if (meter.wants_nodes()) look();
  const auto begin = Clock::now();
  auto next_progress = begin + std::chrono::milliseconds(200);
  bool go_on = record();
  for (long done = 0; go_on && done < steps; done += every) {
    result.status = advance(std::min(every, steps - done));
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
  result.seconds = std::chrono::duration<double>(Clock::now() - begin - comparing).count();
  result.steps = state.step;
  result.stats = kernel->stats();
  static_cast<Measurements&>(result) = meter.finish(result.trajectory);
  result.notes.insert(result.notes.end(), meter.notes().begin(), meter.notes().end());
  add_notes(result);
  if (config_.check && result.status.ok) estimate_error(result);
  return result;
}

// Richardson: with the ends x(h), x(h/2), x(h/4) the order is p = log2(|x(h) - x(h/2)| / |x(h/2) - x(h/4)|), the error of
// x(h) is |x(h) - x(h/2)| 2^p / (2^p - 1). Nothing is said where p is no order (below 0.5), unless the ends agree to
// round-off.
void Simulation::estimate_error(Result& result) const {
  std::vector<double> ends[3] = {result.last.coordinates, {}, {}};
  for (const int parts : {2, 4}) {
    Simulation finer = *this;
    finer.step(config_.step / parts).every(config_.every * parts);  // as many rows as were allowed
    Integration run = finer.build();
    if (!run.step(parts * result.steps)) return;
    ends[parts / 2] = run.state().coordinates;
  }
  const double half = euclidean_distance(ends[0], ends[1]);
  const double quarter = euclidean_distance(ends[1], ends[2]);
  const double size = euclidean_distance(ends[2], std::vector<double>(ends[2].size(), 0.0));
  const double order = std::log2(half / quarter);
  if (half <= 1e-12 * (1 + size)) {
    result.estimated_error = half;
  } else if (order > 0.5) {
    result.estimated_error = half / (1 - std::exp2(-order));
    result.observed_order = order;
  }
}

}  // namespace hamel
