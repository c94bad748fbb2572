// hamel steady: a steady motion near a guess, its eigenvalues; along a parameter, with the points where stability changes.
#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/analysis/steady.hpp>
#include <hamel/framework/mechanics/system.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/systems/by_name.hpp>

#include "page.hpp"
#include "run_page.hpp"
#include "screen.hpp"
#include "steady.hpp"

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
    const char *at = text.data() + equal + 1, *const end = text.data() + text.size();
    while (true) {
      double x = 0;
      const auto [next, error] = std::from_chars(at, end, x);
      if (error != std::errc() || !std::isfinite(x)) throw wrong();
      numbers.push_back(x);
      if (next == end) break;
      if (*next != ':') throw wrong();
      at = next + 1;
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

Json eigenvalues_of(const SteadyMotion& motion) {
  Json out = Json::array();
  for (const auto& x : motion.eigenvalues) out.push_back({x.real(), x.imag()});
  return out;
}

std::string modes(const std::vector<ModePart>& parts) {
  std::string out;
  for (const ModePart& part : parts) {
    out += fmt::format("{}{} {:.2f}", out.empty() ? "" : ", ", part.name, part.size);
  }
  return out;
}

void print(const std::string& system, const SteadyMotion& motion) {
  say("{}: steady motion, residual {:.1e}\n", system, motion.residual);
  say("  configuration {}\n  velocity      {}\n", join(motion.element), join(motion.velocity));
  say("  neutral       {}, of them {} along the family of steady motions\n", motion.neutral,
      motion.family);
  const int growing = motion.growing();
  say("  {}\n", growing > 0 ? fmt::format("unstable: {} growing", growing) : "no growing mode");
  say("  eigenvalues [1/s], and what moves\n");
  for (size_t i = 0; i < motion.eigenvalues.size(); ++i) {
    const auto x = motion.eigenvalues[i];
    if (x.imag() < 0) continue;  // told with its conjugate
    const std::string imaginary = x.imag() > 0 ? fmt::format("+- {:.12f}i", x.imag()) : "";
    say("    {:>18.12f} {:<21} {}\n", x.real(), imaginary, modes(motion.modes[i]));
  }
}

void print(const Vary& vary, const SteadySweep& sweep) {
  say("  {:>12}  growing  largest real part [1/s]\n", vary.name);
  for (size_t i = 0; i < sweep.values.size(); ++i) {
    const SteadyMotion& motion = sweep.motions[i];
    if (!motion.found) {
      say("  {:>12.6g}  no steady motion found\n", sweep.values[i]);
      continue;
    }
    const double most = motion.eigenvalues.empty() ? 0 : motion.eigenvalues[0].real();
    say("  {:>12.6g}  {:>7}  {:.9g}\n", sweep.values[i], motion.growing(), most);
  }
  for (const auto& crossing : sweep.crossings) {
    say("  stability changes at {} = {:.14g}, {}\n", vary.name, crossing.value,
        crossing.pair ? "a pair of complex eigenvalues" : "a real eigenvalue");
  }
}

// The unit of what is varied; "" where it has none.
std::string unit_of(const Vary& vary, const SystemModel& system) {
  std::string out;
  Config::fields([&](const Option& option, auto) {
    if (option.name == vary.name) out = option.unit;
  });
  for (const Field& field : system.fields)
    if (field.name == vary.name) out = field.unit;
  return out;
}

// Real and imaginary parts as points: branches meet and part, and nothing says which value goes on in which.
void add_plots(Page& page, const Vary& vary, const SystemModel& system, const SteadySweep& sweep) {
  constexpr size_t most = 600;  // values that a figure tells apart
  Series real{.name = "Real parts of the eigenvalues", .x = {}, .y = {}, .dots = true};
  real.key = "eigenvalues";
  Series imaginary = real;
  imaginary.name = "Imaginary parts of the eigenvalues";
  const size_t stride = (sweep.values.size() + most - 1) / most;
  for (size_t i = 0; i < sweep.values.size(); i += stride) {
    for (const auto& x : sweep.motions[i].eigenvalues) {
      real.x.push_back(sweep.values[i]);
      real.y.push_back(x.real());
      imaginary.x.push_back(sweep.values[i]);
      imaginary.y.push_back(x.imag());
    }
  }
  std::string note;
  for (const auto& crossing : sweep.crossings) {
    note += fmt::format("{}stability changes at {} = {:.10g} ({})", note.empty() ? "" : "; ",
                        vary.name, crossing.value, crossing.pair ? "complex pair" : "real");
  }
  if (stride > 1)
    note += fmt::format("{}one value in {} is drawn", note.empty() ? "" : "; ", stride);
  const std::string x = with_unit(vary.name, unit_of(vary, system));
  page.plot(real.name, {.x = x, .y = "real part [1/s]"}, {real}, note);
  page.plot(imaginary.name, {.x = x, .y = "imaginary part [rad/s]"}, {imaginary});
}

}  // namespace

int steady(const SteadyOptions& options) {
  std::optional<Vary> vary;
  if (!options.vary.empty()) vary.emplace(options.vary);
  if (!options.report.empty()) {
    if (!vary)
      throw ConfigError({"--report: the page shows eigenvalues along a parameter; give --vary"});
    if (const auto mistakes = page_mistakes(options.report); !mistakes.empty())
      throw ConfigError(mistakes);
  }
  const bool by_speed = vary && vary->name == "speed";
  const Simulation first = at(options, by_speed ? "speed" : "", by_speed ? vary->values[0] : 0);
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
    sweep = sweep_steady(vary->values, [&](double value, int family) {
      return steady_motion(registry(), at(options, vary->name, value), family);
    });
  }
  if (options.json) {
    Json out = {{"system", options.config.system},
                {"parameters", Json::object()},
                {"motion", {{"element", motion.element}, {"velocity", motion.velocity}}},
                {"residual", motion.residual},
                {"eigenvalues", eigenvalues_of(motion)},
                {"neutral", motion.neutral}};
    for (const Field& field : system.fields) out["parameters"][field.name] = field.value;
    if (vary) {
      out["vary"] = out["crossings"] = Json::array();
      for (size_t i = 0; i < sweep.values.size(); ++i) {
        out["vary"].push_back(
            {{"value", sweep.values[i]}, {"eigenvalues", eigenvalues_of(sweep.motions[i])}});
      }
      for (const auto& crossing : sweep.crossings) {
        out["crossings"].push_back(
            {{"value", crossing.value}, {"kind", crossing.pair ? "pair" : "real"}});
      }
    }
    say_json(out);
  } else if (!motion.found && !vary) {
    say("{}: no steady motion was found near this start\n", system.name);
  } else {
    if (motion.found) print(system.name, motion);
    if (vary) print(*vary, sweep);
  }
  if (!options.report.empty()) {
    Page page(fmt::format("{}: steady motions", system.name), "eigenvalues along " + vary->name);
    page.section("Stability");
    add_plots(page, *vary, system, sweep);
    page.write(options.report);
  }
  if (motion.found) return 0;
  complain("hamel: no steady motion near this start: a residual of {:.2e} is left\n",
           motion.residual);
  return 1;
}

}  // namespace hamel::tools
