#include <hamel/framework/ensemble/member.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <hamel/framework/mechanics/inputs.hpp>
#include <hamel/framework/run/run/driver.hpp>

namespace hamel::ensemble {

using Kind = Target::Kind;

namespace {
std::string first_line(const std::exception& error) {
  const std::string what = error.what();
  return what.substr(0, what.find('\n'));
}
}  // namespace

MemberRunner::MemberRunner(const Plan& plan, const std::atomic<bool>* stop)
    : plan_(plan),
      stop_(stop),
      kept_(*plan.kept),
      feedback_(*plan.feedback),
      physics_(plan.kept->wants()) {
  const std::vector<Target>& targets = plan.variations->targets();
  for (size_t i = 0; i < targets.size(); ++i)
    if (targets[i].kind == Kind::velocity) given_.push_back(i);
}
MemberRunner::~MemberRunner() = default;

// Its parameters, inputs and speed; the start is still that of all.
Config MemberRunner::parameters_of(long member) const {
  Config out = plan_.base;
  const Variations& variations = *plan_.variations;
  for (const size_t i : variations.numbered()) {
    const Target& target = variations.targets()[i];
    const double value = variations.number(i, member);
    if (target.kind == Kind::input) out.inputs[target.field] = value;
    if (target.kind == Kind::speed) out.speed = value;
    if (target.kind != Kind::parameter) continue;
    for (const Field& field : plan_.fields)
      if (field.name == target.field) out.parameters.try_emplace(field.name, field.value);
    std::vector<double>& values = out.parameters[target.field];
    if (values.empty()) values.resize(1);  // left out by the others
    values[target.index] = value;
  }
  return out;
}

// The run at the member's start.
void MemberRunner::prepare(long member) {
  const Variations& variations = *plan_.variations;
  if (plan_.builds_each()) {
    run_.emplace(plan_.simulation(parameters_of(member)).build());
    components_.reset();
    if (plan_.varies_start()) run_->restart(start_of(member, run_->config().start));
    return;
  }
  if (!run_) {
    run_.emplace(plan_.simulation(parameters_of(0)).build());
    common_ = run_->config().start;
  }
  for (const size_t i : variations.numbered())
    if (variations.targets()[i].kind == Kind::input)
      run_->input(variations.targets()[i].field, variations.number(i, member));
  run_->restart(plan_.varies_start() ? start_of(member, common_) : common_);
}

Config MemberRunner::config(long member) {
  Config out = parameters_of(member);
  if (plan_.varies_start()) {
    run_.emplace(plan_.simulation(out).build());
    out.start = start_of(member, run_->config().start);
    out.speed.reset();
  }
  run_.reset();
  const Config& given = plan_.config.run;
  out.every = given.every;
  out.output_step = given.output_step;
  out.output_times = given.output_times;
  out.no_exact = given.no_exact;
  return out;
}

const KernelSetup* MemberRunner::begin(long member, MemberFailure& failure) {
  failure = {member, plan_.base.from, ""};
  try {
    kept_.begin(member);
    prepare(member);
    return &run_->driver().plan().setup;
  } catch (const std::exception& error) {
    failure.reason = first_line(error);
    return nullptr;
  }
}

std::string MemberRunner::finish(std::span<double> out) {
  std::string flaw = kept_.finish(out);
  if (!flaw.empty()) std::ranges::fill(out, std::numeric_limits<double>::quiet_NaN());
  return flaw;
}

bool MemberRunner::run(long member, std::span<double> out, MemberFailure& failure) {
  failure = {member, plan_.base.from, ""};
  try {
    kept_.begin(member);
    feedback_.begin(member);
    prepare(member);
    physics_.begin(*run_);
    if (!follow(failure)) return false;
    if (failure.reason.empty()) {
      kept_.functions(*run_);
      failure.reason = kept_.finish(out);
    }
  } catch (const std::exception& error) {  // a start that is none, no state within a step
    failure.reason = first_line(error);
  }
  if (!failure.reason.empty()) std::ranges::fill(out, std::numeric_limits<double>::quiet_NaN());
  return true;
}

// To the formulas, with what is measured beside the state: at once, or when that is known.
template <class Use>
void MemberRunner::give(const Snapshot& state, const Use& use) {
  if (physics_.any()) physics_.give(state, use);
  else use(state, StateExtras());
}

void MemberRunner::peak(const Snapshot& state) {
  give(state,
       [this](const Snapshot& then, const StateExtras& extras) { kept_.peak(then, &extras); });
}

// States at times, and rows of max and min, up to now.
void MemberRunner::look(double now) {
  const double sign = plan_.base.until >= plan_.base.from ? 1 : -1;
  const double slack = 1e-12 * std::abs(plan_.base.until - plan_.base.from);
  const std::vector<double>&times = kept_.times(), &rows = plan_.rows;
  while (time_ < times.size() && sign * (times[time_] - now) <= slack) {
    give(run_->at(times[time_]),
         [this, place = time_](const Snapshot& state, const StateExtras& extras) {
           kept_.at(place, state, &extras);
         });
    ++time_;
  }
  if (!kept_.wants_peaks()) return;
  for (; row_ < rows.size() && sign * (rows[row_] - now) <= slack; ++row_)
    peak(run_->at(rows[row_]));
}

// Steps of one size, so many that what is looked for lies in the last.
long MemberRunner::steps_to_next(long done, long total) const {
  constexpr long kMost = 4096;  // between two looks at the flag that stops a run
  long out = physics_.wants_nodes() ? 1 : std::min(total - done, kMost);
  const double h = plan_.resolved.step_or_usual(), from = plan_.base.from;
  const auto reach = [&](double t) {
    const double steps = std::ceil((t - from) / h * (1 - 1e-12) - 1e-9);
    out = std::clamp(static_cast<long>(steps) - done, 1L, std::max(1L, out));
  };
  if (feedback_.any())
    reach(from + std::copysign(static_cast<double>(acted_) * plan_.config.feedback.period, h));
  if (time_ < kept_.times().size()) reach(kept_.times()[time_]);
  if (!kept_.wants_peaks()) return out;
  if (row_ < plan_.rows.size()) reach(plan_.rows[row_]);
  if (plan_.rows.empty()) out = std::min(out, plan_.base.every - done % plan_.base.every);
  return out;
}

// Sets the inputs where a period begins; the time to which they are held, or the end.
double MemberRunner::act_by_state(double now) {
  const double from = plan_.base.from, until = plan_.base.until, sign = until >= from ? 1 : -1;
  if (!feedback_.any()) return until;
  const double period = plan_.config.feedback.period;
  const auto time = [&](long k) { return from + sign * static_cast<double>(k) * period; };
  if (sign * (now - time(acted_)) >= -1e-9 * period) {
    feedback_.act(*run_);
    ++acted_;
  }
  const double next = time(acted_);
  return sign * (until - next) > 1e-9 * period ? next : until;
}

// To the end; false: stopped on the way.
bool MemberRunner::follow(MemberFailure& failure) {
  Run& run = *run_;
  const bool chosen = plan_.resolved.chooses_steps();
  const double until = plan_.base.until;
  const long total = chosen ? 0 : plan_.resolved.steps();
  const bool nodes = kept_.wants_peaks() && plan_.rows.empty();
  time_ = row_ = 0;
  acted_ = 0;
  const auto parts = [this](StateParts of) {
    of.element = physics_.any();
    of.energy = of.energy || physics_.wants_nodes();  // whose balance it is
    return of;
  };
  const StateParts of_peaks = parts(kept_.peak_parts()), of_all = parts(kept_.parts());
  if (physics_.wants_nodes()) physics_.node(run.state(of_all));
  if (kept_.wants_start() || kept_.wants_peaks() || !kept_.times().empty()) {
    give(run.state(parts(kept_.start_parts())),
         [this](const Snapshot& state, const StateExtras& extras) { kept_.start(state, &extras); });
    if (nodes) peak(run.state(of_peaks));
    look(plan_.base.from);
  }
  double now = plan_.base.from;
  for (long done = 0; !run.over() && (chosen ? now != until : done < total);) {
    if (stop_ != nullptr && stop_->load()) return false;
    const double held = act_by_state(now);
    const long count = chosen ? 1 : steps_to_next(done, total);
    const Status status = chosen ? run.step_towards(held) : run.step(count);
    done += count;
    const double before = now;
    now = run.time();
    if (!status.ok) {
      failure.time = now;
      failure.reason = status.reason;
      return true;
    }
    physics_.look_within(true);
    look(now);
    physics_.look_within(false);
    if (nodes && done % plan_.base.every == 0) peak(run.state(of_peaks));
    if (chosen && now == before) break;
  }
  const Snapshot& last = run.state(of_all);
  failure.time = last.time;
  if (kept_.wants_peaks()) peak(last);
  give(last, [this](const Snapshot& state, const StateExtras& extras) {
    kept_.end(state, run_->events(), &extras);
  });
  physics_.finish();
  return true;
}

}  // namespace hamel::ensemble
