// A run that is driven while it is watched: opened, its inputs set, stepped to a time.
#include <optional>
#include <string>
#include <vector>

#include <emscripten.h>
#include <Eigen/Geometry>

#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/run/run.hpp>
#include <hamel/systems/by_name.hpp>

#include "description.hpp"
#include "request.hpp"

namespace hamel::playground {
namespace {

std::optional<Run> live;
std::vector<double> poses;  // the time, and x y z qw qx qy qz of each body

Json advance(const Json& request) {
  Run& run = live.value();
  for (const auto& [name, value] : request.at("inputs").items())
    run.input(name, value.get<double>());
  const Status status = run.advance_to(request.at("time").get<double>());
  const Snapshot& state = run.state({.energy = false, .measures = false});
  const SystemModel& system = run.system();
  poses = {state.time};
  for (const DrawnBody& body : system.drawing.bodies) {
    const Placement at = body.place(state.coordinates);
    const Eigen::Quaterniond q(at.rotation);
    poses.insert(poses.end(), {at.position[0], at.position[1], at.position[2]});
    poses.insert(poses.end(), {q.w(), q.x(), q.y(), q.z()});
  }
  Json named;
  for (size_t i = 0; i < state.coordinates.size(); ++i)
    named[system.group.columns.at(i)] = state.coordinates[i];
  for (size_t i = 0; i < state.velocity.size(); ++i) named[system.rates.at(i)] = state.velocity[i];
  return {{"ok", true},
          {"time", state.time},
          {"failure", status.ok ? "" : status.reason},
          {"state", named},
          {"poses", poses.size()}};
}

}  // namespace
}  // namespace hamel::playground

extern "C" {

/// Opens a run; every input of its system has a value, 0 where none is given.
EMSCRIPTEN_KEEPALIVE const char* hamel_open(const char* request) {
  using namespace hamel::playground;
  return answer(request, [](const Json& of) {
    live.reset();
    hamel::Simulation simulation = simulation_of(of);
    for (const hamel::InputField& input : simulation.system()->inputs)
      if (!simulation.config().inputs.contains(input.name)) simulation.input(input.name, 0);
    live.emplace(simulation.build());
    return Json{{"ok", true}, {"bodies", live->system().drawing.bodies.size()}};
  });
}

/// Sets inputs, {"inputs": {name: value}}, and steps to "time": {time, failure, state, poses};
/// failure is empty where the run goes on, state {name: value}, poses the size of hamel_poses().
EMSCRIPTEN_KEEPALIVE const char* hamel_advance(const char* request) {
  using namespace hamel::playground;
  return answer(request, advance);
}

/// The poses there.
EMSCRIPTEN_KEEPALIVE const double* hamel_poses() { return hamel::playground::poses.data(); }
}
