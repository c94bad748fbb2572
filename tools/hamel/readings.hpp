// The readings of the paper's method, and what one run of each leaves for figures and tables.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <hamel/framework/run/simulation.hpp>

#include "page.hpp"

namespace hamel::tools {

/// One way to read the paper: a scheme and its s.
struct Reading {
  std::string name, scheme;
  double s;
};
/// boxed_literal, boxed, balance and lift at s = 0 and 1/2, unadapted.
const std::vector<Reading>& readings();

/// A system with its start, step and time span.
struct Case {
  std::string title, system;
  Parameters parameters;
  Start start;
  double step, until;
};

/// What one run of one reading leaves: its largest errors and its thinned curves.
struct Outcome {
  std::string name;
  Status status;
  double energy_error = 0, constraint = 0, group_defect = 0;
  double configuration_error = 0, velocity_error = 0, nanoseconds = 0;
  double final_configuration_error = 0;
  std::vector<Series> curves;  // in the order of figure_columns()
  std::vector<double> final_velocity;
};

/// A column of the trajectory and how a figure shows it.
struct Figure {
  std::string column, title, label;
  bool magnitude;
  std::string note;
};
const std::vector<Figure>& figures();

/// Runs one reading of a case.
Outcome run_reading(const Case& problem, const Reading& reading, const std::string& retraction);

/// Runs them all, on both cores; the order of the answers is that of the readings.
std::vector<Outcome> run_all(const Case& problem, const std::vector<Reading>& which,
                             const std::string& retraction);

/// The exact body momentum components over the span, as a dashed curve for the momentum figures.
std::vector<Series> exact_momentum(const Case& problem);

/// The figures of these runs, then their table.
void add_figures(Page& page, const std::vector<Outcome>& outcomes,
                 const std::vector<Series>& exact);
void add_table(Page& page, const std::string& title, const std::vector<Outcome>& outcomes);

}  // namespace hamel::tools
