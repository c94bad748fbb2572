// The members of the builder, by the names of C++: options, inputs, functions.
#include <algorithm>

#include "bindings.hpp"

namespace hamel::python {
namespace {

// The state at an event, to be changed by a callback.
struct PythonEvent {
  double time;
  std::vector<double> coordinates, velocity;
};

Impact impact_of(const Function& function) {
  return [function](EventState& state) {
    const Entered python;
    nb::object event = nb::cast(PythonEvent{state.time, state.coordinates, state.velocity});
    function(event);
    const auto& changed = nb::cast<const PythonEvent&>(event);
    state.coordinates = changed.coordinates;
    state.velocity = changed.velocity;
  };
}

using Doubles = std::vector<double>;

void bind_event_state(nb::module_& m) {
  const auto view = [](Doubles PythonEvent::*member) {
    return [member](nb::handle self) {
      Doubles& values = nb::cast<PythonEvent&>(self).*member;
      return nb::cast(Array(values.data(), {values.size()}, self));
    };
  };
  const auto set = [](const char* name, Doubles PythonEvent::*member) {
    return [name, member](PythonEvent& self, nb::handle values) {
      Doubles given = numbers(name, values);
      if (given.size() != (self.*member).size())
        throw ConfigError({std::string(name) + ": got " + std::to_string(given.size()) +
                           " numbers, expected " + std::to_string((self.*member).size())});
      std::copy(given.begin(), given.end(), (self.*member).begin());
    };
  };
  nb::class_<PythonEvent>(m, "EventState",
                          "The state at an event; what is written into its arrays is where the "
                          "run continues, its velocity projected onto the constraints.")
      .def_ro("time", &PythonEvent::time, "[s]")
      .def_prop_rw(
          "coordinates", view(&PythonEvent::coordinates),
          set("coordinates", &PythonEvent::coordinates),
          nb::for_getter(nb::sig("def coordinates(self) -> numpy.typing.NDArray[numpy.float64]")),
          nb::for_setter(nb::sig("def coordinates(self, values: _Numbers, /) -> None")),
          "of the element, as in the columns")
      .def_prop_rw(
          "velocity", view(&PythonEvent::velocity), set("velocity", &PythonEvent::velocity),
          nb::for_getter(nb::sig("def velocity(self) -> numpy.typing.NDArray[numpy.float64]")),
          nb::for_setter(nb::sig("def velocity(self, values: _Numbers, /) -> None")),
          "body components, n");
}

template <class Value>
auto set_by(Simulation& (Simulation::*member)(Value)) {
  return [member](Builder& self, Value value) -> Builder& {
    (self.simulation.*member)(std::move(value));
    return self;
  };
}

void bind_functions(nb::class_<Builder>& builder) {
  builder
      .def(
          "observe",
          [](Builder& self, nb::callable function) -> Builder& {
            self.has_functions = true;
            self.observer = self.functions.add(function);
            return self;
          },
          "observer"_a, nb::rv_policy::reference,
          nb::sig("def observe(self, observer: collections.abc.Callable[[State], bool | None]) -> "
                  "Simulation"),
          "Called with each recorded state; returning False stops the run there.")
      .def(
          "on_event",
          [](Builder& self, const std::string& name, nb::callable function) -> Builder& {
            self.has_functions = true;
            self.simulation.on_event(name, impact_of(self.functions.add(function)));
            return self;
          },
          "name"_a, "impact"_a, nb::rv_policy::reference,
          nb::sig("def on_event(self, name: str, impact: collections.abc.Callable[[EventState], "
                  "object]) -> "
                  "Simulation"),
          "Locates an event, and lets the callable change the state there.")
      .def(
          "progress",
          [](Builder& self, nb::object report) -> Builder& {
            if (nb::isinstance<nb::bool_>(report)) {
              if (!nb::cast<bool>(report)) return self;
              report = helper("_progress", "bar")();
            }
            self.progress = self.functions.add(report);
            return self;
          },
          "report"_a = true, nb::rv_policy::reference,
          nb::sig("def progress(self, report: collections.abc.Callable[[float], object] | bool = "
                  "True) -> "
                  "Simulation"),
          "Called now and then with the fraction done, in [0, 1]; True: a bar of tqdm where that "
          "is installed.");
}

void bind_options(nb::class_<Builder>& builder) {
  builder
      .def(
          "set",
          [](Builder& self, const std::string& name, nb::handle value) -> Builder& {
            self.simulation.set(name, numbers(name, value));
            return self;
          },
          "name"_a, "value"_a, nb::rv_policy::reference,
          nb::sig("def set(self, name: str, value: _Numbers) -> Simulation"),
          "A parameter, in the unit that the system states; also as a method of its own name.")
      .def(
          "input",
          [](Builder& self, const std::string& name, nb::handle value) -> Builder& {
            self.simulation.input(name, signal_of(name, value));
            return self;
          },
          "name"_a, "value"_a, nb::rv_policy::reference,
          nb::sig("def input(self, name: str, value: _Signal) -> Simulation"),
          "An input: a number, an InputTable, a pair (times, values), or a file 'table.csv'.")
      .def(
          "start",
          [](Builder& self, nb::handle configuration, nb::handle velocity,
             nb::handle momentum) -> Builder& {
            const auto given = [](const char* name, nb::handle value) {
              return value.is_none() ? Doubles() : numbers(name, value);
            };
            self.simulation.start({given("configuration", configuration),
                                   given("velocity", velocity), given("momentum", momentum)});
            return self;
          },
          "configuration"_a = nb::none(), "velocity"_a = nb::none(), "momentum"_a = nb::none(),
          nb::rv_policy::reference,
          nb::sig(
              "def start(self, configuration: _Numbers | None = None, velocity: _Numbers | None "
              "= None, momentum: _Numbers | None = None) -> Simulation"),
          "Where to start: columns of the element, body velocity or body momentum (n numbers "
          "each), projected onto the constraints.")
      .def(
          "solver",
          [](Builder& self, const std::string& name, double tolerance) -> Builder& {
            self.simulation.solver(name, {tolerance});
            return self;
          },
          "name"_a, "tolerance"_a = Config().tolerance, nb::rv_policy::reference,
          "Of the implicit equation; tolerance on |F| / scale.")
      .def(
          "tolerance",
          [](Builder& self, std::optional<double> relative,
             std::optional<double> absolute) -> Builder& {
            self.simulation.tolerance({relative, absolute});
            return self;
          },
          "relative"_a = nb::none(), "absolute"_a = nb::none(), nb::rv_policy::reference,
          "Steps chosen by the error.")
      .def(
          "output",
          [](Builder& self, nb::handle times) -> Builder& {
            if (PyFloat_Check(times.ptr()) || PyLong_Check(times.ptr()))
              self.simulation.output(number("output", times));
            else self.simulation.output(numbers("output", times));
            return self;
          },
          "times"_a, nb::rv_policy::reference,
          nb::sig("def output(self, times: _Numbers) -> Simulation"),
          "Rows at these times [s], or this distance in time, by dense output.")
      .def(
          "record_to",
          [](Builder& self, nb::handle path) -> Builder& {
            self.simulation.record_to(text("record_to", path));
            return self;
          },
          "path"_a, nb::rv_policy::reference,
          nb::sig("def record_to(self, path: str | os.PathLike[str]) -> Simulation"),
          "Rows are written as they come (.csv, .csv.gz, .h5, .json); then the result has none, "
          "unless keep_rows is given.")
      .def("keep_rows", set_by(&Simulation::keep_rows), "most"_a, nb::rv_policy::reference,
           "A trajectory of about so many rows beside the files.")
      .def(
          "resume",
          [](Builder& self, nb::handle path) -> Builder& {
            self.simulation.resume(text("resume", path));
            return self;
          },
          "path"_a, nb::rv_policy::reference,
          nb::sig("def resume(self, path: str | os.PathLike[str]) -> Simulation"),
          "Resumes the unfinished run in a file .h5 that this run was recorded to.")
      .def(
          "options",
          [](nb::object self, const nb::kwargs& options) {
            apply(nb::cast<Builder&>(self), options);
            return self;
          },
          "options"_a, nb::sig("def options(self, **options: typing.Any) -> Simulation"),
          "Any of the keywords of hamel.run.");
}

}  // namespace

void bind_builder(nb::module_& m, nb::class_<Builder>& builder) {
  bind_event_state(m);
  bind_setters(builder);
  bind_options(builder);
  bind_functions(builder);
}

}  // namespace hamel::python
