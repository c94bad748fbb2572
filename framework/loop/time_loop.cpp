#include <hamel/framework/loop/time_loop.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace hamel {

SolveReport TimeLoop::recover(SolveReport failed) {
  if (setup_.on_failure == OnFailure::stop) return failed;
  save();
  const double h = h_;
  if (setup_.composition.size() > 1) forget();  // its first substeps are solved a second time
  SolveReport rescued;
  std::string action;
  if (setup_.on_failure == OnFailure::retry) {
    std::swap(setup_.solver, setup_.fallback);
    rescued = repeat_step();
    std::swap(setup_.solver, setup_.fallback);
    action = "solved by " + setup_.fallback_name;
  } else {
    int parts = 0;
    rescued = halve(1, parts);
    h_ = h;
    forget();
    action = "taken in " + std::to_string(parts) + " parts";
  }
  if (!rescued.ok()) restore();
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
    forget();  // of steps of another size
    h_ = half;
    SolveReport part = repeat_step();
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
