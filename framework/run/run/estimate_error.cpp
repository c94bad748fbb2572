#include <hamel/framework/run/run/estimate_error.hpp>

#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/run/run/driver.hpp>

namespace hamel {
namespace {

// Divisor of step or tolerance in a finer run.
double finer_by(const Config& config) { return config.chooses_steps() ? 10 : 2; }

// The run as requested, with the scheme and the steps that it had.
Config with_method_of(const Config& resolved, Config asked) {
  asked.scheme = resolved.scheme;
  asked.step = resolved.step;
  asked.rtol = resolved.rtol;
  asked.atol = resolved.atol;
  return asked;
}

}  // namespace

// The steps of the first `runs` of this run and the two finer ones, in those of this run; a tenth
// of the tolerance takes some 10^(1/5) times as many.
double check_work(const Config& config, int runs) {
  const double more = config.chooses_steps() ? 1.6 : 2;
  return (std::pow(more, runs) - 1) / (more - 1);
}

// Richardson: with the ends x(h), x(h/2), x(h/4) the order is p = log2(|x(h) - x(h/2)| / |x(h/2) -
// x(h/4)|), the error of x(h) is |x(h) - x(h/2)| 2^p / (2^p - 1). Nothing is known where p is no
// order (below 0.5), unless the ends agree to round-off: then the error is below that, if no run
// stepped over something. Where steps are chosen, the same with a tenth and a hundredth of the
// tolerance in place of h/2, h/4, and p the power of the tolerance. The ends are at one time, the
// last of this run, which may be that of an event.
void estimate_error(const Registry& registry, const RunRequest& request, const OwnSystem* own,
                    Result& result) {
  const Config given = with_method_of(result.config, request.config);
  const double span = std::abs(result.last.time - given.from);
  if (!given.chooses_steps() && span < std::abs(given.step_or_usual())) {
    result.notes.push_back("check: the run ended within its first step: nothing is known");
    return;
  }
  const double factor = finer_by(given);
  std::vector<double> ends[3] = {result.last.coordinates, {}, {}};
  for (const int k : {1, 2}) {
    const double parts = std::pow(factor, k);
    RunRequest finer = request;
    finer.records.clear();  // the files are this run's
    finer.resumed.clear();
    finer.rows_kept = 1;
    Config& config = finer.config = given;
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
      *config.step /= parts;
    }
    finer.observer = [&](const Snapshot& end) {
      ends[k] = end.coordinates;
      return true;
    };
    finer.progress = [&](double done) {
      const double before = check_work(given, k), all = check_work(given, 3);
      if (request.progress)
        request.progress((before + done * (check_work(given, k + 1) - before)) / all);
    };
    const std::string which = fmt::format("check: the run with 1/{:g} of the {}", parts,
                                          config.chooses_steps() ? "tolerance" : "step");
    Mistakes mistakes;
    RunPlan plan = plan_run(registry, finer, own, Rows::always, mistakes);
    if (!mistakes.none()) {  // no reason to lose this run
      result.notes.push_back(fmt::format("{}: {}", which, mistakes.all().front()));
      return;
    }
    const Status status = Driver(std::move(plan), finer).complete();
    if (status.ok && !ends[k].empty()) continue;
    result.notes.push_back(
        fmt::format("{} failed at t = {:.6g}: {}", which, status.time, status.reason));
    return;
  }
  const double first = euclidean_distance(ends[0], ends[1]);
  const double second = euclidean_distance(ends[1], ends[2]);
  const double size = euclidean_distance(ends[2], std::vector<double>(ends[2].size(), 0.0));
  const double order = std::log(first / second) / std::log(factor);
  const double resolved = 1e-12 * (1 + size);
  if (first <= resolved) {
    result.estimated_error = resolved;  // a bound
  } else if (order > 0.5) {
    result.estimated_error = first / (1 - std::pow(factor, -order));
    result.observed_order = order;
  } else {
    result.notes.push_back(
        fmt::format("check: {} do not agree on an order: the ends differ by {:.2e}, then by {:.2e}",
                    finer_runs(given), first, second));
  }
}

}  // namespace hamel
