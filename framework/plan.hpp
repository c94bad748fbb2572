// What Simulation checks and gathers before the first step. Not installed: simulate.cpp's own.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/simulate.hpp>

namespace hamel {

// Everything that a run needs, or everything that is wrong.
struct Simulation::Plan {
  std::vector<std::string> mistakes, notes;
  Config config;
  SystemModel system;
  KernelSetup setup;
  KernelFactory kernel;

  void add(const std::vector<std::string>& more) {
    mistakes.insert(mistakes.end(), more.begin(), more.end());
  }
};

/// The columns of a trajectory of this system, as in contract.md.
std::vector<std::string> columns_of(const SystemModel& system);

}  // namespace hamel
