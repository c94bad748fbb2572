#include <hamel/framework/run/run/driver.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace hamel {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

Driver::Driver(RunPlan plan, RunRequest request)
    : plan_(std::move(plan)),
      request_(std::move(request)),
      kernel_(std::make_unique<RestartedKernel>(plan_.run_kernel(), plan_.setup)) {
  make_observers();
}

void Driver::make_observers() {
  const Config& config = plan_.config;
  const auto& mechanics = plan_.setup.mechanics;
  const bool rows_move = (mechanics->has_drift() && mechanics->constraint_count() > 0) ||
                         plan_.system->rows_may_depend;
  watching_ =
      plan_.recording || plan_.events->any() || plan_.contacts != nullptr || follower_ != nullptr;
  rows_watch_.reset();
  if (watching_ && rows_move && plan_.contacts == nullptr && !plan_.compiled &&
      plan_.geometry != nullptr && plan_.keeps_rows)
    rows_watch_ = std::make_unique<RowsWatch>(plan_.geometry, *plan_.system, mechanics);
  steps_ = StepWatch(config.from, config.until - config.from);
  rejected_ = 0;
  steps_left_ = config.chooses_steps() ? std::numeric_limits<long>::max() : config.steps();
  if (!watching_) return;
  times_ = plan_.recording ? config.recorded_times() : std::vector<double>();
  every_node_ = !times_.empty() || plan_.events->any() || rows_watch_ != nullptr ||
                plan_.contacts != nullptr || follower_ != nullptr;
  if (!plan_.recording) return;
  recorder_ = std::make_shared<RunRecorder>(*plan_.system, plan_.config.start, balance(),
                                            plan_.reactions, plan_.motion, paths());
  if (!recorder_->missing_outputs().empty()) throw ConfigError(recorder_->missing_outputs());
  every_node_ = every_node_ || recorder_->wants_nodes();
  logged_.reset();
  if (may_log())
    logged_ = std::make_shared<LoggedRows>(plan_.system, recorder_, plan_.kernel, plan_.setup,
                                           request_.rows_kept.value_or(0));
  for (const std::string& path : request_.records) sinks_.push_back(make_sink(path));
  if (request_.records.empty() || request_.rows_kept)
    sinks_.push_back(make_memory_sink(result_.trajectory, request_.rows_kept.value_or(0)));
  for (const auto& sink : sinks_) resumable_ = resumable_ || sink->resumable();
}

// Not where something else depends on a row, or may change behind it.
bool Driver::may_log() const {
  return request_.to_be_read && request_.records.empty() && request_.resumed.empty() &&
         !request_.observer && !plan_.config.check && plan_.setup.inputs == nullptr &&
         !plan_.events->any() && plan_.contacts == nullptr && follower_ == nullptr &&
         rows_watch_ == nullptr && !recorder_->wants_nodes();
}

std::shared_ptr<const Mechanics> Driver::acting() const {
  const auto& mechanics = plan_.setup.mechanics;
  return plan_.keeps_rows ? mechanics : std::make_shared<UnconstrainedMechanics>(mechanics);
}

EnergyBalance Driver::balance() const {
  if (plan_.contacts != nullptr) {
    const Mechanics& system = *plan_.system->mechanics;
    std::function<bool()> idle;  // friction is all that does work
    if (!system.has_force() && !system.has_drift())
      idle = [contacts = plan_.contacts] { return !contacts->any_slides(); };
    return {plan_.geometry,     plan_.contacts->balanced(plan_.contacts),
            plan_.setup.inputs, plan_.reactions,
            std::move(idle),    plan_.contacts};
  }
  return {plan_.geometry, acting(), plan_.setup.inputs, plan_.reactions};
}

// ---- steps --------------------------------------------------------------------------------------

Status Driver::refuse(double t, const std::string& reason) const {
  Snapshot now;
  kernel().state(now);
  return {false, now.step + 1, now.time, 0, fmt::format(fmt::runtime(reason), t)};
}

Status Driver::steppable(double t) const {
  if (finished_) return refuse(t, "this run is finished: build another, or restart it");
  if (!std::isfinite(t)) return refuse(t, "t = {}: expected a finite time");
  return {};
}

// Not ok where a table of an input ends before t.
Status Driver::covered(double t) const {
  if (plan_.setup.inputs == nullptr || plan_.setup.inputs->covers(t)) return {};
  return refuse(t, "the table of an input does not cover t = {:.10g}");
}

// Behind a restart begun when it is first needed: a member of an ensemble that runs in lanes needs
// none.
RestartedKernel& Driver::kernel() const {
  if (restarted_) kernel_->start_again(plan_.setup);
  restarted_ = false;
  return *kernel_;
}

Status Driver::step(long count) {
  if (const Status status = steppable(0); !status.ok) return status;
  const bool chosen = plan_.config.chooses_steps();
  const double h = kernel().next_step();
  if (plan_.setup.inputs != nullptr && !chosen) {
    kernel().state(row_);
    const double end = row_.time + static_cast<double>(count) * h;
    if (const Status status = covered(end); !status.ok) return status;
  }
  if (chosen) kernel().set_end_time(std::copysign(kInfinite, h));
  return advance(count);
}

Status Driver::step_towards(double t) {
  if (const Status status = steppable(t); !status.ok) return status;
  if (plan_.config.chooses_steps()) {
    kernel().state(row_);
    if (!((t - row_.time) * kernel().next_step() > 0)) return refuse(t, "t = {} lies behind");
    kernel().set_end_time(t);
  }
  return advance(1);
}

Status Driver::advance_to(double t) {
  if (const Status status = steppable(t); !status.ok) return status;
  if (const Status status = covered(t); !status.ok) return status;
  kernel().state(row_);
  const double steps = (t - row_.time) / kernel().next_step();
  if (plan_.config.chooses_steps()) {
    if (!(steps >= -1e-9)) return refuse(t, "t = {} lies behind");
    if (steps <= 0) return {};
    kernel().set_end_time(t);
    return advance(std::numeric_limits<long>::max());
  }
  if (!(steps >= -0.5)) return refuse(t, "t = {} lies behind");
  const long count = std::max(0L, std::lround(steps));
  limit_grid(count);
  return advance(count);
}

// So many steps of one size from here the run ends: a jump of an input next to that does not move
// it.
void Driver::limit_grid(long count) {
  kernel().state(row_);
  kernel().set_end_time(row_.time + static_cast<double>(count) * kernel().next_step());
}

Status Driver::complete() {
  if (const Status status = steppable(0); !status.ok) return status;
  if (plan_.config.chooses_steps()) kernel().set_end_time(plan_.config.until);
  else limit_grid(steps_left_);
  advance(0, true);
  if (request_.progress && result_.status.ok) report_progress(1);
  return result_.status;
}

void Driver::report_progress(double done) {
  request_.progress(done);
  occupancy_.require_run();
}

Status Driver::advance(long count, bool to_end) {
  if (over_) return result_.status;
  if (!watching_ && !to_end) return result_.status = take_unseen(count);
  try {
    entered_ = Clock::now();
    begin();
    take_steps(count, to_end);
    lap();
    entered_ = {};
  } catch (...) {
    rows_to_files_after_failure();
    throw;
  }
  return result_.status;
}

// The first row.
void Driver::begin() {
  if (std::exchange(begun_, true)) return;
  kernel().state(node_);
  if (rows_watch_ != nullptr) rows_watch_->begin(node_);
  if (node_.step > 0) return;
  if (plan_.recording) {
    kernel().measure(result_.last);
    recorder_->begin(result_.last);
    if (recorder_->wants_nodes()) recorder_->node(node_);
    if (logged_ != nullptr) {
      logged_->log.every = times_.empty() ? plan_.config.every : 0;
      if (!kernel().log_to(&logged_->log, !times_.empty())) logged_.reset();
    }
    over_ = !(times_.empty() ? record_node() : output(plan_.config.from));
  }
  if (const auto met = take_switch()) over_ = over_ || !observe_switch(*met);
  if (!over_ && plan_.events->any()) observe_start();
}

void Driver::follow(StepFollower* follower) {
  if (std::exchange(follower_, follower) == follower) return;
  recorder_.reset();
  sinks_.clear();
  make_observers();  // those that a run has which is looked at, as behind restart()
}

void Driver::turn_back() { kernel().turn_back(); }

void Driver::input(const std::string& name, double value) {
  const SystemModel& system = *plan_.system;
  const size_t i = input_index(system.name, system.inputs, name);
  if (plan_.setup.inputs == nullptr) {
    throw ConfigError(
        {fmt::format("input '{0}': this run was built without inputs: give one a first value, "
                     ".input(\"{0}\", 0)",
                     name)});
  }
  check_input(system.name, system.inputs[i], value);
  plan_.setup.inputs->set(i, value);
}

void Driver::restart(const Start& start) {
  if (!request_.records.empty() && begun_)
    throw ConfigError({"restart: the rows of this run are in files: build another"});
  Mistakes mistakes;
  Config& config = plan_.config;
  const Start before = std::exchange(config.start, start);
  PlannedStart planned = plan_start(*plan_.system, config, mistakes);
  if (matrices_ && mistakes.none()) {
    static_cast<StartMatrices&>(planned) = *std::exchange(matrices_, std::nullopt);
  } else {
    evaluate_start(*plan_.system, plan_.setup.inputs, plan_.geometry.get(), config, planned,
                   mistakes);
  }
  if (!mistakes.none()) {
    config.start = before;
    mistakes.refuse();
  }
  project_start(*plan_.system, planned);
  if (plan_.system->mechanics->left_invariant() && !plan_.system->start_mistakes)
    matrices_ = std::move(static_cast<StartMatrices&>(planned));
  config.start = planned.start;
  plan_.setup.configuration = planned.start.configuration;
  plan_.setup.velocity = planned.start.velocity;
  restarted_ = true;
  if (plan_.contacts != nullptr) plan_.contacts->begin_anew();
  dense_.reset();
  over_ = finished_ = false;
  result_.status = {};
  if (!watching_) return;
  plan_.events->begin(state_of(config.start, config.from), mistakes.all());
  mistakes.refuse();
  recorder_.reset();
  sinks_.clear();
  result_ = Result();
  next_ = 0;
  recorded_ = -1;
  rows_ = kept_at_ = impacts_met_ = 0;
  seconds_ = {};
  begun_ = sinks_begun_ = flawed_ = false;
  make_observers();
}

DenseOutput& Driver::dense() {
  if (dense_ == nullptr)
    dense_ = std::make_unique<DenseOutput>(kernel(), plan_.kernel, plan_.setup);
  return *dense_;
}

const Snapshot& Driver::at(double t) {
  kernel().state(row_);
  const double end = row_.time, slack = 1e-12 * std::abs(kernel().next_step());
  kernel().beginning(row_);
  if (!(std::min(row_.time, end) - slack <= t && t <= std::max(row_.time, end) + slack)) {
    throw std::runtime_error(
        fmt::format("no state at t = {}: the last step is from {} to {}", t, row_.time, end));
  }
  const Status status = dense().at(t, row_);
  if (!status.ok) throw std::runtime_error(fmt::format("no state at t = {}: {}", t, status.reason));
  return row_;
}

double Driver::time() { return result_.stopped_by_event ? result_.last.time : kernel().time(); }

const Snapshot& Driver::state(const StateParts& parts) {
  if (result_.stopped_by_event) return result_.last;
  kernel().state(row_, parts);
  return row_;
}

}  // namespace hamel
