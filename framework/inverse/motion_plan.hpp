// Plans: inputs, constant over each step, that take a system from one state to another at the least
// cost (`hamel plan`). Standard-library types only.
//
//   hamel::Plan plan = hamel::plan(hamel::read_plan("parking.toml"));
//   if (plan) simulate("sleigh.toml").step(plan.step).input("force", plan.table("force"))...
//
// The equations are those of the scheme themselves: a run with these inputs repeats the plan to
// round-off. Sources: Junge, Marsden, Ober-Bloebaum, Discrete mechanics and optimal control (2005);
// Kobilarov, Marsden, Discrete geometric optimal control on Lie groups, IEEE T-RO 27 (2011).
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/io/export.hpp>
#include <hamel/framework/mechanics/input_table.hpp>
#include <hamel/framework/run/names/config.hpp>

namespace hamel {

class PlanFeedback;
class Registry;

/// A free end time, between least and most.
struct FreeTime {
  double least = 0, most = 0;
};

struct PlanRequest {
  Config run = {};  // system, parameters, scheme, ...; its start is that of the plan, until its end
  long steps = 100;
  std::vector<std::string> inputs = {};  // those that the plan may use
  std::optional<FreeTime> free_time = {};
  /// The end: columns of the element, components of xi; none: free. No entries: all free.
  std::vector<std::optional<double>> to_configuration = {}, to_velocity = {};
  /// 1/2 integral of weight * input^2, for each input; 1 where not given.
  std::map<std::string, double> input_weights = {};
  std::string running = {}, terminal = {};  // formulas of quantities: integral, and at the end
  double time_weight = 0;                   // of the duration
  std::map<std::string, std::pair<double, double>> bounds = {};  // inputs and quantities
  std::vector<std::string> constraints = {};                     // "formula >= 0", "a < b"
  std::string guess_file = {};  // of a plan or a run, CSV: states and, where there, inputs
  unsigned seed = 1;            // of the guess: never the zero input
  std::string origin = {};      // of the file
  std::map<std::string, std::string> where = {};  // key: "file:line:column"
};

enum class PlanStatus { ok, out_of_reach, failed };

struct Plan {
  PlanStatus status = PlanStatus::failed;
  std::string reason;
  double objective = 0, until = 0, step = 0, defect_max = 0, seconds = 0;
  long steps = 0, iterations = 0;
  std::vector<double> t;                                            // N + 1
  std::vector<std::pair<std::string, std::vector<double>>> inputs;  // N values each
  std::vector<std::pair<std::string, std::vector<double>>> states;  // N + 1 values each
  std::map<std::string, double> missed;                             // goals, by how much
  std::map<std::string, double> goal_multipliers;
  std::vector<std::vector<double>> adjoint;  // lambda_k, by (eta, dy)
  std::vector<std::string> notes;
  Config run;  // that repeats the plan, its inputs as tables

  explicit operator bool() const { return status == PlanStatus::ok; }
  /// An input as a held table over the run. ConfigError with the nearest name.
  HAMEL_API InputTable table(const std::string& input) const;
  /// t and all inputs, as `--input name=plan.csv:hold` reads them.
  HAMEL_API std::string csv() const;

  /// The inputs of a step, from 0, in the order of `inputs`, corrected for a state beside the
  /// plan's by the gains of the plan: u_k + K_k e. Copies of a plan share work space: one thread at
  /// a time. Throws std::invalid_argument where the numbers are no state near the plan.
  HAMEL_API std::vector<double> feedback(long step, std::span<const double> configuration,
                                         std::span<const double> velocity) const;
  /// The gains K_k as a table: derivatives of each input by the displacement eta of the body, g =
  /// g_k tau(eta), and by its velocity.
  HAMEL_API std::string gains() const;
  std::shared_ptr<PlanFeedback> tracking;  // what both are computed with
};

/// Reads the file of a plan. Files that it names, of the system and of the guess, are beside it.
/// ConfigError with all mistakes, each with its line.
HAMEL_API PlanRequest read_plan(const std::string& path);
HAMEL_API PlanRequest parse_plan(const std::string& text, const std::string& origin);

/// ConfigError with all mistakes before anything is computed. progress: iteration, objective,
/// defect.
HAMEL_API Plan make_plan(const Registry& registry, const PlanRequest& request,
                         const std::function<void(long, double, double)>& progress = {},
                         const std::atomic<bool>* stop = nullptr);

}  // namespace hamel
