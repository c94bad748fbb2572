#include <hamel/framework/ensemble/ensemble_plan.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/batch/places.hpp>
#include <hamel/framework/ensemble/member.hpp>
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/run/run/driver.hpp>

namespace hamel::ensemble {
namespace {

// The mistakes of a run, those about an option with the place of its key.
void add_placed(const EnsembleConfig& config, const std::vector<std::string>& found,
                std::vector<std::string>& mistakes) {
  for (const std::string& text : found) {
    std::string place = "system";
    for (const auto& [key, where] : config.where)
      if (text.starts_with(key + ":") || text.starts_with("unknown " + key + " ")) place = key;
    mistakes.push_back(placed(config.where, place, text));
  }
}

}  // namespace

Simulation simulation(const Registry& registry, const EnsembleConfig& config, const Config& run) {
  OwnSystem own{config.model};
  if (!own.make && names_file(run.system))
    own.make = data_system_maker(registry, run.system, config.data);
  Simulation out =
      own.make ? Simulation(registry, run.system, own) : Simulation(registry, run.system);
  return out.config(run);
}

Plan::Plan(const Registry& given, EnsembleConfig& from) : registry(given), config(from) {
  std::vector<std::string> mistakes;
  complete(from, mistakes);
  if (!mistakes.empty()) throw ConfigError(mistakes);
}

void Plan::complete(EnsembleConfig& from, std::vector<std::string>& mistakes) {
  if (from.keep.empty())
    mistakes.push_back(placed(config.where, "keep", "keep: nothing is kept of a member"));
  if (config.run.check)
    mistakes.push_back(placed(config.where, "check", "check: not of the members of an ensemble"));
  base = config.run;
  base.check = false;
  base.no_exact = true;
  base.output_step.reset();
  base.output_times.clear();
  rows = config.run.completed().recorded_times();
  try {
    const std::vector<std::string> wrong = simulation(base).mistakes();
    add_placed(config, wrong, mistakes);
    if (!wrong.empty()) return;
    Run run = simulation(base).build();
    if (give_inputs(run.system())) run = simulation(base).build();
    const SystemModel& system = run.system();
    resolved = run.config();
    fields = system.fields;
    geometry = registry.geometry(system.group.name, resolved.retraction);
    variations.emplace(from, system, mistakes);
    kept.emplace(config, system, *variations, mistakes);
    feedback.emplace(config, system, *variations, mistakes);
    lanes = find_lanes(run);
    if (variations->any(Target::Kind::energy) && system.mechanics->has_drift())
      mistakes.push_back(placed(config.where, "vary.start.velocity",
                                "start.velocity: the rows of this system move, and no energy "
                                "surface is uniform"));
  } catch (const ConfigError& error) {
    add_placed(config, error.mistakes(), mistakes);
  }
  check_trajectories(mistakes);
  check_unused(mistakes);
  if (!mistakes.empty()) return;
  for (const std::string& event : kept->events())
    if (std::ranges::find(base.events, event) == base.events.end()) base.events.push_back(event);
  add_placed(config, simulation(base).mistakes(), mistakes);
  if (!mistakes.empty()) return;
  try {  // components that the rows determine; another mistake is the member's own
    MemberRunner(*this).config(0);
  } catch (const ConfigError& error) {
    const std::string first = error.mistakes().front();
    if (first.starts_with("vary: ")) mistakes.push_back(placed(config.where, "vary", first));
  }
}

// Parts that nothing uses are read as those that something does.
void Plan::check_unused(std::vector<std::string>& mistakes) const {
  if (!config.statistics_of.empty() && config.statistics_at.empty())
    mistakes.push_back(placed(config.where, "statistics_of",
                              "statistics_of: expected statistics_at too, the times of these"));
  if (config.feedback.inputs.empty() && config.where.contains("feedback"))
    mistakes.push_back(
        placed(config.where, "feedback", "feedback: expected inputs by name, input = \"formula\""));
  if (!kept) return;
  for (const auto& [name, formula] : config.events) {
    if (std::ranges::find(kept->events(), formula) != kept->events().end()) continue;
    Config run = base;
    run.events.push_back(formula);
    for (const std::string& text : simulation(run).mistakes())
      mistakes.push_back(
          placed(config.where, "events." + name, fmt::format("events.{}: {}", name, text)));
  }
}

void Plan::check_trajectories(std::vector<std::string>& mistakes) const {
  constexpr size_t most = 100;
  const auto add = [&](const std::string& text) {
    mistakes.push_back(placed(config.where, "trajectories", "trajectories: " + text));
  };
  for (const long member : config.trajectories)
    if (member < 0 || member >= config.members)
      add(fmt::format("got {}, expected 0 to {}", member, config.members - 1));
  if (config.trajectories.size() > most)
    add(fmt::format("{} members, expected at most {}", config.trajectories.size(), most));
  if (!config.trajectories.empty() && !config.feedback.inputs.empty())
    add("a run has no inputs by formulas ([feedback])");
}

const LaneInfo* Plan::find_lanes(const Run& run) {
  const KernelSetup& setup = run.driver().plan().setup;
  const bool plain = !resolved.chooses_steps() && setup.composition.size() == 1 &&
                     setup.solver == nullptr && setup.inputs == nullptr;
  const bool nodes = kept->times().empty() && kept->events().empty() && base.events.empty() &&
                     !kept->wants_solver() && !kept->wants().any() &&
                     !(kept->wants_peaks() && !rows.empty());
  if (!plain || !nodes || feedback->any()) return nullptr;
  const std::string& group = run.system().group.name;
  const Mechanics& mechanics = *setup.mechanics;
  // Without a kernel of the same types the erased one runs, whose last digits differ.
  if (registry.kernel(group, mechanics, resolved.retraction, resolved.scheme) == nullptr)
    return nullptr;
  const LaneInfo* out = registry.lanes(group, mechanics, resolved.retraction, resolved.scheme);
  const std::string function = kept->function();
  if (out == nullptr || function.empty()) return out;
  alone = fmt::format("members run one by one, not in lanes: '{}' is a function of their run",
                      function);
  return nullptr;
}

// A first value to each input that is varied or fed back; were there any without?
bool Plan::give_inputs(const SystemModel& system) {
  bool out = false;
  for (const InputField& input : system.inputs) {
    const bool varied =
        std::ranges::any_of(config.vary, [&](const Variation& v) { return v.name == input.name; });
    if (varied || config.feedback.inputs.contains(input.name))
      out = base.inputs.try_emplace(input.name, 0.0).second || out;
  }
  return out;
}

bool Plan::builds_each() const {
  return variations->any(Target::Kind::parameter) || variations->any(Target::Kind::speed);
}

bool Plan::varies_start() const {
  return std::ranges::any_of(variations->targets(), [](const Target& t) {
    return t.kind != Target::Kind::parameter && t.kind != Target::Kind::input &&
           t.kind != Target::Kind::speed;
  });
}

}  // namespace hamel::ensemble
