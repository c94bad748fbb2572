#include <hamel/framework/inverse/plan_builder.hpp>

#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/expression.hpp>
#include <hamel/framework/mechanics/output_formulas.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>
#include <hamel/framework/run/data/event_formula.hpp>

namespace hamel {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

}  // namespace

PlanBuilder::PlanBuilder(const Registry& registry, const PlanRequest& request)
    : registry_(registry), request_(request) {}

void PlanBuilder::mistake(const std::string& key, const std::string& what) {
  const auto at = request_.where.find(key);
  mistakes_.add(at == request_.where.end() ? fmt::format("{}: {}", key, what)
                                           : fmt::format("{}: {}: {}", at->second, key, what));
}

void PlanBuilder::complete_config() {
  config_ = request_.run;
  if (request_.steps < 2)
    mistake("steps", fmt::format("got {}, expected a whole number of 2 or more", request_.steps));
  if (config_.rtol || config_.atol) mistake("rtol", "a plan has steps of one size: until/steps");
  if (config_.step) mistake("step", "the step of a plan is until/steps");
  if (config_.scheme.empty()) config_.scheme = "lift";
  if (const auto& free = request_.free_time) {
    if (!(free->least > 0 && free->least < free->most && std::isfinite(free->most)))
      mistake("until", fmt::format("got least = {}, most = {}, expected 0 < least < most",
                                   free->least, free->most));
    config_.until = config_.from + (free->least + free->most) / 2;
  }
  if (!(config_.until > config_.from) || !std::isfinite(config_.until))
    mistake("until", fmt::format("got {}, expected seconds behind the start", config_.until));
  if (request_.inputs.empty()) mistake("inputs", "expected the inputs that the plan may use");
  mistakes_.refuse();
  config_.step = (config_.until - config_.from) / static_cast<double>(request_.steps);
  for (const std::string& name : request_.inputs) config_.inputs[name] = 0.0;
}

// A mistake of the run with the place of the key that it is about, else with the file alone.
std::string PlanBuilder::placed(const std::string& mistake) const {
  static constexpr std::pair<const char*, const char*> kKeys[] = {
      {"unknown input", "inputs"},         {"unknown system", "system"},
      {"unknown parameter", "parameters"}, {"unknown retraction", "retraction"},
      {"unknown scheme", "scheme"},        {"unknown solver", "solver"},
      {"velocity", "from.velocity"},       {"configuration", "from.configuration"}};
  for (const auto& [words, key] : kKeys)
    if (const auto at = request_.where.find(key);
        mistake.starts_with(words) && at != request_.where.end())
      return fmt::format("{}: {}", at->second, mistake);
  return request_.origin.empty() ? mistake : fmt::format("{}: {}", request_.origin, mistake);
}

RunPlan PlanBuilder::plan() {
  RunRequest run;
  run.config = config_;
  Mistakes found;
  RunPlan out = plan_run(registry_, run, nullptr, Rows::always, found);
  for (const std::string& one : found.all()) mistakes_.add(placed(one));
  mistakes_.refuse();
  config_ = out.config;
  return out;
}

void PlanBuilder::check_plan(const RunPlan& plan) {
  if (plan.contacts != nullptr)
    mistake("system", fmt::format("contacts of {} may slide or open: a plan needs equations that "
                                  "do not change",
                                  plan.system->name));
  if (plan.geometry == nullptr)
    mistake("system", fmt::format("the group of {} is not registered", plan.system->name));
  mistakes_.refuse();
}

std::vector<std::size_t> PlanBuilder::find_inputs(const SystemModel& system) {
  std::vector<std::size_t> out;
  for (const std::string& name : request_.inputs) {
    try {
      out.push_back(input_index(system.name, system.inputs, name));
    } catch (const ConfigError& error) {
      mistake("inputs", error.mistakes().front());
    }
  }
  mistakes_.refuse();
  return out;
}

// An input that is held over a step and enters b of A xi = b would strike at each node.
void PlanBuilder::check_rates(const RunPlan& plan, const std::vector<std::size_t>& inputs) {
  const Mechanics& mechanics = *plan.system->mechanics;
  const int n = mechanics.dim(), k = mechanics.constraint_count();
  std::vector<double> element(static_cast<std::size_t>(plan.geometry->size()));
  plan.geometry->from_coordinates(plan.setup.configuration, element.data());
  Eigen::MatrixXd rows(k, n);
  Eigen::VectorXd before(k), after(k);
  mechanics.constraints(config_.from, element.data(), rows, before);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    plan.setup.inputs->set(inputs[i], 1);
    mechanics.constraints(config_.from, element.data(), rows, after);
    plan.setup.inputs->set(inputs[i], 0);
    if (k > 0 && before != after)
      mistake("inputs",
              fmt::format("'{}' of {} is the rate of a row: held over a step it would jump, and "
                          "strike, at each node; expected a force or torque",
                          request_.inputs[i], plan.system->name));
  }
}

StateFormula PlanBuilder::formula(const SystemModel& system, const std::string& key,
                                  const std::string& text) {
  const QuantityNames names(system);
  const StateVariables variables(system, names.variables());
  try {
    const Expression read(names.in_formula(text), variables.names(),
                          constants_in_formulas(system, variables.names()));
    return {variables.value(read), variables.recorded(read)};
  } catch (const ExpressionError& error) {
    mistake(key, fmt::format("'{}': {}", text, names.in_words(variables.explain(error.what()))));
    return {};
  }
}

void PlanBuilder::set_costs(PlanStages& stages) {
  const auto count = static_cast<Eigen::Index>(request_.inputs.size());
  stages.weights.setOnes(count);
  for (const auto& [name, weight] : request_.input_weights) {
    const auto at = std::ranges::find(request_.inputs, name);
    if (at == request_.inputs.end())
      mistake("cost.inputs", unknown_name("input", name, request_.inputs));
    else if (!(weight >= 0) || !std::isfinite(weight))
      mistake("cost.inputs", fmt::format("{}: got {}, expected 0 or more", name, weight));
    else stages.weights[at - request_.inputs.begin()] = weight;
  }
  if (!std::isfinite(request_.time_weight))
    mistake("cost.time", fmt::format("got {}, expected a number", request_.time_weight));
  stages.time_weight = request_.time_weight;
  const SystemModel& system = stages.system();
  if (!request_.running.empty()) stages.running = formula(system, "cost.running", request_.running);
  if (!request_.terminal.empty())
    stages.terminal = formula(system, "cost.terminal", request_.terminal);
}

void PlanBuilder::set_bounds(PlanStages& stages) {
  const auto count = static_cast<Eigen::Index>(request_.inputs.size());
  stages.low.setConstant(count, -kUnbounded);
  stages.high.setConstant(count, kUnbounded);
  for (const auto& [name, range] : request_.bounds) {
    const auto [low, high] = range;
    const std::string key = "bounds." + name;
    if (!(low < high)) {
      mistake(key, fmt::format("got [{}, {}], expected low < high", low, high));
      continue;
    }
    const auto at = std::ranges::find(request_.inputs, name);
    if (at != request_.inputs.end()) {
      stages.low[at - request_.inputs.begin()] = low;
      stages.high[at - request_.inputs.begin()] = high;
      continue;
    }
    const StateFormula one = formula(stages.system(), key, name);
    const auto add = [&](double sign, double limit) {
      stages.path.push_back({[value = one.value, sign, limit](double t, std::span<const double> g,
                                                              std::span<const double> xi) {
                               return sign * (value(t, g, xi) - limit);
                             },
                             nullptr});
      if (one.record)
        stages.path.back().record = [record = one.record, sign, limit](
                                        const graph::Number& t, std::span<const graph::Number> g,
                                        std::span<const graph::Number> xi) {
          return sign * (record(t, g, xi) - limit);
        };
    };
    if (std::isfinite(low)) add(1, low);
    if (std::isfinite(high)) add(-1, high);
  }
  for (const std::string& text : request_.constraints) add_constraint(stages, text);
}

void PlanBuilder::add_constraint(PlanStages& stages, const std::string& text) {
  const std::size_t at = text.find_first_of("<>");
  if (at == std::string::npos || text.find_first_of("<>", at + 1) != std::string::npos)
    return mistake("constraints", fmt::format("got '{}', expected 'formula >= formula'", text));
  const std::size_t behind = at + (text.compare(at + 1, 1, "=") == 0 ? 2 : 1);
  const std::string left = text.substr(0, at), right = text.substr(behind);
  const std::string both = text[at] == '>' ? fmt::format("({}) - ({})", left, right)
                                           : fmt::format("({}) - ({})", right, left);
  stages.path_names.push_back(text);
  stages.path.push_back(formula(stages.system(), "constraints", both));
}

void PlanBuilder::add_goals(PlanStages& stages, const std::vector<std::optional<double>>& given,
                            const std::string& key, std::size_t first, std::size_t count) {
  if (given.empty()) return;
  if (given.size() != count)
    return mistake(key,
                   fmt::format("got {} entries, expected {} ({})", given.size(), count,
                               join({quantities_.begin() + static_cast<long>(first),
                                     quantities_.begin() + static_cast<long>(first + count)})));
  for (std::size_t i = 0; i < count; ++i)
    if (given[i])
      stages.goal_rows.push_back({quantities_[first + i], static_cast<int>(first + i), *given[i]});
}

void PlanBuilder::set_goals(PlanStages& stages) {
  const auto columns = static_cast<std::size_t>(stages.map.coordinate_count());
  const auto n = static_cast<std::size_t>(stages.map.velocities());
  const auto& to = request_.to_configuration;
  const bool all =
      to.size() == columns && std::ranges::all_of(to, [](const auto& x) { return x.has_value(); });
  if (all && columns > n) {  // a matrix: its entries depend on each other
    std::vector<double> coordinates;
    for (const std::optional<double>& x : to) coordinates.push_back(*x);
    try {
      stages.goal_place = stages.map.state_of(stages.from, coordinates, std::vector<double>(n, 0));
    } catch (const std::invalid_argument& error) {
      mistake("to.configuration", error.what());
    }
  } else {
    add_goals(stages, to, "to.configuration", 0, columns);
  }
  add_goals(stages, request_.to_velocity, "to.velocity", columns, n);
}

std::unique_ptr<PlanStages> PlanBuilder::stages() {
  complete_config();
  RunPlan planned = plan();
  check_plan(planned);
  const std::vector<std::size_t> inputs = find_inputs(*planned.system);
  check_rates(planned, inputs);
  quantities_ = QuantityNames(*planned.system).all();
  auto out = std::make_unique<PlanStages>(
      StepMap(std::make_shared<const RunPlan>(std::move(planned)), inputs));
  out->steps = static_cast<int>(request_.steps);
  out->from = config_.from;
  out->step = *config_.step;
  if (request_.free_time) {
    out->free_time = true;
    out->least_step = request_.free_time->least / static_cast<double>(request_.steps);
    out->most_step = request_.free_time->most / static_cast<double>(request_.steps);
  }
  set_costs(*out);
  set_bounds(*out);
  set_goals(*out);
  mistakes_.refuse();
  Eigen::VectorXd way;
  const MotionState last = goal_state(*out, carried(*out).back(), way);
  out->set_scales(way, last.xi);
  return out;
}

}  // namespace hamel
