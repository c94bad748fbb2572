// A run to be stepped by hand, hamel.Run, and what it shows: State, Status, SolverStats.
#include <algorithm>
#include <atomic>
#include <stdexcept>

#include "bindings.hpp"

namespace hamel::python {
namespace {

// A Run with its names. One thread at a time: a step leaves the interpreter to others.
struct ByHand {
  Run run;
  std::shared_ptr<const StateNames> names;
  std::string source;
  Functions functions;
  bool finished = false;
  const Snapshot* current = nullptr;  // null behind a change
  std::atomic<bool> busy = false;

  ByHand(Run built, const Builder& builder)
      : run(std::move(built)),
        names(std::make_shared<const StateNames>(run.system())),
        source(builder.source),
        functions(builder.functions) {}
  // A state is measured once, however many of its numbers are asked for.
  const Snapshot& state() {
    if (current == nullptr) current = &run.state();
    return *current;
  }
  const Snapshot& part(const StateParts& parts) {
    return current != nullptr ? *current : run.state(parts);
  }
};

class Alone {
 public:
  explicit Alone(ByHand& of) : of_(of) {
    if (of_.finished) throw ConfigError({"this run is finished: build another"});
    if (of_.busy.exchange(true))
      throw std::runtime_error("this run is in use, by another thread or a function that it calls");
  }
  ~Alone() { of_.busy = false; }
  Alone(const Alone&) = delete;
  Alone& operator=(const Alone&) = delete;

 private:
  ByHand& of_;
};

// A change of the run, with the interpreter free.
template <class Function>
auto freely(ByHand& self, Function function) {
  const Alone alone(self);
  self.current = nullptr;
  const Away free;
  return function(self.run);
}

// Pieces, so that Ctrl-C ends a long call between two steps.
Status steps(ByHand& self, long count) {
  const Alone alone(self);
  self.current = nullptr;
  constexpr long kPiece = 4096;
  Status status;
  for (long left = count; left > 0 && status.ok; left -= kPiece) {
    const Away free;
    status = self.run.step(std::min(left, kPiece));
    if (left > kPiece) {
      const Entered python;
      if (PyErr_CheckSignals() != 0) nb::raise_python_error();
    }
  }
  return status;
}

using Doubles = std::vector<double>;

void bind_status(nb::module_& m) {
  nb::class_<Status>(m, "Status",
                     "What became of a step or a run: true where it is ok, else the step that "
                     "failed and why.")
      .def_ro("ok", &Status::ok)
      .def_ro("step", &Status::step, "the step that failed")
      .def_ro("time", &Status::time, "where it started [s]")
      .def_ro("residual", &Status::residual, "relative")
      .def_ro("reason", &Status::reason)
      .def("__bool__", [](const Status& s) { return s.ok; })
      .def("__repr__", [](const Status& s) {
        if (s.ok) return std::string("<hamel.Status: ok>");
        return "<hamel.Status: failed in step " + std::to_string(s.step) +
               " at t = " + text_of(s.time) + ": " + s.reason + ">";
      });
  nb::class_<SolverStats>(m, "SolverStats", "Running totals over the steps taken.")
      .def_ro("iterations", &SolverStats::iterations)
      .def_ro("evaluations", &SolverStats::evaluations)
      .def_ro("iterations_max", &SolverStats::iterations_max, "over one step")
      .def_ro("residual_max", &SolverStats::residual_max, "relative")
      .def_ro("rejected", &SolverStats::rejected, "steps taken again, smaller")
      .def_ro("fallbacks", &SolverStats::fallbacks, "steps that failed and were rescued");
}

void bind_state(nb::module_& m) {
  const auto vector = [](Doubles Snapshot::*member) {
    return [member](const NamedState& s) { return array(s.state.*member); };
  };
  const auto value = [](auto Snapshot::*member) {
    return [member](const NamedState& s) { return s.state.*member; };
  };
  nb::class_<NamedState>(m, "State", "A state with its measurements; numbers by name: state['v1'].")
      .def_prop_ro("step", value(&Snapshot::step))
      .def_prop_ro("time", value(&Snapshot::time), "[s]")
      .def_prop_ro("coordinates", vector(&Snapshot::coordinates),
                   nb::sig("def coordinates(self) -> numpy.typing.NDArray[numpy.float64]"),
                   "of the element g")
      .def_prop_ro("velocity", vector(&Snapshot::velocity),
                   nb::sig("def velocity(self) -> numpy.typing.NDArray[numpy.float64]"),
                   "nodal body velocity xi, shape (n,)")
      .def_prop_ro("momentum", vector(&Snapshot::momentum),
                   nb::sig("def momentum(self) -> numpy.typing.NDArray[numpy.float64]"),
                   "nodal body momentum, shape (n,)")
      .def_prop_ro("energy", value(&Snapshot::energy), "[J]")
      .def_prop_ro("constraint", value(&Snapshot::constraint), "|A v - b| of the last step")
      .def_prop_ro("holonomic", value(&Snapshot::holonomic), "max |phi(g)|")
      .def_prop_ro("group_defect", value(&Snapshot::group_defect))
      .def_prop_ro("rotation", value(&Snapshot::rotation), "of the last substep [rad]")
      .def_prop_ro("iterations", value(&Snapshot::iterations), "of the last step")
      .def_prop_ro("residual", value(&Snapshot::residual), "relative")
      .def(
          "__getitem__",
          [](const NamedState& s, const std::string& name) {
            if (s.names == nullptr)
              throw nb::key_error((name + ": this state has no names, only arrays").c_str());
            return s.names->value(s.state, name);
          },
          "name"_a)
      .def("__repr__", [](const NamedState& s) {
        return "<hamel.State at t = " + text_of(s.state.time) + ", velocity [" +
               join(s.state.velocity) + "]>";
      });
}

}  // namespace

StateNames::StateNames(const SystemModel& system) : model(describe_model(system)) {
  const size_t columns = model.coordinates.size();
  const auto add = [&](const std::string& name, size_t place) {
    const bool coordinate = place < columns;
    places.emplace(name, std::pair(coordinate ? Part::coordinate : Part::velocity,
                                   coordinate ? place : place - columns));
  };
  for (size_t i = 0; i < columns; ++i) add(model.coordinates[i], i);
  for (size_t i = 0; i < model.velocities.size(); ++i) {
    add(model.velocities[i], columns + i);
    places.emplace("mu" + std::to_string(i + 1), std::pair(Part::momentum, i));
  }
  for (const auto& [name, place] : model.other_names) add(name, place);
}

double StateNames::value(const Snapshot& state, const std::string& name) const {
  const auto place = places.find(name);
  if (place != places.end()) {
    const auto [part, index] = place->second;
    return part == Part::coordinate ? state.coordinates[index]
           : part == Part::velocity ? state.velocity[index]
                                    : state.momentum[index];
  }
  if (name == "t") return state.time;
  if (name == "energy") return state.energy;
  std::vector<std::string> known = {"t", "energy"};
  for (const auto& [key, unused] : places) known.push_back(key);
  throw nb::key_error(unknown_name("quantity", name, known).c_str());
}

void bind_run(nb::module_& m) {
  bind_status(m);
  bind_state(m);
  nb::class_<ByHand>(
      m, "Run",
      "A run to be stepped by hand; Simulation.build() makes it. run['omega'] is a number of the "
      "current state by its name, run.names are all. A step leaves the interpreter to other "
      "threads; one thread at a time may use a run.",
      nb::type_slots(Collected<ByHand>::slots))
      .def("step", &steps, "count"_a = 1,
           "One step, or so many; the status of the first that failed.")
      .def(
          "step_towards",
          [](ByHand& self, double t) {
            return freely(self, [t](Run& run) { return run.step_towards(t); });
          },
          "t"_a, "One step; a chosen one ends at t [s] at the latest.")
      .def(
          "advance_to",
          [](ByHand& self, double t) {
            return freely(self, [t](Run& run) { return run.advance_to(t); });
          },
          "t"_a, "Steps to time t [s]: chosen ones end there, others at the node nearest to it.")
      .def(
          "complete",
          [](ByHand& self) { return freely(self, [](Run& run) { return run.complete(); }); },
          "Steps to the end time, or to what ends the run before.")
      .def(
          "turn_back", [](ByHand& self) { return freely(self, [](Run& run) { run.turn_back(); }); },
          "Time runs the other way from here.")
      .def(
          "input",
          [](ByHand& self, const std::string& name, double value) {
            const Alone alone(self);
            self.current = nullptr;
            self.run.input(name, value);
          },
          "name"_a, "value"_a,
          "An input from now on, in the unit that the system states; the builder must have given "
          "the run a first value of some input.")
      .def(
          "restart",
          [](ByHand& self, nb::handle configuration, nb::handle velocity, nb::handle momentum) {
            const auto given = [](const char* name, nb::handle value) {
              return value.is_none() ? Doubles() : numbers(name, value);
            };
            const Start start = {given("configuration", configuration), given("velocity", velocity),
                                 given("momentum", momentum)};
            freely(self, [&](Run& run) { run.restart(start); });
          },
          "configuration"_a = nb::none(), "velocity"_a = nb::none(), "momentum"_a = nb::none(),
          nb::sig("def restart(self, configuration: _Numbers | None = None, velocity: _Numbers | "
                  "None = None, momentum: _Numbers | None = None) -> None"),
          "Again from another start, at the start time; inputs keep their values.")
      .def(
          "at",
          [](ByHand& self, double t) {
            return NamedState{freely(self, [t](Run& run) { return run.at(t); }), self.names};
          },
          "t"_a, "The state at a time [s] within the last step, by dense output.")
      .def(
          "tangent",
          [](ByHand& self) {
            const RunTangent t = freely(self, [](Run& run) { return run.tangent(); });
            if (!t.status.ok) throw std::runtime_error(t.status.reason);
            return matrix(t.matrix.values, static_cast<size_t>(t.matrix.columns));
          },
          nb::sig("def tangent(self) -> numpy.typing.NDArray[numpy.float64]"),
          "The tangent from the start to the current state, shape (2n, 2n): (eta, dxi) by (eta, "
          "dxi), of the run repeated with its present inputs. RuntimeError where that does not "
          "lead here.")
      .def(
          "finish",
          [](ByHand& self) {
            Result result = freely(self, [](Run& run) { return run.finish(); });
            self.finished = true;
            return result_of(std::move(result), self.source, self.functions);
          },
          nb::sig("def finish(self) -> Result"),
          "Ends the run: the last row, the files, the measurements; events that were met.")
      .def_prop_ro(
          "state",
          [](ByHand& self) {
            const Alone alone(self);
            return NamedState{self.state(), self.names};
          },
          "The current state with its measurements, a copy.")
      .def_prop_ro(
          "time",
          [](ByHand& self) {
            const Alone alone(self);
            return self.run.time();
          },
          "[s]")
      .def_prop_ro(
          "coordinates",
          [](ByHand& self) {
            const Alone alone(self);
            return array(
                self.part({.element = false, .momentum = false, .energy = false, .measures = false})
                    .coordinates);
          },
          nb::sig("def coordinates(self) -> numpy.typing.NDArray[numpy.float64]"),
          "of the element g")
      .def_prop_ro(
          "velocity",
          [](ByHand& self) {
            const Alone alone(self);
            return array(self.part({.coordinates = false,
                                    .element = false,
                                    .momentum = false,
                                    .energy = false,
                                    .measures = false})
                             .velocity);
          },
          nb::sig("def velocity(self) -> numpy.typing.NDArray[numpy.float64]"),
          "nodal body velocity xi, shape (n,)")
      .def(
          "__getitem__",
          [](ByHand& self, const std::string& name) {
            const Alone alone(self);
            return self.names->value(self.state(), name);
          },
          "name"_a)
      .def_prop_ro(
          "names",
          [](const ByHand& self) {
            std::vector<std::string> out = self.names->model.coordinates;
            const auto& velocities = self.names->model.velocities;
            out.insert(out.end(), velocities.begin(), velocities.end());
            return out;
          },
          "of coordinates and velocities, in their order")
      .def_prop_ro(
          "system", [](const ByHand& self) { return self.names->model; },
          "What is stated about the system.")
      .def_prop_ro("stats", [](const ByHand& self) { return self.run.stats(); })
      .def_prop_ro("config", [](const ByHand& self) { return self.run.config(); })
      .def_prop_ro("notes", [](const ByHand& self) { return self.run.notes(); })
      .def("__repr__", [](ByHand& self) {
        return "<hamel.Run of " + self.run.config().system +
               " at t = " + (self.finished ? "its end" : text_of(self.state().time)) + ">";
      });
}

nb::object by_hand(const Builder& builder) {
  const Simulation simulation = watched(builder);
  Run built = [&] {
    const Away free;
    return simulation.build();
  }();
  return nb::cast(new ByHand(std::move(built), builder), nb::rv_policy::take_ownership);
}

}  // namespace hamel::python
