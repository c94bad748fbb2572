#include <hamel/framework/loop/time_loop.hpp>

#include <algorithm>
#include <string>
#include <utility>

#include <hamel/framework/loop/denormals.hpp>

namespace hamel {
namespace {
// A jump of an input is next to a node, in steps.
constexpr double kNext = 1e-3;
// Fraction left before its limit that a chosen step takes too: round-off of the times, where the
// steps of a motion are taken back.
constexpr double kSliver = 1e-6;
}  // namespace

TimeLoop::TimeLoop(const KernelSetup& setup)
    : setup_(setup), h_(setup.step), from_(setup.from), time_(setup.from), t_(setup.from) {
  if (setup_.mechanics != nullptr) setup_.mechanics->begin();
}

Status TimeLoop::take_steps(long count) {
  const FlushDenormals flushed;
  const bool chosen = chooses_steps();
  if (!chosen && setup_.inputs == nullptr && setup_.composition.size() == 1)
    return take_plain_steps(count);
  for (long k = 0; k < count; ++k) {
    if (chosen && t_ == limit_) return {};
    SolveReport report = chosen ? chosen_step() : fixed_step();
    if (chosen && !errors_ && !report.ok()) [[unlikely]]
      report = rescued(report);
    if (!report.ok()) [[unlikely]]
      return lost(report);
    tally(report);
    time_ = t_;
    if (!logged()) [[unlikely]]
      break;
  }
  return {};
}

// Steps of one size without inputs, of one substep: nothing to ask for.
inline Status TimeLoop::take_plain_steps(long count) {
  const double size = setup_.composition.front() * h_;
  SolveReport report;
  for (; count > 0; --count) {
    substep(0, size, report);
    beginning_ = Beginning::previous;
    if (!report.ok()) [[unlikely]] {
      report = rescued(report);
      if (!report.ok()) return lost(report);
    }
    tally(report);
    if (!logged()) [[unlikely]]
      break;
  }
  return {};
}

// No step, but what it cost counts.
Status TimeLoop::lost(const SolveReport& report) {
  stats_.iterations += report.iterations;
  stats_.evaluations += report.evaluations;
  return failure(report);
}

inline void TimeLoop::tally(const SolveReport& report) {
  last_ = report;
  ++steps_;
  if (!in_parts_) ++whole_;
  stats_.iterations += report.iterations;
  stats_.evaluations += report.evaluations;
  if (report.iterations > stats_.iterations_max) stats_.iterations_max = report.iterations;
  if (report.residual > stats_.residual_max) stats_.residual_max = report.residual;
}

void TimeLoop::reverse() {
  count_from(t_);
  h_ = -h_;
  limit_ = std::copysign(std::numeric_limits<double>::infinity(), h_);
  clear_history();
}

void TimeLoop::begin_anew(double t, double step) {
  h_ = step;
  limit_ = std::copysign(std::numeric_limits<double>::infinity(), h_);
  count_from(t);
  clear_history();
}

void TimeLoop::go_on(double t, Nearby to) {
  count_from(t);
  move_history(to);
}

// Steps count from here.
void TimeLoop::count_from(double t) {
  from_ = time_ = t;
  first_ = whole_;
  in_parts_ = off_grid_ = false;
}

inline SolveReport TimeLoop::one_step() {
  if (setup_.inputs != nullptr) [[unlikely]]
    enter_inputs();
  if (setup_.composition.size() > 1) [[unlikely]]
    return composed_step();
  SolveReport report;
  substep(0, setup_.composition.front() * h_, report);
  beginning_ = Beginning::previous;
  return report;
}

// Takes a step of fixed size, unless an input jumps or bends within it.
inline SolveReport TimeLoop::fixed_step() {
  if (setup_.inputs != nullptr && (off_grid_ || setup_.inputs->breaks())) [[unlikely]] {
    const double end = from_ + static_cast<double>(whole_ - first_ + 1) * h_;
    const double part = end_of_part(end);
    if (off_grid_ || part != end) return part_of_step(part, part == end);
  }
  const SolveReport report = one_step();
  if (report.ok()) [[likely]]
    return report;
  return rescued(report);
}

// End of the next part of the step to `end`: there, or where an input jumps or bends before. A
// jump next to the end replaces it, since the result of a step far smaller than the others is
// mostly round-off.
double TimeLoop::end_of_part(double end) const {
  const double size = std::abs(h_), jump = setup_.inputs->next_break(t_, h_);
  const double before = std::copysign(1.0, h_) * (end - jump);
  if (std::abs(before) <= 1e-9 * size || before < (ends_run(end) ? 0 : -kNext * size)) return end;
  return jump;
}

// The part of a step to `end`; whole: nothing of the step is left then.
SolveReport TimeLoop::part_of_step(double end, bool whole) {
  const double h = h_;
  const double step_end = from_ + static_cast<double>(whole_ - first_ + 1) * h;
  time_ = time();
  off_grid_ = true;
  clear_history();  // of steps of another size
  h_ = end - t_;
  SolveReport report = one_step();
  if (!report.ok()) report = rescued(report);
  h_ = h;
  clear_history();
  if (!report.ok()) return report;
  end_at(t_ = end);
  off_grid_ = !whole;
  in_parts_ = !whole && (ends_run(step_end) || std::abs(step_end - end) > kNext * std::abs(h));
  return report;
}

bool TimeLoop::ends_run(double t) const { return std::abs(t - limit_) <= 1e-9 * std::abs(h_); }

// Forces that are remembered from the end of the last step are those of its inputs.
void TimeLoop::enter_inputs() {
  setup_.inputs->enter(t_, h_);
  if (setup_.inputs->changes() == inputs_changed_) return;
  inputs_changed_ = setup_.inputs->changes();
  forget_forces();
}

SolveReport TimeLoop::composed_step() {
  put_away(Kept::step);
  beginning_ = Beginning::step;
  SolveReport total;
  int place = 0;
  for (const double coefficient : setup_.composition) {
    SolveReport report;
    substep(place++, coefficient * h_, report);
    total.iterations += report.iterations;
    total.evaluations += report.evaluations;
    total.residual = std::max(total.residual, report.residual);
    total.reason = report.reason;
    if (!total.ok()) {
      fetch(Kept::step);
      break;
    }
  }
  return total;
}

// A step of a size chosen by the error: explicit pairs take one again that is too large.
SolveReport TimeLoop::chosen_step() {
  if (errors_) return error_controlled_step();
  const double end = end_of_step(t_), left = end - t_;
  h_ = controlled_size(std::pow(setup_.errors.at(1), 1.0 / setup_.order));
  h_ = std::copysign(std::min(std::abs(h_), setup_.largest), h_);
  const bool cut = std::abs(h_) >= (1 - kSliver) * std::abs(left);
  if (cut) {
    h_ = left;
    clear_history();
  }
  const SolveReport report = one_step();
  if (cut && report.ok()) end_at(t_ = end);
  return report;
}

SolveReport TimeLoop::error_controlled_step() {
  const double end = end_of_step(t_);
  h_ = std::copysign(std::min(std::abs(h_), setup_.largest), h_);
  SolveReport total;
  const auto taken = errors_->take(h_, end - t_, smallest_step(t_), [&] {
    error_ = std::numeric_limits<double>::infinity();  // of a step that fails
    total.evaluations += one_step().evaluations;
    return error_;
  });
  if (taken.whole) end_at(t_ = end);
  stats_.rejected += taken.rejected;
  total.reason = taken.reason;
  return total;
}

// Latest end of the next step: the limit, or the time at which an input jumps or bends.
double TimeLoop::end_of_step(double t) const {
  if (setup_.inputs == nullptr) return limit_;
  const double next = setup_.inputs->next_break(t, h_);
  return (h_ > 0) == (next < limit_) ? next : limit_;
}

// Above it a chosen step is worth trying.
double TimeLoop::smallest_step(double t) const {
  const double span = std::isfinite(limit_) ? limit_ - from_ : std::fmax(t - from_, setup_.step);
  return 1e-14 * std::abs(span);
}

SolveReport TimeLoop::rescued(const SolveReport& failed) {
  const SolveReport report = recover(failed);
  beginning_ = Beginning::rescue;
  return report;
}

// A step has failed, and the state is still that of the last good one: what on_failure specifies.
SolveReport TimeLoop::recover(SolveReport failed) {
  if (setup_.on_failure == OnFailure::stop) return failed;
  put_away(Kept::rescue);
  const double h = h_;
  if (setup_.composition.size() > 1)
    clear_history();  // its first substeps are solved a second time
  SolveReport rescued;
  std::string action;
  if (setup_.on_failure == OnFailure::retry) {
    std::swap(setup_.solver, setup_.fallback);
    rescued = one_step();
    std::swap(setup_.solver, setup_.fallback);
    action = "solved by " + setup_.fallback_name;
  } else {
    int parts = 0;
    rescued = halve(1, parts);
    h_ = h;
    clear_history();
    action = "taken in " + std::to_string(parts) + " parts";
  }
  if (!rescued.ok()) fetch(Kept::rescue);
  else if (++stats_.fallbacks <= 20) {
    stats_.first_fallbacks.push_back({steps_ + 1, time(), action});
  }
  SolveReport& report = rescued.ok() ? rescued : failed;
  const SolveReport& other = rescued.ok() ? failed : rescued;
  report.iterations += other.iterations;
  report.evaluations += other.evaluations;
  return report;
}

// h_ as two steps of half its size, each halved again where it fails.
SolveReport TimeLoop::halve(int level, int& parts) {
  SolveReport total;
  const double half = h_ / 2;
  for (int i = 0; i < 2 && total.ok(); ++i) {
    clear_history();  // of steps of another size
    h_ = half;
    SolveReport part = one_step();
    if (part.ok()) ++parts;
    else if (level < 10) {
      const SolveReport finer = halve(level + 1, parts);
      part = {finer.reason, finer.residual, part.iterations + finer.iterations,
              part.evaluations + finer.evaluations};
    }
    total = {part.reason, std::max(total.residual, part.residual),
             total.iterations + part.iterations, total.evaluations + part.evaluations};
  }
  return total;
}

Status TimeLoop::failure(const SolveReport& report) const {
  std::string reason = to_string(report.reason);
  if (setup_.on_failure == OnFailure::halve) reason += ", in halved steps too";
  if (setup_.on_failure == OnFailure::retry) {
    reason += ", and " + setup_.fallback_name + " failed too";
  }
  return {false, steps_ + 1, time(), report.residual, reason};
}

}  // namespace hamel
