#include "readings.hpp"

#include <cmath>
#include <future>

#include <fmt/format.h>

#include <hamel/systems/simulate.hpp>

#include "run_page.hpp"

namespace hamel::tools {

const std::vector<Reading>& readings() {
  static const std::vector<Reading> all = {
      {"boxed_literal", "boxed_literal", 0}, {"boxed", "boxed", 0},   {"balance s=0", "balance", 0},
      {"balance s=1/2", "balance", 0.5},     {"lift s=0", "lift", 0}, {"lift s=1/2", "lift", 0.5},
      {"unadapted", "unadapted", 0.5},
  };
  return all;
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

namespace {

Simulation simulation_of(const Case& problem, const Reading& reading,
                         const std::string& retraction) {
  Simulation out = simulate(problem.system);
  for (const auto& [name, value] : problem.parameters) out.set(name, value);
  return out.start(problem.start)
      .scheme(reading.scheme)
      .s(reading.s)
      .retraction(retraction)
      .step(problem.step)
      .until(problem.until);
}

}  // namespace

Outcome run_reading(const Case& problem, const Reading& reading, const std::string& retraction) {
  const Result result = simulation_of(problem, reading, retraction).run();
  Outcome out;
  out.name = reading.name;
  out.status = result.status;
  out.energy_error = result.energy_error_max;
  out.constraint = result.constraint_max;
  out.group_defect = result.group_defect_max;
  out.configuration_error = result.exact_error_max;
  out.final_configuration_error = result.exact_error_final;
  out.velocity_error = result.exact_velocity_error_max;
  out.nanoseconds = result.seconds * 1e9 / static_cast<double>(std::max(result.steps, 1L));
  out.final_velocity = result.last.velocity;
  for (const Figure& figure : figures()) {
    out.curves.push_back(curve(result, reading.name, figure.column, figure.magnitude));
  }
  return out;
}

std::vector<Outcome> run_all(const Case& problem, const std::vector<Reading>& which,
                             const std::string& retraction) {
  std::vector<Outcome> out(which.size());
  const auto part = [&](size_t first) {
    for (size_t i = first; i < which.size(); i += 2) {
      out[i] = run_reading(problem, which[i], retraction);
    }
  };
  registry();  // filled before the threads share it
  auto other = std::async(std::launch::async, part, size_t{1});
  part(0);
  other.get();
  return out;
}

std::vector<Series> exact_momentum(const Case& problem) {
  const Result start = simulation_of(problem, readings().back(), "exp").until(problem.step).run();
  Eigen::MatrixXd inertia(start.system.group.dim, start.system.group.dim);
  start.system.mechanics->inertia(nullptr, inertia);
  const ExactFlow flow = start.system.exact(start.config.start);
  std::vector<Series> out(2, Series{"exact", {}, {}, true});
  constexpr int points = 400;
  for (int i = 0; i <= points; ++i) {
    const double t = problem.until * i / points;
    const auto [g, xi] = flow(t);
    const Eigen::VectorXd mu =
        inertia *
        Eigen::Map<const Eigen::VectorXd>(xi.data(), static_cast<Eigen::Index>(xi.size()));
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
    page.plot(figure.title,
              {.x = "time t [s]", .y = figure.label, .log_x = false, .log_y = figure.magnitude},
              series, figure.note);
  }
}

void add_table(Page& page, const std::string& title, const std::vector<Outcome>& outcomes) {
  std::vector<std::vector<Cell>> rows;
  for (const Outcome& o : outcomes) {
    rows.push_back({o.name, o.status.ok ? "ok" : "failed", o.energy_error, o.configuration_error,
                    o.velocity_error, o.constraint, o.group_defect, o.nanoseconds});
  }
  page.table(title,
             {"reading", "status", "energy error", "configuration error", "velocity error",
              "constraint residual", "group defect", "ns per step"},
             rows,
             "Largest values over the run, every step measured; time includes the measuring.");
}

}  // namespace hamel::tools
