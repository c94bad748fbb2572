#include "steady_page.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/system.hpp>
#include <hamel/framework/run/names/config.hpp>

#include "screen.hpp"

namespace hamel::tools {

std::string known_text(double x, double round_off) {
  const double known = std::max(round_off, 1e-12);
  return fmt::format("{:.{}f}", round_to_known(x, known), known_decimals(known));
}

std::string stability_text(const SteadyMotion& motion) {
  const int growing = motion.growing();
  if (motion.decided_growing())
    return growing > 0 ? fmt::format("unstable: {} growing", growing) : "no growing mode";
  const std::string bound = fmt::format("{:.1e}", motion.largest_growth());
  if (growing == 0) return fmt::format("not decided: no mode grows faster than {} 1/s", bound);
  return fmt::format("unstable: {} growing, the sign of others is not decided", growing);
}

std::string start_text(const std::vector<double>& values) {
  double largest = 0;
  for (const double x : values) largest = std::max(largest, std::abs(x));
  std::vector<double> out;
  for (const double x : values) out.push_back(round_to_known(x, 1e-14 * largest));
  return join(out);
}

std::string modes_text(const std::vector<ModePart>& parts) {
  std::string out;
  for (const ModePart& part : parts)
    out += fmt::format("{}{} {:.2f}", out.empty() ? "" : ", ", part.name, part.size);
  return out;
}

namespace {

std::string text_of(Bifurcation kind) {
  switch (kind) {
    case Bifurcation::pitchfork: return "another branch crosses this one (pitchfork)";
    case Bifurcation::transcritical: return "another branch crosses this one (transcritical)";
    case Bifurcation::fold: return "the branch turns back (fold)";
    case Bifurcation::family: return "at this value the steady motions form a family";
    case Bifurcation::hopf: return "it crosses the imaginary axis (Hopf)";
    case Bifurcation::hamiltonian_hopf:
      return "two pairs meet on the imaginary axis (Hamiltonian Hopf)";
    case Bifurcation::none: return "no other branch was found there";
    case Bifurcation::undecided: return "the kind is not decided: its errors cover it";
    case Bifurcation::unknown: break;
  }
  return "the branch was lost";
}

std::string text_of_end(Bifurcation kind) {
  switch (kind) {
    case Bifurcation::pitchfork: return "it joins another one as one of its halves (pitchfork)";
    case Bifurcation::fold: return "it turns back (fold) and continues";
    case Bifurcation::undecided: return "it turns back or joins another one (not decided)";
    default: return "it was lost";
  }
}

std::string kind_text(const SteadyCrossing& crossing) {
  const std::string out = text_of(crossing.kind);
  if (!crossing.supercritical) return out;
  return out + (*crossing.supercritical ? ", supercritical" : ", subcritical");
}

// The unit of what is varied; "" where it has none.
std::string unit_of(const std::string& name, const SystemModel& system) {
  std::string out;
  Config::fields([&](const Option& option, auto) {
    if (option.name == name) out = option.unit;
  });
  for (const Field& field : system.fields)
    if (field.name == name) out = field.unit;
  return out;
}

// The parts that move most in a mode, two names at most.
std::string name_of_mode(const SteadyMotion& motion, int place) {
  const std::vector<ModePart>& parts = motion.modes[static_cast<size_t>(place)];
  std::string out;
  for (size_t i = 0; i < std::min<size_t>(2, parts.size()); ++i)
    if (parts[i].size > 0.3) out += (out.empty() ? "" : ", ") + parts[i].name;
  return out;
}

// Every curve by the values where it is, with a gap where the branch is not; a long one thinned.
void add_curves(const SteadySweep& sweep, const std::string& branch, std::vector<Series>& real,
                std::vector<Series>& imaginary) {
  int number = 0;
  for (const std::vector<int>& curve : eigenvalue_curves(sweep.motions)) {
    std::vector<double> x, re, im;
    std::string mode;
    for (size_t i = 0; i < curve.size(); ++i) {
      x.push_back(sweep.values[i]);
      const double nothing = std::numeric_limits<double>::quiet_NaN();
      const bool here = curve[i] >= 0;
      const auto place = static_cast<size_t>(std::max(0, curve[i]));
      const SteadyMotion& motion = sweep.motions[i];
      if (here && mode.empty()) mode = name_of_mode(motion, curve[i]);
      const double known = here ? motion.round_off[place] : 0;
      re.push_back(here ? round_to_known(motion.eigenvalues[place].real(), known) : nothing);
      im.push_back(here ? round_to_known(motion.eigenvalues[place].imag(), known) : nothing);
    }
    const std::string name = fmt::format("{}{}: {}", branch, ++number, mode);
    Series one = thinned(name, x, re, false), other = thinned(name, x, im, false);
    one.dashed = other.dashed = !branch.empty();
    real.push_back(std::move(one));
    imaginary.push_back(std::move(other));
  }
}

// Intervals of the values without a growing mode, their ends where stability changes.
std::vector<Band> stable_bands(const SteadySweep& sweep) {
  std::vector<Band> out;
  const auto crossing = [&](double a, double b) {
    for (const SteadyCrossing& c : sweep.crossings)
      if (c.value >= std::min(a, b) && c.value <= std::max(a, b)) return c.value;
    return 0.5 * (a + b);
  };
  bool open = false;
  for (size_t i = 0; i < sweep.values.size(); ++i) {
    const SteadyMotion& motion = sweep.motions[i];
    const bool stable = motion.decided_growing() == 0;
    const bool before = i > 0 && sweep.motions[i - 1].found;
    if (stable && !open) {
      out.push_back(
          {.from = before ? crossing(sweep.values[i - 1], sweep.values[i]) : sweep.values[i],
           .to = sweep.values[i],
           .text = "no growing mode"});
    } else if (stable) {
      out.back().to = sweep.values[i];
    } else if (open && motion.found) {
      out.back().to = crossing(sweep.values[i - 1], sweep.values[i]);
    }
    open = stable;
  }
  return out;
}

void add_crossings(Page& page, const std::string& name, const std::string& unit,
                   const SteadySweep& sweep) {
  std::vector<std::vector<Cell>> rows;
  const auto add = [&](const std::string& branch, const SteadySweep& one) {
    for (const SteadyCrossing& c : one.crossings) {
      rows.push_back({branch, known_text(c.value, c.round_off),
                      c.pair ? "a pair of complex eigenvalues" : "a real eigenvalue",
                      kind_text(c)});
    }
    for (const SteadyEnd& end : one.ends)
      rows.push_back({branch, known_text(end.value, end.round_off),
                      end.towards_last ? "the branch ends" : "the branch begins",
                      text_of_end(end.kind)});
  };
  add("1", sweep);
  for (size_t i = 0; i < sweep.branches.size(); ++i) add(std::to_string(i + 2), sweep.branches[i]);
  if (rows.empty()) page.text({fmt::format("Stability does not change along {}.", name)});
  else
    page.table("Where stability changes", {"branch", with_unit(name, unit), "what", "kind"}, rows);
}

}  // namespace

std::string crossing_text(const SteadyCrossing& crossing) {
  return fmt::format("{}, {}: {}", known_text(crossing.value, crossing.round_off),
                     crossing.pair ? "a pair of complex eigenvalues" : "a real eigenvalue",
                     kind_text(crossing));
}

std::string end_text(const std::string& name, const SteadySweep& sweep, bool towards_last) {
  for (const SteadyEnd& end : sweep.ends)
    if (end.towards_last == towards_last)
      return fmt::format("the branch {} at {} = {}: {}", towards_last ? "ends" : "begins", name,
                         known_text(end.value, end.round_off), text_of_end(end.kind));
  const double value = towards_last ? sweep.values.back() : sweep.values.front();
  return fmt::format("the branch leaves the range at {} = {:.6g}", name, value);
}

void print_ends(const std::string& name, const SteadySweep& sweep) {
  const bool any = std::any_of(sweep.motions.begin(), sweep.motions.end(),
                               [](const SteadyMotion& motion) { return motion.found; });
  if (!any && !sweep.start) return;
  for (const bool towards_last : {false, true}) {
    say("  {}\n", end_text(name, sweep, towards_last));
    for (const SteadyEnd& end : sweep.ends)
      if (end.towards_last == towards_last && end.other) print_other(name, *end.other);
  }
}

void print_other(const std::string& name, const SteadyPlace& place) {
  say("    the other branch, at {} = {:.12g} (--branches follows it):\n", name, place.value);
  say("      --configuration {} --velocity {}\n", start_text(place.element),
      start_text(place.velocity));
}

Page steady_page(const std::string& name, const SystemModel& system, const SteadySweep& sweep,
                 const std::string& command) {
  Page page(fmt::format("{}: steady motions", system.name), "eigenvalues along " + name);
  const std::string unit = unit_of(name, system), x = with_unit(name, unit);
  page.section("Stability");
  add_crossings(page, name, unit, sweep);
  std::vector<Series> real, imaginary;
  add_curves(sweep, sweep.branches.empty() ? "" : "branch 1, ", real, imaginary);
  for (size_t i = 0; i < sweep.branches.size(); ++i)
    add_curves(sweep.branches[i], fmt::format("branch {}, ", i + 2), real, imaginary);
  const std::vector<Band> bands = stable_bands(sweep);
  page.plot("Real parts of the eigenvalues", {.x = x, .y = "real part [1/s]", .bands = bands},
            real);
  page.plot("Imaginary parts of the eigenvalues",
            {.x = x, .y = "imaginary part [rad/s]", .bands = bands}, imaginary);
  page.section("What was computed");
  page.text({"`" + command + "`"});
  std::vector<std::vector<Cell>> rows;
  for (const Field& field : system.fields)
    rows.push_back({field.name, field.name == name ? "varied" : join(field.value), field.unit});
  if (!rows.empty()) page.table("Parameters", {"name", "value", "unit"}, rows);
  return page;
}

}  // namespace hamel::tools
