// The builder, hamel.simulate(...), by the names of C++.
#include "bindings.hpp"

namespace hamel::python {
namespace {

// Sets a parameter: simulate("suslov").inertia([1, 2, 3]).
struct ParameterSetter {
  nb::object builder;
  std::string name;
};

}  // namespace

Builder builder_of(nb::handle system) {
  if (nb::isinstance<nb::str>(system) || nb::hasattr(system, "__fspath__")) {
    const std::string name = text("system", system);
    if (name.find('\n') == std::string::npos) return {simulate(name)};
    return {simulate_text(name, "system.toml"), name};
  }
  if (nb::isinstance<Builder>(system)) return nb::cast<Builder>(system);
  if (nb::isinstance<Config>(system)) {
    const auto& config = nb::cast<const Config&>(system);
    Builder out{simulate(config.system)};
    out.simulation.config(config);
    return out;
  }
  if (nb::isinstance<ByParts>(system)) {
    const auto& parts = nb::cast<const ByParts&>(system);
    Builder out{simulate(static_cast<const Mechanism&>(parts)), "", true};
    out.functions.add(parts.functions);
    return out;
  }
  if (nb::isinstance<SystemText>(system)) {
    const auto& [toml, name] = nb::cast<const SystemText&>(system);
    return {simulate_text(toml, name), toml};
  }
  throw nb::type_error("system: expected a name, a file, the text of one, a Mechanism or a Config");
}

Builder builder_of(nb::handle system, const nb::kwargs& options) {
  Builder out = builder_of(system);
  if (options.size() > 0) apply(out, options);
  return out;
}

Simulation watched(const Builder& builder) {
  Simulation simulation = builder.simulation;
  simulation.progress([report = builder.progress](double fraction) {
    const Entered python;
    if (PyErr_CheckSignals() != 0) nb::raise_python_error();
    if (report) (*report)(fraction);
  });
  if (!builder.observer) return simulation;
  const auto names = std::make_shared<const StateNames>(*simulation.system());
  simulation.observe([observer = *builder.observer, names](const Snapshot& state) {
    const Entered python;
    const nb::object go_on = observer(NamedState{state, names});
    const int answer = go_on.is_none() ? 1 : PyObject_IsTrue(go_on.ptr());
    if (answer < 0) nb::raise_python_error();
    return answer != 0;
  });
  return simulation;
}

Result run(const Builder& builder) {
  const Simulation simulation = watched(builder);
  const Away free;
  if (!builder.functions.empty()) return simulation.run();  // called while it runs
  return simulation.run_unread();
}

void bind_simulation(nb::module_& m) {
  nb::class_<ParameterSetter>(m, "ParameterSetter")
      .def(
          "__call__",
          [](ParameterSetter& self, nb::handle value) {
            return self.builder.attr("set")(self.name, value);
          },
          "value"_a, nb::sig("def __call__(self, value: _Numbers) -> Simulation"));
  nb::class_<Builder> builder(
      m, "Simulation",
      "The builder: from a system and a few names to a run. run() and build() check everything "
      "first and raise one ConfigError with all mistakes; after that a numerical failure is "
      "result.status, and the good steps are kept.",
      nb::type_slots(Collected<Builder>::slots));
  bind_builder(m, builder);
  builder
      .def_prop_ro(
          "config", [](const Builder& self) { return self.simulation.config(); },
          "A copy of the request as plain data.")
      .def(
          "mistakes", [](const Builder& self) { return self.simulation.mistakes(); },
          "Everything that is wrong; empty when run() can start.")
      .def("build", &by_hand, nb::sig("def build(self) -> Run"), "A run to be stepped by hand.")
      .def(
          "run",
          [](const Builder& self) { return result_of(run(self), self.source, self.functions); },
          nb::sig("def run(self) -> Result"), "Steps to the end, the interpreter free.")
      .def(
          "sensitivities",
          [](const Builder& self, const std::vector<std::string>& names) {
            const Away free;
            return self.simulation.sensitivities(names);
          },
          "names"_a,
          "Derivatives along the run by parameters, constant inputs and the start "
          "('start.omega').")
      .def(
          "gradient",
          [](const Builder& self, const std::string& objective,
             const std::vector<std::string>& names) {
            const Away free;
            return self.simulation.gradient(objective, names);
          },
          "objective"_a, "names"_a,
          "The derivative of a quantity or formula at the end of the run, 'x**2' written 'x^2'.")
      .def(
          "__getattr__",
          [](nb::object self, const std::string& name) {
            if (name.starts_with("_")) throw nb::attribute_error(name.c_str());
            return ParameterSetter{self, name};
          },
          "name"_a, nb::sig("def __getattr__(self, name: str, /) -> ParameterSetter"),
          "A parameter by its name: simulate('suslov').inertia([1, 2, 3]).")
      .def("__repr__",
           [](const Builder& self) {
             return "<hamel.Simulation of " + self.simulation.config().system + ">";
           })
      .def("__getstate__",
           [](const Builder& self) {
             if (self.by_parts || self.has_functions)
               throw nb::type_error(
                   "a Simulation with a Mechanism by parts or with functions does not pickle");
             return nb::make_tuple(self.simulation.config(), self.source);
           })
      .def("__setstate__", [](Builder& self, const std::tuple<Config, std::string>& state) {
        const auto& [config, source] = state;
        new (&self)
            Builder{source.empty() ? simulate(config.system) : simulate_text(source, config.system),
                    source};
        self.simulation.config(config);
      });
  static const std::string help =
      "Runs a system to its end.\n\nsystem: a registered name (hamel.list('systems')), a file "
      "my_system.toml, the text of one, a Mechanism, a Simulation or a Config. Keywords are the "
      "parameters of the system by their names, and:" +
      options_of_a_run() +
      "\n\nRaises ConfigError with every mistake before anything runs. Ctrl-C ends it.";
  m.def(
      "simulate",
      [](nb::handle system, const nb::kwargs& options) { return builder_of(system, options); },
      "system"_a, "options"_a,
      nb::sig("def simulate(system: _System, **options: typing.Any) -> Simulation"),
      "The builder of a run. The keywords are those of hamel.run.");
  m.def(
      "run",
      [](nb::handle system, const nb::kwargs& options) {
        const Builder given = builder_of(system, options);
        return result_of(run(given), given.source, given.functions);
      },
      "system"_a, "options"_a, nb::sig("def run(system: _System, **options: typing.Any) -> Result"),
      help.c_str());
}

}  // namespace hamel::python
