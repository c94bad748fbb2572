#include <hamel/framework/ensemble/feedback.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/batch/places.hpp>
#include <hamel/framework/io/errors.hpp>

namespace hamel::ensemble {

FeedbackFormulas::FeedbackFormulas(const EnsembleConfig& config, const SystemModel& system,
                                   const Variations& variations, std::vector<std::string>& mistakes)
    : states_(system, false), constants_(config, system, variations) {
  const std::vector<std::string> variables = constants_.behind(states_.names());
  for (const auto& [input, text] : config.feedback.inputs) {
    const std::string key = "feedback." + input;
    const auto wrong = [&, &name = input](const std::string& why) {
      mistakes.push_back(placed(config.where, key, fmt::format("feedback.{}: {}", name, why)));
    };
    std::vector<std::string> known;
    for (const InputField& field : system.inputs) known.push_back(field.name);
    if (std::ranges::find(known, input) == known.end())
      wrong(unknown_name("input of " + system.name, input, known));
    if (std::ranges::any_of(config.vary, [&, &name = input](auto& v) { return v.name == name; }))
      wrong("it is varied too");
    try {
      const StateNumber number(Expression(states_.state().in_formula(text), variables));
      number.require(states_.columns(), parts_);
      formulas_.emplace_back(input, number);
    } catch (const ExpressionError& error) {
      wrong(fmt::format("'{}': {}", text, states_.state().in_words(error.what())));
    }
  }
  const double period = config.feedback.period, steps = period / config.run.step_or_usual();
  const bool whole = std::abs(steps - std::round(steps)) < 1e-9 * std::abs(steps);
  if (!formulas_.empty() && !(period > 0 && std::isfinite(period)))
    mistakes.push_back(
        placed(config.where, "feedback", "feedback: expected a period above 0, in s"));
  else if (!formulas_.empty() && !config.run.completed().chooses_steps() && !(whole && steps > 0.5))
    mistakes.push_back(
        placed(config.where, "feedback",
               fmt::format("feedback: the period {} is not a multiple of the step, {}", period,
                           config.run.step_or_usual())));
}

void FeedbackFormulas::act(Run& run) {
  const Snapshot& state = run.state(parts_);
  for (const auto& [input, number] : formulas_)
    run.input(input, number(states_.columns(), state, {}, constants_.values(), work_));
}

}  // namespace hamel::ensemble
