// hamel plan: inputs that take a system to a goal at the least cost, as a table that a run repeats.
#include "plan.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/inverse/motion_plan.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/note_lines.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/version.hpp>
#include <hamel/framework/pages/page.hpp>
#include <hamel/systems/by_name.hpp>

#include "commands.hpp"
#include "words/interrupt.hpp"
#include "words/screen.hpp"

namespace hamel::tools {

using pages::page_mistakes;
namespace {

using PlanJson = nlohmann::ordered_json;

const char* words(PlanStatus status) {
  switch (status) {
    case PlanStatus::ok: return "ok";
    case PlanStatus::out_of_reach: return "out_of_reach";
    case PlanStatus::failed: break;
  }
  return "failed";
}

PlanJson json_of(const Plan& plan) {
  PlanJson out = {{"status", words(plan.status)}};
  if (!plan.reason.empty()) out["reason"] = plan.reason;
  out["objective"] = plan.objective;
  out["steps"] = plan.steps;
  out["until"] = plan.until;
  out["defect_max"] = plan.defect_max;
  out["iterations"] = plan.iterations;
  out["seconds"] = plan.seconds;
  out["solver"] = "riccati";
  out["t"] = plan.t;
  out["inputs"] = out["states"] = PlanJson::object();
  for (const auto& [name, values] : plan.inputs) out["inputs"][name] = values;
  for (const auto& [name, values] : plan.states) out["states"][name] = values;
  out["multipliers"] = {{"goal", plan.goal_multipliers}, {"adjoint", plan.adjoint}};
  if (plan.status == PlanStatus::out_of_reach) out["missed"] = plan.missed;
  if (!plan.notes.empty()) out["notes"] = plan.notes;
  return out;
}

std::string numbers(const std::vector<double>& values) {
  std::string out;
  for (const double x : values) out += fmt::format("{}{:.17g}", out.empty() ? "" : ",", x);
  return out;
}

// The run that repeats the plan, as a command.
std::string command_of(const Plan& plan, const std::string& file) {
  const Config& run = plan.run;
  const Config usual;
  std::string out = fmt::format("hamel run {}", run.system);
  for (const char* option :
       {"scheme", "retraction", "s", "force_at", "solver", "tolerance", "compose", "from"}) {
    std::string flag = option;
    std::ranges::replace(flag, '_', '-');
    if (run.text(option) != usual.text(option))
      out += fmt::format(" --{} {}", flag, run.text(option));
  }
  out += fmt::format(" --step {:.17g} --until {:.17g}", plan.step, plan.until);
  for (const auto& [name, value] : run.parameters)
    out += fmt::format(" --set {}={}", name, numbers(value));
  if (!run.start.configuration.empty())
    out += fmt::format(" --configuration {}", numbers(run.start.configuration));
  if (!run.start.velocity.empty())
    out += fmt::format(" --velocity {}", numbers(run.start.velocity));
  for (const auto& [name, values] : plan.inputs)
    out += fmt::format(" --input {}={}:hold", name, file);
  return out;
}

void print(const PlanOptions& options, const Plan& plan) {
  std::string out =
      fmt::format("plan of {}: {} steps to t = {:.6g}\n", plan.run.system, plan.steps, plan.until);
  const auto line = [&](const char* name, const std::string& value) {
    out += fmt::format("  {:<12} {}\n", name, value);
  };
  line("status", plan.reason.empty() ? words(plan.status)
                                     : fmt::format("{}: {}", words(plan.status), plan.reason));
  line("objective", fmt::format("{:.12g}", plan.objective));
  line("defect", fmt::format("{:.1e} at most", plan.defect_max));
  line("iterations", fmt::format("{} in {:.3g} s", plan.iterations, plan.seconds));
  for (const auto& [goal, by] : plan.missed) line("missed", fmt::format("{} by {:.6g}", goal, by));
  for (const auto& [name, values] : plan.inputs) {
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (const double x : values) least = std::min(least, x), most = std::max(most, x);
    line("input", fmt::format("{} from {:.6g} to {:.6g}", name, least, most));
  }
  out += note_lines(plan.notes, 15, Notes{options.verbose});
  if (!options.output.empty()) line("run", command_of(plan, options.output));
  say("{}", out);
}

// "# key = value" above the table.
std::string table_of(const Plan& plan, const std::string& file) {
  return fmt::format("# hamel {}, plan of {}: {}, objective {:.17g}\n# {}\n{}", version(),
                     plan.run.system, words(plan.status), plan.objective, command_of(plan, file),
                     plan.csv());
}

void check_table(const char* option, const std::string& file) {
  if (file.empty()) return;
  if (!file.ends_with(".csv"))
    throw ConfigError({fmt::format("{}: got '{}', expected .csv", option, file)});
  if (const std::string why = unwritable(file); !why.empty()) throw ConfigError({why});
}

// The gains of a plan that reaches its goal.
void write_gains(const PlanOptions& options, const Plan& plan) {
  if (options.track.empty() || !plan) return;
  write_file(
      options.track,
      fmt::format("# hamel {}, gains along the plan of {}\n"
                  "# u = u_k + d(u)/d(eta) eta + d(u)/d(xi) (xi - xi_k), g = g_k tau(eta)\n{}",
                  version(), plan.run.system, plan.gains()));
}

// The page is that of the run that repeats the plan.
void write_page(const PlanOptions& options, const Plan& plan) {
  RunOptions running;
  running.config = plan.run;
  running.report = options.report;
  running.quiet = true;
  run(running);
}

}  // namespace

int plan(const PlanOptions& options) {
  if (!options.report.empty()) {
    if (const auto mistakes = page_mistakes(options.report); !mistakes.empty())
      throw ConfigError(mistakes);
  }
  check_table("--output", options.output);
  check_table("--track", options.track);
  const PlanRequest request = read_plan(options.file);
  const Plan plan = make_plan(registry(), request, {}, &stop_when_asked());
  if (!options.output.empty()) write_file(options.output, table_of(plan, options.output));
  write_gains(options, plan);
  if (!options.report.empty()) write_page(options, plan);
  if (options.json) say_json(json_of(plan));
  else if (!options.quiet) print(options, plan);
  return plan ? 0 : 1;
}

}  // namespace hamel::tools
