#include "pages/variants.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <future>
#include <iterator>
#include <stdexcept>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include <hamel/framework/figures/run_figures.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/systems/by_name.hpp>

#include "paper_studies.hpp"

namespace hamel::tools {

StudyConfig paper_study(const std::string& stem) {
  for (const auto& [name, text] : paper_studies)
    if (name == stem) return parse_study(text, stem, registry());
  throw std::logic_error("no study " + stem);
}

namespace {

// Columns in the figures of a run: its errors, and two components of the momentum.
const std::vector<std::string> kErrors = {"energy_error", "exact_error", "exact_velocity_error",
                                          "constraint", "group_defect"};
const std::vector<std::string> kMomenta = {"mu1", "mu2"};

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
  out.windows = figures::windows_note(result, {});
  for (const std::string& column : kErrors)
    out.errors.push_back(figures::magnitude(result, out.name, column));
  for (const std::string& column : kMomenta)
    out.momenta.push_back(figures::curve(result, out.name, column));
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
  // No std::async: where no thread can be made, libc++ waits in it for ever.
  std::packaged_task<void()> other([&] { part(1); });
  std::future<void> done = other.get_future();
  std::jthread helper;  // joins also where part(0) throws
  try {
    helper = std::jthread(std::ref(other));
  } catch (const std::system_error&) {
    other();
  }
  part(0);
  done.get();
  return out;
}

std::vector<Outcome> with(const std::vector<Outcome>& all, const std::string& axis,
                          const std::string& value) {
  std::vector<Outcome> out;
  std::copy_if(all.begin(), all.end(), std::back_inserter(out),
               [&](const Outcome& outcome) { return outcome.cell.axes.at(axis) == value; });
  return out;
}

std::vector<figures::Curve> exact_momentum(const Config& run) {
  const Run start = simulate(run.system).config(run).build();
  Eigen::MatrixXd inertia(start.system().group.dim, start.system().group.dim);
  start.system().mechanics->inertia(nullptr, inertia);
  const ExactFlow flow = start.system().exact(start.config().start);
  std::vector<figures::Curve> out(2, {.name = "exact", .dashed = true});
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
                 const std::vector<figures::Curve>& exact) {
  const auto curves = [&](auto member, size_t j) {
    std::vector<figures::Curve> out;
    for (const Outcome& outcome : outcomes)  // unadapted first, under the others: it fills a band
      out.insert(outcome.name == "unadapted" ? out.begin() : out.end(), (outcome.*member)[j]);
    return out;
  };
  constexpr double kRoundOff = 2.2e-16;  // coordinates of size 1
  const Outcome& first = outcomes.front();
  const double step = std::abs(first.cell.config().step_or_usual());
  for (size_t j = 0; j < kErrors.size(); ++j) {
    const figures::ErrorFigure error = figures::error_figure(kErrors[j]);
    const std::string note = error.note;
    Figure figure = figures::over_time(error.title, {.label = error.label, .log = true},
                                       curves(&Outcome::errors, j), error.name,
                                       note + (note.empty() ? "" : " ") + first.windows);
    std::get<figures::Plot>(figure.drawing).floor =
        kErrors[j] == "constraint" ? kRoundOff / step : kRoundOff;
    page.add(figure);
  }
  for (size_t j = 0; j < kMomenta.size(); ++j) {
    std::vector<figures::Curve> all = curves(&Outcome::momenta, j);
    if (!exact.empty()) all.push_back(exact[j]);
    page.add(
        figures::over_time(fmt::format("Body momentum, {} component", j == 0 ? "first" : "second"),
                           {.label = kMomenta[j]}, std::move(all), kMomenta[j]));
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
