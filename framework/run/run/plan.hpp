// The plan of a run, checked before the first step. Part of simulation.cpp, not installed.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/run/run/events.hpp>
#include <hamel/framework/run/run/simulation.hpp>

namespace hamel {

/// The options of a run that a scheme makes no use of: s; solver, tolerance and, but for "halve", on_failure of explicit
/// ones, which solve no equation. Half an explicit step may succeed where the whole left the domain of tau.
std::vector<std::string> unused_options(const SchemeInfo& scheme, const Config& config);

/// What the disks of these files have room for; infinite for a pipe, and for files that are compressed or hold no rows.
double numbers_that_fit(const std::vector<std::string>& files);

// Everything that a run needs, or all its mistakes.
struct Simulation::Plan {
  std::vector<std::string> mistakes, notes, unused;
  Config config;
  SystemModel system;
  Eigen::MatrixXd inertia, constraints;  // at the start
  Eigen::VectorXd drift;
  std::shared_ptr<const Geometry> geometry;  // null for a group that is not registered
  std::shared_ptr<const Mechanics> mechanics;
  bool keeps_rows = true;  // the scheme does
  bool place_refused = false;
  std::shared_ptr<Events> events;
  KernelSetup setup;
  KernelFactory kernel;
  // What a file keeps, so that the same run can be gone on with.
  std::string request, files;

  void add(const std::vector<std::string>& more) {
    mistakes.insert(mistakes.end(), more.begin(), more.end());
  }
  void drive();
  void fill_start();
  void check_composition(const SchemeInfo& scheme, bool left_invariant);
  void choose_steps(const SchemeInfo& scheme, bool left_invariant);
  void look_at_start();
  void look_beside_start(const Eigen::VectorXd& g);
  void satisfy(Eigen::VectorXd phi, Eigen::VectorXd& g);
  void project();
  void watch();
  std::vector<double> admissible(const EventState& state, const std::string& event) const;
};

}  // namespace hamel
