// Runs of mechanisms that slip, and their events.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel::test {

constexpr double kGravity = 9.81;

inline double last(const Result& r, const std::string& name) {
  return r.trajectory.column(name).back();
}
inline std::vector<std::string> names(const Result& r) {
  std::vector<std::string> out;
  for (const EventMet& e : r.events) out.push_back(e.name);
  return out;
}
inline double time_of(const Result& r, const std::string& name) {
  for (const EventMet& e : r.events)
    if (e.name == name) return e.time;
  ADD_FAILURE() << "no event " << name;
  return std::nan("");
}
inline Simulation slipping(const Mechanism& m) {
  return simulate(m).tolerance({.relative = 1e-10}).slip();
}

}  // namespace hamel::test
