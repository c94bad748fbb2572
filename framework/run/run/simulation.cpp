#include <hamel/framework/run/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <hamel/framework/run/record/sink.hpp>
#include <hamel/framework/run/run/plan.hpp>
#include <hamel/framework/run/run/run_loop.hpp>

namespace hamel {
Integration::Integration(KernelFactory factory, KernelSetup setup, Config config,
                         SystemModel system, std::vector<std::string> notes, Begin begin)
    : factory_(std::move(factory)),
      setup_(std::move(setup)),
      begin_(std::move(begin)),
      kernel_(factory_(setup_)),
      dense_(std::make_unique<DenseOutput>(*kernel_, factory_, setup_)),
      config_(std::move(config)),
      system_(std::move(system)),
      notes_(std::move(notes)) {}

Status Integration::step(long count) {
  if (setup_.inputs != nullptr) {
    kernel_->state(state_);
    const double end = state_.time + static_cast<double>(count) * kernel_->next_step();
    if (const Status status = covered(end); !status.ok && !config_.chooses_steps()) return status;
  }
  return kernel_->advance(count);
}

Status Integration::covered(double t) {
  if (setup_.inputs == nullptr || setup_.inputs->covers(t)) return {};
  kernel_->state(state_);
  return {false, state_.step + 1, state_.time, 0,
          fmt::format("the table of an input does not cover t = {:.10g}", t)};
}

void Integration::input(const std::string& name, double value) {
  const size_t i = input_index(system_.name, system_.inputs, name);
  if (setup_.inputs == nullptr) {
    throw ConfigError(
        {fmt::format("input '{0}': this run was built without inputs: give one a first value, "
                     ".input(\"{0}\", 0)",
                     name)});
  }
  check_input(system_.name, system_.inputs[i], value);
  setup_.inputs->set(i, value);
}

void Integration::restart(const Start& start) {
  config_.start = begin_(start, setup_);
  kernel_ = factory_(setup_);
  dense_ = std::make_unique<DenseOutput>(*kernel_, factory_, setup_);
}

Status Integration::behind(double t) {
  kernel_->state(state_);
  return {false, state_.step + 1, state_.time, 0, fmt::format("t = {} lies behind", t)};
}

Status Integration::advance_to(double t) {
  if (const Status status = covered(t); !status.ok) return status;
  kernel_->state(state_);
  const double steps = (t - state_.time) / kernel_->next_step();
  if (config_.chooses_steps()) {
    if (!(steps >= -1e-9)) return behind(t);
    if (steps <= 0) return {};
    kernel_->limit(t);
    return kernel_->advance(std::numeric_limits<long>::max());
  }
  if (!(steps >= -0.5)) return behind(t);
  return kernel_->advance(std::max(0L, std::lround(steps)));
}

Status Integration::step_towards(double t) {
  if (config_.chooses_steps()) {
    kernel_->state(state_);
    if (!((t - state_.time) * kernel_->next_step() > 0)) return behind(t);
    kernel_->limit(t);
  }
  return kernel_->advance(1);
}

const Snapshot& Integration::at(double t) {
  kernel_->state(state_);
  const double end = state_.time, slack = 1e-12 * std::abs(kernel_->next_step());
  kernel_->beginning(state_);
  if (!(std::min(state_.time, end) - slack <= t && t <= std::max(state_.time, end) + slack)) {
    throw std::runtime_error(
        fmt::format("no state at t = {}: the last step is from {} to {}", t, state_.time, end));
  }
  const Status status = dense_->at(t, state_);
  if (!status.ok) throw std::runtime_error(fmt::format("no state at t = {}: {}", t, status.reason));
  return state_;
}

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

Simulation& Simulation::kernel(KernelFactory factory, SchemeInfo scheme, RetractionInfo retraction,
                               KernelFactory driven) {
  config_.scheme = scheme.name;
  config_.retraction = retraction.name;
  kernel_ = std::move(factory);
  driven_kernel_ = std::move(driven);
  kernel_scheme_ = std::move(scheme);
  kernel_retraction_ = std::move(retraction);
  return *this;
}

std::vector<std::string> Simulation::mistakes() const { return plan().mistakes; }

Integration Simulation::build() const {
  Plan plan = this->plan();
  if (!plan.mistakes.empty()) throw ConfigError(plan.mistakes);
  const auto kept = std::make_shared<Plan>(std::move(plan));
  const auto begin = [kept](const Start& start, KernelSetup& setup) {
    kept->config.start = start;
    kept->mistakes.clear();
    kept->notes.clear();
    kept->fill_start();
    kept->look_at_start();
    if (!kept->mistakes.empty()) throw ConfigError(kept->mistakes);
    kept->project();
    setup.configuration = kept->setup.configuration;
    setup.velocity = kept->setup.velocity;
    return kept->config.start;
  };
  return {kept->kernel, kept->setup, kept->config, kept->system, kept->notes, begin};
}

namespace {

void add_notes(Result& result, long impacts) {
  constexpr double far = 0.3;
  if (result.rotation_per_step_max > far && !result.config.chooses_steps()) {
    result.notes.push_back(fmt::format(
        "a step turns by up to {:.2g} rad: more than {} rarely follows the motion, whatever "
        "the diagnostics say; take a smaller step, or check",
        result.rotation_per_step_max, far));
  }
  if (impacts > 0) {
    result.notes.push_back(fmt::format(
        "{} impact{} changed the state, which is no error of the energy or of an invariant; the "
        "run ends at t = {:.10g}",
        impacts, impacts > 1 ? "s" : "", result.last.time));
  }
  constexpr double percent = 0.01;
  if (!std::isfinite(result.work) && result.energy_error_max > percent) {
    result.notes.push_back(
        fmt::format("the energy changes by {:.2g} of its size though nothing does work: take a "
                    "smaller step, or check",
                    result.energy_error_max));
  }
}

// What step or tolerance is divided by in a run that --check adds.
double finer_by(const Config& config) { return config.chooses_steps() ? 10 : 2; }

// The steps of the first `runs` of this run and the two finer ones, in those of this run; a tenth of the tolerance takes some
// 10^(1/5) times as many.
double check_work(const Config& config, int runs) {
  const double more = config.chooses_steps() ? 1.6 : 2;
  return (std::pow(more, runs) - 1) / (more - 1);
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
  std::vector<std::unique_ptr<Sink>> sinks;
  for (const std::string& path : records_) sinks.push_back(make_sink(path));
  if (records_.empty() || rows_kept_)
    sinks.push_back(std::make_unique<MemorySink>(result.trajectory, rows_kept_.value_or(0)));
  RunLoop loop(plan, result, sinks);
  loop.observer = observer_;
  loop.progress = progress_;
  if (progress_ && config_.check)
    loop.progress = [&](double done) { progress_(done / check_work(config_, 3)); };
  loop.impacts = &impacts_;
  if (!resumed_.empty()) loop.resume(RunFile(resumed_));
  loop.run();
  add_notes(result, loop.impacts_met());
  if (config_.check && result.status.ok) {
    if (plan.keeps_rows || plan.mechanics->rows() == 0) estimate_error(result);
    else
      result.notes.push_back(
          fmt::format("check: {} leaves out constraints: its limit is another motion, and nothing "
                      "is known of its error",
                      result.config.scheme));
  }
  for (const auto& sink : sinks) sink->finish(result);
  return result;
}

// Richardson: with the ends x(h), x(h/2), x(h/4) the order is p = log2(|x(h) - x(h/2)| / |x(h/2) - x(h/4)|), the error of
// x(h) is |x(h) - x(h/2)| 2^p / (2^p - 1). Nothing is said where p is no order (below 0.5), unless the ends agree to
// round-off. Where steps are chosen, the same with a tenth and a hundredth of the tolerance in place of h/2, h/4, and p the
// power of the tolerance. The ends are at one time, the last of this run, which may be that of an event.
void Simulation::estimate_error(Result& result) const {
  const double span = std::abs(result.last.time - config_.from);
  if (!config_.chooses_steps() && span < std::abs(config_.step)) {
    result.notes.push_back("check: the run ended within its first step: nothing is known");
    return;
  }
  const double factor = finer_by(config_);
  std::vector<double> ends[3] = {result.last.coordinates, {}, {}};
  for (const int k : {1, 2}) {
    const double parts = std::pow(factor, k);
    Simulation finer = *this;
    finer.records_.clear();  // the files are this run's
    finer.resumed_.clear();
    finer.keep_rows(1);
    Config& config = finer.config_;
    config.check = false;
    config.no_exact = true;
    config.stop_at.clear();  // it stops when this run did
    config.until = result.last.time;
    config.every = 1;
    config.output_step.reset();
    config.output_times = {result.last.time};
    if (config.chooses_steps()) {
      if (config.rtol) *config.rtol /= parts;
      if (config.atol) *config.atol /= parts;
    } else {
      config.step /= parts;
    }
    finer.observe([&](const Snapshot& end) {
      ends[k] = end.coordinates;
      return true;
    });
    finer.progress([&](double done) {
      const double before = check_work(config_, k), all = check_work(config_, 3);
      if (progress_) progress_((before + done * (check_work(config_, k + 1) - before)) / all);
    });
    const std::string which = fmt::format("check: the run with 1/{:g} of the {}", parts,
                                          config.chooses_steps() ? "tolerance" : "step");
    if (const auto mistakes = finer.mistakes(); !mistakes.empty()) {  // no reason to lose this run
      result.notes.push_back(fmt::format("{}: {}", which, mistakes.front()));
      return;
    }
    const Status status = finer.run().status;
    if (status.ok && !ends[k].empty()) continue;
    result.notes.push_back(
        fmt::format("{} failed at t = {:.6g}: {}", which, status.time, status.reason));
    return;
  }
  const double first = euclidean_distance(ends[0], ends[1]);
  const double second = euclidean_distance(ends[1], ends[2]);
  const double size = euclidean_distance(ends[2], std::vector<double>(ends[2].size(), 0.0));
  const double order = std::log(first / second) / std::log(factor);
  if (first <= 1e-12 * (1 + size)) {
    result.estimated_error = first;
  } else if (order > 0.5) {
    result.estimated_error = first / (1 - std::pow(factor, -order));
    result.observed_order = order;
  } else {
    result.notes.push_back(
        fmt::format("check: {} do not agree on an order: the ends differ by {:.2e}, then by {:.2e}",
                    finer_runs(config_), first, second));
  }
}

}  // namespace hamel
