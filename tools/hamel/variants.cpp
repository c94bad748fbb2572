#include "variants.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

#include <hamel/framework/mechanics/system.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/systems/by_name.hpp>

#include "paper_studies.hpp"
#include "run_page.hpp"

namespace hamel::tools {

StudyConfig paper_study(const std::string& stem) {
  for (const auto& [name, text] : paper_studies)
    if (name == stem) return parse_study(text, stem, registry());
  throw std::logic_error("no study " + stem);
}

const std::vector<Figure>& figures() {
  static const std::vector<Figure> all = {
      {"energy_error", "Energy error", "|E - E0| / E0", true, ""},
      {"exact_error", "Trajectory error: configuration", "|g - g exact|", true,
       "Euclidean distance of the element's columns from the exact motion."},
      {"exact_velocity_error", "Trajectory error: body velocity", "|xi - xi exact|", true, ""},
      {"constraint", "Constraint residual", "|A xi/h|", true,
       "xi is recovered from consecutive configurations, not taken from the solver."},
      {"group_defect", "Group defect", "defect", true, ""},
      {"mu1", "Body momentum, first component", "mu1", false, ""},
      {"mu2", "Body momentum, second component", "mu2", false, ""},
  };
  return all;
}

double Figure::floor(double step) const {
  constexpr double kRoundOff = 2.2e-16;
  return !magnitude ? 0 : column == "constraint" ? kRoundOff / std::abs(step) : kRoundOff;
}

namespace {

Outcome run_variant(const StudyCell& cell) {
  const Config config = cell.config();
  const Result result = simulate(config.system).config(config).run();
  Outcome out;
  const bool adapted = registry().scheme(config.scheme)->adapted;
  const std::string s = adapted ? cell.axes.at("s") : "";
  out.name = config.scheme + (s.empty() ? "" : s == "0.5" ? " s=1/2" : " s=" + s);
  out.cell = cell;
  out.status = result.status;
  out.measured = result;
  out.nanoseconds = result.seconds * 1e9 / static_cast<double>(std::max(result.steps, 1L));
  out.windows = windows_note(result, {});
  for (const Figure& figure : figures())
    out.curves.push_back(curve(result, out.name, figure.column, figure.magnitude));
  return out;
}

}  // namespace

std::vector<Outcome> run_all(const StudyConfig& study) {
  const StudyCells all = study_cells(study, registry());
  std::vector<StudyCell> cells;
  std::copy_if(all.begin(), all.end(), std::back_inserter(cells),
               [](const StudyCell& cell) { return cell.runs(); });
  std::vector<Outcome> out(cells.size());
  const auto part = [&](size_t first) {
    for (size_t i = first; i < cells.size(); i += 2) out[i] = run_variant(cells[i]);
  };
  auto other = std::async(std::launch::async, part, size_t{1});
  part(0);
  other.get();
  return out;
}

std::vector<Outcome> with(const std::vector<Outcome>& all, const std::string& axis,
                          const std::string& value) {
  std::vector<Outcome> out;
  std::copy_if(all.begin(), all.end(), std::back_inserter(out),
               [&](const Outcome& outcome) { return outcome.cell.axes.at(axis) == value; });
  return out;
}

std::vector<Series> exact_momentum(const Config& run) {
  const Run start = simulate(run.system).config(run).build();
  Eigen::MatrixXd inertia(start.system().group.dim, start.system().group.dim);
  start.system().mechanics->inertia(nullptr, inertia);
  const ExactFlow flow = start.system().exact(start.config().start);
  std::vector<Series> out(2, Series{"exact", {}, {}, true});
  constexpr int points = 400;
  for (int i = 0; i <= points; ++i) {
    const double t = run.until * i / points;
    const auto [g, xi] = flow(t);
    const Eigen::VectorXd mu = inertia * Eigen::Map<const Eigen::VectorXd>(
                                             xi.data(), static_cast<Eigen::Index>(xi.size()));
    for (size_t j = 0; j < 2; ++j) {
      out[j].x.push_back(t);
      out[j].y.push_back(mu[static_cast<Eigen::Index>(j)]);
    }
  }
  return out;
}

void add_figures(Page& page, const std::vector<Outcome>& outcomes,
                 const std::vector<Series>& exact) {
  for (size_t j = 0; j < figures().size(); ++j) {
    const Figure& figure = figures()[j];
    std::vector<Series> series;
    for (const Outcome& outcome : outcomes) {  // unadapted first, under the others: it fills a band
      series.insert(outcome.name == "unadapted" ? series.begin() : series.end(), outcome.curves[j]);
    }
    if (figure.column == "mu1" && !exact.empty()) series.push_back(exact[0]);
    if (figure.column == "mu2" && !exact.empty()) series.push_back(exact[1]);
    Axes axes{.x = "time t [s]", .y = figure.label, .log_x = false, .log_y = figure.magnitude};
    axes.floor = figure.floor(outcomes.front().cell.config().step_or_usual());
    const std::string& windows = outcomes.front().windows;
    page.plot(
        figure.title, axes, series,
        !figure.magnitude ? figure.note : figure.note + (figure.note.empty() ? "" : " ") + windows);
  }
}

void add_table(Page& page, const std::string& title, const std::vector<Outcome>& outcomes) {
  std::vector<std::vector<Cell>> rows;
  for (const Outcome& o : outcomes) {
    const Measurements& m = o.measured;
    rows.push_back({o.name, o.status.ok ? "ok" : "failed", m.energy_error_max, m.exact_error_max,
                    m.exact_velocity_error_max, m.constraint_max, m.group_defect_max,
                    o.nanoseconds});
  }
  page.table(title,
             {"variant", "status", "energy error", "configuration error", "velocity error",
              "constraint residual", "group defect", "ns per step"},
             rows,
             "Largest values over the run, every step measured; time includes the measuring.");
}

}  // namespace hamel::tools
