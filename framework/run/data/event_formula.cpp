#include <hamel/framework/run/data/event_formula.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/graph/number.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>

namespace hamel {
namespace {

// The place of the sign between the two sides: a single =, else a single < or >; npos where there
// is none.
size_t sign_of(const std::string& text) {
  const auto alone = [&](size_t i) {  // no part of ==, <=, >=, !=
    const auto sign = [](char c) { return c == '=' || c == '<' || c == '>' || c == '!'; };
    return (i == 0 || !sign(text[i - 1])) && (i + 1 == text.size() || !sign(text[i + 1]));
  };
  for (const std::string_view signs : {"=", "<>"}) {
    size_t found = std::string::npos, count = 0;
    for (size_t i = 0; i < text.size(); ++i) {
      if (signs.find(text[i]) == std::string_view::npos || !alone(i)) continue;
      found = i;
      ++count;
    }
    if (count == 1) return found;
    if (count > 1) break;
  }
  return std::string::npos;
}

}  // namespace

StateVariables::StateVariables(const SystemModel& system, std::vector<std::string> names)
    : names_(std::move(names)), own_(names_.size()) {
  for (const Sensor& sensor : system.sensors) {
    const std::size_t count = std::min(sensor.first_acceleration, sensor.columns.size());
    sensors_.push_back({sensor, names_.size(), count});
    names_.insert(names_.end(), sensor.columns.begin(),
                  sensor.columns.begin() + static_cast<std::ptrdiff_t>(count));
  }
  outputs_ = ready_outputs(system, names_, [&](const OutputFormula& output, const std::string&) {
    left_out_.push_back(output.name);
  });
}

std::pair<std::vector<bool>, std::vector<ReadyOutput>> StateVariables::needs(
    const Expression& formula) const {
  std::vector<bool> wanted(names_.size());
  const auto want = [&](const Expression& of) {
    for (const std::size_t i : of.used()) wanted[i] = true;
  };
  want(formula);
  std::vector<ReadyOutput> outputs;
  for (std::size_t i = outputs_.size(); i-- > 0;) {
    if (!wanted[outputs_[i].place]) continue;
    want(outputs_[i].formula);
    outputs.insert(outputs.begin(), outputs_[i]);
  }
  return {std::move(wanted), std::move(outputs)};
}

StateVariables::Recorded StateVariables::recorded(Expression formula) const {
  auto [wanted, outputs] = needs(formula);
  for (const Measured& measured : sensors_)
    for (std::size_t i = 0; i < measured.count; ++i)
      if (wanted[measured.first + i]) return {};
  return [formula = std::move(formula), outputs = std::move(outputs), count = names_.size()](
             const graph::Number& t, std::span<const graph::Number> g,
             std::span<const graph::Number> xi) {
    std::vector<graph::Number> values(count);
    values[0] = t;
    std::ranges::copy(g, values.begin() + 1);
    std::ranges::copy(xi, values.begin() + 1 + static_cast<std::ptrdiff_t>(g.size()));
    for (const ReadyOutput& output : outputs) values[output.place] = output.formula.record(values);
    return formula.record(values);
  };
}

StateVariables::Value StateVariables::value(Expression formula) const {
  auto [wanted, outputs] = needs(formula);
  std::vector<Measured> sensors;
  for (const Measured& measured : sensors_)
    for (std::size_t i = 0; i < measured.count; ++i)
      if (wanted[measured.first + i]) {
        sensors.push_back(measured);
        break;
      }
  return [formula = std::move(formula), outputs = std::move(outputs), sensors = std::move(sensors),
          values = std::vector<double>(names_.size()), measured = std::vector<double>()](
             double t, std::span<const double> g, std::span<const double> xi) mutable {
    values[0] = t;
    std::copy(g.begin(), g.end(), values.begin() + 1);
    std::copy(xi.begin(), xi.end(), values.begin() + 1 + static_cast<std::ptrdiff_t>(g.size()));
    for (const Measured& from : sensors) {
      measured.resize(from.sensor.columns.size());
      from.sensor.value(g, xi, {}, measured);
      std::copy_n(measured.begin(), from.count,
                  values.begin() + static_cast<std::ptrdiff_t>(from.first));
    }
    for (const ReadyOutput& output : outputs) values[output.place] = output.formula(values);
    return formula(values);
  };
}

std::string StateVariables::explain(const std::string& message) const {
  for (const std::string& name : left_out_)
    if (message.find("'" + name + "'") != std::string::npos)
      return fmt::format(
          "the output '{}' depends on columns that are no function of t, coordinates and "
          "velocities, as accelerations, reactions and energies",
          name);
  return message;
}

std::optional<Event> event_of_formula(const SystemModel& system, const std::string& text,
                                      std::vector<std::string>& mistakes) {
  const size_t at = sign_of(text);
  if (at == std::string::npos) return {};
  const std::string formula = fmt::format("({}) - ({})", text.substr(0, at), text.substr(at + 1));
  Event out{text, "both sides are equal", 0, {}};
  if (text[at] == '>') out.meaning = "the left side becomes larger", out.direction = 1;
  if (text[at] == '<') out.meaning = "the left side becomes smaller", out.direction = -1;
  const QuantityNames names(system);
  const StateVariables variables(system, names.variables());
  try {
    out.value = variables.value(Expression(names.in_formula(formula), variables.names(),
                                           constants_in_formulas(system, variables.names())));
    return out;
  } catch (const ExpressionError& error) {
    mistakes.push_back(
        fmt::format("events: '{}': {}", text, names.in_words(variables.explain(error.what()))));
    return {};
  }
}

}  // namespace hamel
