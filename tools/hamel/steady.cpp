// hamel steady: a steady motion near a guess, its eigenvalues; along a parameter, with the points
// where stability changes.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/figures/figures.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/note_lines.hpp>
#include <hamel/framework/mechanics/system.hpp>
#include <hamel/framework/pages/page.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/run/record/velocity_text.hpp>
#include <hamel/systems/by_name.hpp>

#include "pages/steady_page.hpp"
#include "steady.hpp"
#include "words/screen.hpp"
#include "words/steady_json.hpp"

namespace hamel::tools {

using pages::page_mistakes;
namespace {

constexpr int kMostPoints = 100000;
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
    if (count != std::floor(count) || count < 2 || count > kMostPoints) {
      throw ConfigError({fmt::format("--vary: got {} values, expected a whole number from 2 to {}",
                                     count, kMostPoints)});
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

// Lines of a motion, where one was found, and of a sweep with its branches. vary: may be null.
void print(const SystemModel& system, const SteadyMotion& motion, const Vary* vary,
           const SteadySweep& sweep) {
  if (motion.found) print(system, motion);
  else if (vary == nullptr) say("{}: no steady motion was found near this start\n", system.name);
  if (vary == nullptr) return;
  print(vary->name, sweep);
  for (size_t i = 0; i < sweep.branches.size(); ++i) {
    say("  branch {}, from {} = {:.6g} on\n", i + 2, vary->name, sweep.branches[i].start->value);
    print(vary->name, sweep.branches[i]);
  }
}

// The system of a line, its parameters and start: what a page can be made again from.
std::string command_line(const SteadyOptions& options) {
  std::string out = "hamel steady " + options.config.system;
  for (const auto& [name, value] : options.config.parameters)
    out += fmt::format(" --set {}={}", name, join(value));
  if (options.config.speed) out += fmt::format(" --speed {}", *options.config.speed);
  for (const std::string& value : options.config.start_values) out += " --start " + value;
  const Start& start = options.config.start;
  if (!start.configuration.empty())
    out += fmt::format(" --configuration {}", join(start.configuration));
  if (!start.velocity.empty()) out += fmt::format(" --velocity {}", join(start.velocity));
  if (!options.vary.empty()) out += " --vary " + options.vary;
  return out + (options.branches ? " --branches" : "");
}

// Refuses options that contradict each other, before anything runs.
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

// "" where the motion has the velocities that were asked for, else those that it has.
std::string moved(const SystemModel& system, const Config& config, const SteadyMotion& motion) {
  if (!config.speed || !motion.found || !system.start_at_speed) return "";
  const std::vector<double> asked = system.start_at_speed(*config.speed, config.from).velocity;
  double most = 0;
  for (const double x : asked) most = std::max(most, std::abs(x));
  std::string out;
  for (size_t i = 0; i < asked.size(); ++i)
    if (std::abs(motion.velocity[i] - asked[i]) > 1e-6 * most)
      out += fmt::format("{}{} = {:.6g} for {:.6g}", out.empty() ? "" : ", ", system.rates[i],
                         std::abs(motion.velocity[i]) > 1e-9 * most ? motion.velocity[i] : 0,
                         asked[i]);
  if (out.empty()) return out;
  return fmt::format("the start at the speed {} is no steady motion; the nearest one found has {}",
                     *config.speed, out);
}

// --vary names the speed, where the system defines a straight motion, or a parameter.
void refuse_unknown(const SystemModel& system, const std::string& name) {
  std::vector<std::string> known;
  for (const Field& field : system.fields) known.push_back(field.name);
  if (system.start_at_speed) known.emplace_back("speed");
  if (std::ranges::find(known, name) == known.end())
    throw ConfigError({"--vary: " + unknown_name("parameter of " + system.name, name, known)});
}

void refuse_large(const SystemModel& system) {
  if (system.group.dim > kMostDimension)
    throw ConfigError(
        {fmt::format("{}: its dimension {} is above {}, the most whose steady "
                     "motions are looked for",
                     system.name, system.group.dim, kMostDimension)});
}

}  // namespace

int steady(const SteadyOptions& options) {
  std::optional<Vary> vary;
  if (!options.vary.empty()) vary.emplace(options.vary);
  refuse_mistakes(options, vary.has_value());
  if (vary) refuse_unknown(at(options, "", 0).build().system(), vary->name);
  const Simulation first = at(options, vary ? vary->name : "", vary ? vary->values[0] : 0);
  const Run built = first.build();
  const SystemModel& system = built.system();
  refuse_large(system);
  const SteadyMotion motion = steady_motion(registry(), first);
  SteadySweep sweep;
  if (vary) {
    const auto there = [&](double value) { return at(options, vary->name, value); };
    sweep = sweep_steady(registry(), vary->values, there, options.branches);
    sweep.parameter = vary->name;
    sweep.unit = figures::unit_of(vary->name, system);
  }
  const std::string note = vary ? "" : moved(system, first.config(), motion);
  if (options.json) {
    auto out = steady_json(options, first, system, motion, vary ? &sweep : nullptr);
    if (!note.empty()) out["notes"] = {note};
    say_json(out);
  } else {
    print(system, motion, vary ? &*vary : nullptr, sweep);
    if (!note.empty()) say("{}", note_lines({note}, 16, Notes{options.verbose}));
  }
  if (!options.report.empty())
    steady_page(system, sweep, command_line(options)).write(options.report);
  if (motion.found || std::any_of(sweep.motions.begin(), sweep.motions.end(),
                                  [](const SteadyMotion& one) { return one.found; }))
    return 0;
  complain("hamel: no steady motion near this start: a residual of {:.2e} is left\n",
           motion.residual);
  return 1;
}

}  // namespace hamel::tools
