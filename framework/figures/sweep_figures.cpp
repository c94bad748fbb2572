// Figures of steady motions along a parameter, and of the points of a section.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include <hamel/framework/analysis/section.hpp>
#include <hamel/framework/analysis/steady.hpp>
#include <hamel/framework/figures/curves.hpp>
#include <hamel/framework/figures/figures.hpp>
#include <hamel/framework/io/errors.hpp>

namespace hamel::figures {
namespace {

// The parts that move most in a mode, two names at most.
std::string name_of_mode(const SteadyMotion& motion, int place) {
  const std::vector<ModePart>& parts = motion.modes[static_cast<size_t>(place)];
  std::string out;
  for (size_t i = 0; i < std::min<size_t>(2, parts.size()); ++i)
    if (parts[i].size > 0.3) out += (out.empty() ? "" : ", ") + parts[i].name;
  return out;
}

// Every curve by the values where it is, with a gap where the branch is not; a long one thinned.
void add_curves(const SteadySweep& sweep, const std::string& branch, std::vector<Curve>& real,
                std::vector<Curve>& imaginary) {
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
    Curve one = thinned(name, x, re, false), other = thinned(name, x, im, false);
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

const std::vector<double>& numbers(const TableColumn& column) {
  return std::get<std::vector<double>>(column.values);
}

// The columns for the axes: those given, else the first two that vary most beside t.
std::vector<const TableColumn*> axes_of(const Table& points, const std::string& given) {
  std::vector<const TableColumn*> out;
  if (!given.empty()) {
    const size_t comma = given.find(',');
    if (comma == std::string::npos)
      throw ConfigError({fmt::format("--axes: got '{}', expected two columns, A,B", given)});
    return {&points.column(given.substr(0, comma)), &points.column(given.substr(comma + 1))};
  }
  for (size_t j = 3; j + 1 < points.columns.size(); ++j) {
    const std::vector<double>& values = numbers(points.columns[j]);
    if (values.empty()) continue;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const double size = std::max({1.0, std::abs(*least), std::abs(*most)});
    if (*most - *least > 1e-6 * size) out.push_back(&points.columns[j]);
    if (out.size() == 2) return out;
  }
  return {};
}

}  // namespace

std::vector<Figure> of_sweep(const SteadySweep& sweep) {
  std::vector<Curve> real, imaginary;
  add_curves(sweep, sweep.branches.empty() ? "" : "branch 1, ", real, imaginary);
  for (size_t i = 0; i < sweep.branches.size(); ++i)
    add_curves(sweep.branches[i], fmt::format("branch {}, ", i + 2), real, imaginary);
  const auto figure = [&](const char* title, const char* name, Axis y, std::vector<Curve> curves) {
    return Figure{.title = title,
                  .drawing = Plot{.x = {sweep.parameter, sweep.unit},
                                  .y = std::move(y),
                                  .curves = std::move(curves),
                                  .bands = stable_bands(sweep)},
                  .name = name,
                  .section = "Stability"};
  };
  return {figure("Real parts of the eigenvalues", "growth", {"real part", "1/s"}, std::move(real)),
          figure("Imaginary parts of the eigenvalues", "frequency", {"imaginary part", "rad/s"},
                 std::move(imaginary))};
}

std::vector<Figure> of_section(const Section& section, const std::string& given) {
  const std::vector<const TableColumn*> axes = axes_of(section.points, given);
  if (axes.size() != 2) return {};
  const auto& starts = std::get<std::vector<long long>>(section.points.columns[0].values);
  std::vector<Curve> curves;
  for (size_t i = 0; i < starts.size(); ++i) {
    const auto start = static_cast<size_t>(starts[i]);
    while (curves.size() < start)
      curves.push_back({.name = fmt::format("start {}", curves.size() + 1), .dots = true});
    curves[start - 1].x.push_back(numbers(*axes[0])[i]);
    curves[start - 1].y.push_back(numbers(*axes[1])[i]);
  }
  std::erase_if(curves, [](const Curve& one) { return one.x.empty(); });
  return {{.title = "Section",
           .drawing = Plot{.x = {axes[0]->name, axes[0]->unit},
                           .y = {axes[1]->name, axes[1]->unit},
                           .curves = std::move(curves)},
           .note = "One colour for each start. Points on a closed curve belong to a quasi-periodic "
                   "motion, points that fill an area to a chaotic one.",
           .name = "section",
           .section = "Points"}};
}

}  // namespace hamel::figures
