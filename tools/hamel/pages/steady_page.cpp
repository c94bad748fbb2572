#include "pages/steady_page.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/figures/curves.hpp>
#include <hamel/framework/figures/figures.hpp>
#include <hamel/framework/io/errors.hpp>

#include "words/screen.hpp"

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

std::string words_of(Bifurcation kind) {
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
  const std::string out = words_of(crossing.kind);
  if (!crossing.supercritical) return out;
  return out + (*crossing.supercritical ? ", supercritical" : ", subcritical");
}

void add_crossings(Page& page, const SteadySweep& sweep) {
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
  if (rows.empty())
    page.text({fmt::format("Stability does not change along {}.", sweep.parameter)});
  else
    page.table("Where stability changes",
               {"branch", figures::with_unit(sweep.parameter, sweep.unit), "what", "kind"}, rows);
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

Page steady_page(const SystemModel& system, const SteadySweep& sweep, const std::string& command) {
  const std::string& name = sweep.parameter;
  Page page(fmt::format("{}: steady motions", system.name), "eigenvalues along " + name);
  page.section("Stability");
  add_crossings(page, sweep);
  page.add(figures::of_sweep(sweep), "Stability");
  page.section("What was computed");
  page.text({"`" + command + "`"});
  std::vector<std::vector<Cell>> rows;
  for (const Field& field : system.fields)
    rows.push_back({field.name, field.name == name ? "varied" : join(field.value), field.unit});
  if (!rows.empty()) page.table("Parameters", {"name", "value", "unit"}, rows);
  return page;
}

}  // namespace hamel::tools
