// The variants of the paper's method, and what one run of each leaves for figures and tables.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/pages/page.hpp>
#include <hamel/framework/run/record/measures.hpp>
#include <hamel/framework/study/study.hpp>

namespace hamel::tools {

using pages::Cell;
using pages::Figure;
using pages::Page;

/// A study of tools/studies/paper by its stem, as the program carries it; its cells are the
/// variants of the paper's method.
StudyConfig paper_study(const std::string& stem);

/// Results of one run of one variant: its largest errors and its thinned curves.
struct Outcome {
  std::string name;  // "boxed", "lift s=1/2"
  StudyCell cell;
  Status status;
  Measurements measured;
  double nanoseconds = 0;
  std::vector<figures::Curve> errors, momenta;
  std::string windows;  // what the points of errors are the largest of
};

/// Runs all cells of a study, on both cores; the outcomes are in their order.
std::vector<Outcome> run_all(const StudyConfig& study);

/// The outcomes with this value on this axis.
std::vector<Outcome> with(const std::vector<Outcome>& all, const std::string& axis,
                          const std::string& value);

/// The exact body momentum components over the span of a run, as dashed curves for the momentum
/// figures.
std::vector<figures::Curve> exact_momentum(const Config& run);

/// The figures of these runs, then their table.
void add_figures(Page& page, const std::vector<Outcome>& outcomes,
                 const std::vector<figures::Curve>& exact);
void add_table(Page& page, const std::string& title, const std::vector<Outcome>& outcomes);

}  // namespace hamel::tools
