// hamel steady: a steady motion near a guess, its eigenvalues; along a parameter, with the points
// where stability changes.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/analysis/linearisation.hpp>
#include <hamel/framework/mechanics/system.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/run/record/velocity_text.hpp>
#include <hamel/systems/by_name.hpp>

#include "run_page.hpp"
#include "screen.hpp"
#include "steady.hpp"
#include "steady_page.hpp"

namespace hamel::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMostValues = 100000;
constexpr int kMostDimension = 100;  // n^4 operations a motion

// name=from:to:count, or name=from:to for 101 values.
struct Vary {
  std::string name;
  std::vector<double> values;

  explicit Vary(const std::string& text) {
    const auto wrong = [&] {
      return ConfigError({fmt::format("--vary: got '{}', expected name=from:to:count", text)});
    };
    const size_t equal = text.find('=');
    if (equal == std::string::npos || equal == 0) throw wrong();
    name = text.substr(0, equal);
    std::vector<double> numbers;
    for (size_t at = equal; at != std::string::npos;) {
      const size_t from = at + 1;
      at = text.find(':', from);
      read_text("--vary", text.substr(from, at - from), numbers.emplace_back());
      if (!std::isfinite(numbers.back())) throw wrong();
    }
    if (numbers.size() == 2) numbers.push_back(101);
    if (numbers.size() != 3) throw wrong();
    const double count = numbers[2];
    if (count != std::floor(count) || count < 2 || count > kMostValues) {
      throw ConfigError({fmt::format("--vary: got {} values, expected a whole number from 2 to {}",
                                     count, kMostValues)});
    }
    for (int i = 0; i < count; ++i) {
      values.push_back(numbers[0] + (numbers[1] - numbers[0]) * i / (count - 1));
    }
  }
};

Simulation at(const SteadyOptions& options, const std::string& name, double value) {
  Config config = options.config;
  if (name == "speed") config.speed = value;
  else if (!name.empty()) config.parameters[name] = {value};
  Simulation out(registry(), config.system);
  return out.config(config);
}

// To the digits that are known.
Json eigenvalues_of(const SteadyMotion& motion) {
  Json out = Json::array();
  for (size_t i = 0; i < motion.eigenvalues.size(); ++i) {
    const auto x = motion.eigenvalues[i];
    out.push_back({round_to_known(x.real(), motion.round_off[i]),
                   round_to_known(x.imag(), motion.round_off[i])});
  }
  return out;
}

// Null where an error covers the verdict.
Json growing_of(const SteadyMotion& motion) {
  const std::optional<int> growing = motion.decided_growing();
  return growing ? Json(*growing) : Json();
}

// Of each eigenvalue what moves, velocities first.
Json modes_of(const SteadyMotion& motion) {
  Json out = Json::array();
  for (const std::vector<ModePart>& mode : motion.modes) {
    Json& parts = out.emplace_back(Json::object());
    for (const ModePart& part : mode) parts[part.name] = part.size;
  }
  return out;
}

Json json_of(const SteadyPlace& place) {
  return {{"value", place.value}, {"element", place.element}, {"velocity", place.velocity}};
}

Json json_of(const NumberMatrix& m) {
  Json out = Json::array();
  for (int i = 0; i < m.rows; ++i) {
    Json row = Json::array();
    for (int j = 0; j < m.columns; ++j) row.push_back(m(i, j));
    out.push_back(row);
  }
  return out;
}

Json json_of(const Linearisation& linear, const std::optional<double>& sample_time) {
  Json out = {{"states", linear.states},
              {"inputs", linear.inputs},
              {"quantities", linear.quantities},
              {"A", json_of(linear.a)},
              {"B", json_of(linear.b)},
              {"C", json_of(linear.c)},
              {"errors",
               {{"A", json_of(linear.a_error)},
                {"B", json_of(linear.b_error)},
                {"C", json_of(linear.c_error)}}},
              {"values", linear.values},
              {"embedding", json_of(linear.embedding)},
              {"unused_inputs", linear.unused}};
  if (sample_time) {
    const DiscretePair pair = linear.sampled(*sample_time);
    out["discrete"] = {
        {"sample_time", *sample_time}, {"A", json_of(pair.a)}, {"B", json_of(pair.b)}};
  }
  return out;
}

Json json_of(const SteadySweep& sweep) {
  Json out = {{"vary", Json::array()}, {"crossings", Json::array()}};
  for (size_t i = 0; i < sweep.values.size(); ++i) {
    const SteadyMotion& motion = sweep.motions[i];
    Json& entry = out["vary"].emplace_back(Json{{"value", sweep.values[i]},
                                                {"found", motion.found},
                                                {"eigenvalues", eigenvalues_of(motion)},
                                                {"eigenvalue_errors", motion.round_off},
                                                {"round_off", motion.round_off},
                                                {"growing", growing_of(motion)}});
    if (motion.found)
      entry["motion"] = {{"element", motion.element}, {"velocity", motion.velocity}};
  }
  for (const SteadyCrossing& crossing : sweep.crossings) {
    out["crossings"].push_back(
        {{"value", round_to_known(crossing.value, crossing.round_off)},
         {"round_off", crossing.round_off},
         {"kind", crossing.pair ? "pair" : "real"},
         {"bifurcation", name_of(crossing.kind)},
         {"supercritical", crossing.supercritical ? Json(*crossing.supercritical) : Json()},
         {"other", crossing.other ? json_of(*crossing.other) : Json()}});
  }
  out["ends"] = Json::array();
  for (const SteadyEnd& end : sweep.ends) {
    out["ends"].push_back({{"value", round_to_known(end.value, end.round_off)},
                           {"round_off", end.round_off},
                           {"towards", end.towards_last ? "last" : "first"},
                           {"bifurcation", name_of(end.kind)},
                           {"other", end.other ? json_of(*end.other) : Json()}});
  }
  out["end"] = sweep.ends.empty() ? Json() : out["ends"][0];
  return out;
}

void print(const SystemModel& system, const SteadyMotion& motion) {
  say("{}: steady motion, residual {:.1e}\n", system.name, motion.residual);
  say("  velocity      {}\n", velocity_in_words(system, motion.velocity));
  say("  as a start    --configuration {} --velocity {}\n", start_text(motion.element),
      start_text(motion.velocity));
  say("  neutral       {}, of them {} along the family of steady motions\n", motion.neutral,
      motion.family);
  say("  {}\n", stability_text(motion));
  say("  eigenvalues [1/s], and what moves\n");
  for (size_t i = 0; i < motion.eigenvalues.size(); ++i) {
    const auto x = motion.eigenvalues[i];
    const double known = motion.round_off[i];
    if (x.imag() < -known) continue;  // printed with its conjugate
    const std::string imaginary =
        x.imag() > known ? fmt::format("+- {}i", known_text(x.imag(), known)) : "";
    say("    {:>18} {:<21} {}\n", known_text(x.real(), known), imaginary,
        modes_text(motion.modes[i]));
  }
}

void print(const std::string& name, const SteadySweep& sweep) {
  say("  {:>12}  growing  largest real part [1/s]\n", name);
  for (size_t i = 0; i < sweep.values.size(); ++i) {
    const SteadyMotion& motion = sweep.motions[i];
    if (!motion.found) {
      say("  {:>12.6g}  not on this branch\n", sweep.values[i]);
      continue;
    }
    const bool any = !motion.eigenvalues.empty();
    const std::optional<int> growing = motion.decided_growing();
    say("  {:>12.6g}  {:>7}  {}\n", sweep.values[i],
        growing ? std::to_string(*growing) : fmt::format("{} ?", motion.growing()),
        any ? known_text(motion.eigenvalues[0].real(), motion.round_off[0]) : "0");
  }
  for (const SteadyCrossing& crossing : sweep.crossings) {
    say("  stability changes at {} = {}\n", name, crossing_text(crossing));
    if (crossing.other && crossing.kind != Bifurcation::family) print_other(name, *crossing.other);
  }
  print_ends(name, sweep);
}

// The system of a line, its parameters and start: what a page can be made again from.
std::string command_line(const SteadyOptions& options) {
  std::string out = "hamel steady " + options.config.system;
  for (const auto& [name, value] : options.config.parameters)
    out += fmt::format(" --set {}={}", name, join(value));
  if (options.config.speed) out += fmt::format(" --speed {}", *options.config.speed);
  const Start& start = options.config.start;
  if (!start.configuration.empty())
    out += fmt::format(" --configuration {}", join(start.configuration));
  if (!start.velocity.empty()) out += fmt::format(" --velocity {}", join(start.velocity));
  if (!options.vary.empty()) out += " --vary " + options.vary;
  return out + (options.branches ? " --branches" : "");
}

// What cannot be, before anything runs.
void refuse_mistakes(const SteadyOptions& options, bool vary) {
  if (options.branches && !vary)
    throw ConfigError({"--branches: branches meet along a parameter; give --vary"});
  if (options.sample_time && (!options.json || vary))
    throw ConfigError({"--sample-time: the discrete pair is in --json, without --vary"});
  if (options.sample_time && !(*options.sample_time > 0 && std::isfinite(*options.sample_time)))
    throw ConfigError(
        {fmt::format("--sample-time: got {}, expected a number above 0", *options.sample_time)});
  if (!options.report.empty()) {
    if (!vary)
      throw ConfigError({"--report: the page shows eigenvalues along a parameter; give --vary"});
    if (const auto mistakes = page_mistakes(options.report); !mistakes.empty())
      throw ConfigError(mistakes);
  }
}

// sweep: none without --vary.
Json answer(const SteadyOptions& options, const Simulation& first, const SystemModel& system,
            const SteadyMotion& motion, const SteadySweep* sweep) {
  Json out = {{"system", options.config.system},
              {"parameters", Json::object()},
              {"motion", {{"element", motion.element}, {"velocity", motion.velocity}}},
              {"residual", motion.residual},
              {"eigenvalues", eigenvalues_of(motion)},
              {"eigenvalue_errors", motion.round_off},
              {"round_off", motion.round_off},
              {"growing", growing_of(motion)},
              {"modes", modes_of(motion)},
              {"neutral", motion.neutral}};
  for (const Field& field : system.fields) out["parameters"][field.name] = field.value;
  if (motion.found && sweep == nullptr)
    out["linearisation"] = json_of(linearisation(registry(), first), options.sample_time);
  if (sweep != nullptr) {
    out.update(json_of(*sweep));
    if (options.branches) out["branches"] = Json::array();
    for (const SteadySweep& branch : sweep->branches) {
      Json& entry = out["branches"].emplace_back(json_of(branch));
      entry["start"] = json_of(*branch.start);
    }
  }
  return out;
}

}  // namespace

int steady(const SteadyOptions& options) {
  std::optional<Vary> vary;
  if (!options.vary.empty()) vary.emplace(options.vary);
  refuse_mistakes(options, vary.has_value());
  const Simulation first = at(options, vary ? vary->name : "", vary ? vary->values[0] : 0);
  const Run built = first.build();
  const SystemModel& system = built.system();
  if (system.group.dim > kMostDimension)
    throw ConfigError(
        {fmt::format("{}: its dimension {} is above {}, the most whose steady "
                     "motions are looked for",
                     system.name, system.group.dim, kMostDimension)});
  const SteadyMotion motion = steady_motion(registry(), first);
  SteadySweep sweep;
  if (vary) {
    const auto there = [&](double value) { return at(options, vary->name, value); };
    sweep = sweep_steady(registry(), vary->values, there, options.branches);
  }
  const bool any = std::any_of(sweep.motions.begin(), sweep.motions.end(),
                               [](const SteadyMotion& one) { return one.found; });
  if (options.json) {
    say_json(answer(options, first, system, motion, vary ? &sweep : nullptr));
  } else {
    if (motion.found) print(system, motion);
    else if (!vary) say("{}: no steady motion was found near this start\n", system.name);
    if (vary) print(vary->name, sweep);
    for (size_t i = 0; i < sweep.branches.size(); ++i) {
      say("  branch {}, from {} = {:.6g} on\n", i + 2, vary->name, sweep.branches[i].start->value);
      print(vary->name, sweep.branches[i]);
    }
  }
  if (!options.report.empty())
    steady_page(vary->name, system, sweep, command_line(options)).write(options.report);
  if (motion.found || any) return 0;
  complain("hamel: no steady motion near this start: a residual of {:.2e} is left\n",
           motion.residual);
  return 1;
}

}  // namespace hamel::tools
