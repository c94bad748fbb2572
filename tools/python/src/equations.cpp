// The equations of a system at any state: hamel.equations.
#include "bindings.hpp"

namespace hamel::python {
namespace {

nb::object matrix_of(const NumberMatrix& m) {
  return matrix(m.values, static_cast<size_t>(m.columns));
}

// A State of a run, a dict, or None: the start.
Start state_of(nb::handle state) {
  if (state.is_none()) return {};
  if (nb::isinstance<NamedState>(state)) {
    const Snapshot& at = nb::cast<const NamedState&>(state).state;
    return {at.coordinates, at.velocity, {}};
  }
  return start_of("state", state);
}

// Names that the code of a notation defines.
nb::object defined(const Equations& equations, const std::string& notation) {
  nb::dict names;
  nb::module_::import_("builtins").attr("exec")(equations.formulas(notation), names);
  nb::object out = nb::module_::import_("types").attr("SimpleNamespace")();
  for (const char* name : {"t", "q", "xi", "u", "rate", "coordinate_rates"})
    if (names.contains(name)) nb::setattr(out, name, names[name]);
  return out;
}

}  // namespace

void bind_equations(nb::module_& m) {
  nb::class_<RowsOfState>(m, "Rows", "Constraint rows at a state: a @ xi = b, holonomic = 0.")
      .def_prop_ro(
          "a", [](const RowsOfState& r) { return matrix_of(r.a); }, "A(g), shape (k, n)")
      .def_prop_ro(
          "b", [](const RowsOfState& r) { return array(r.b); }, "b(t, g), shape (k,)")
      .def_prop_ro(
          "holonomic", [](const RowsOfState& r) { return array(r.holonomic); },
          "phi(g) of the last rows")
      .def_ro("names", &RowsOfState::names, "of their multipliers");
  nb::class_<JacobianOfState>(m, "Jacobian", "Derivatives of a quantity: .values, .errors.")
      .def_prop_ro("values", [](const JacobianOfState& j) { return matrix_of(j.values); })
      .def_prop_ro(
          "errors", [](const JacobianOfState& j) { return matrix_of(j.errors); },
          "of each entry, estimated")
      .def(
          "__array__",
          [](const JacobianOfState& j, nb::handle dtype, nb::handle /*copy*/) {
            const nb::object values = matrix_of(j.values);
            return dtype.is_none() ? values : values.attr("astype")(dtype);
          },
          "dtype"_a = nb::none(), "copy"_a = nb::none(),
          nb::sig("def __array__(self, dtype: object = None, copy: bool | None = None) -> "
                  "numpy.typing.NDArray[numpy.float64]"));
  nb::class_<Equations>(
      m, "Equations",
      "The equations of a system at any state, I xi' = ad*_xi I xi + f - (dI/dt) xi + A^T lambda, "
      "A xi = b, as arrays. A state is a State of a run, or a dict of configuration and velocity "
      "or momentum; what it leaves out is that of the start.")
      .def_prop_ro(
          "velocities", [](const Equations& e) { return e.velocities(); },
          "names of the n components of xi")
      .def_prop_ro("columns", [](const Equations& e) { return e.columns(); })
      .def_prop_ro(
          "start",
          [](const Equations& e) {
            nb::dict out;
            out["configuration"] = array(e.start().configuration);
            out["velocity"] = array(e.start().velocity);
            return out;
          },
          nb::sig("def start(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]"))
      .def(
          "rate",
          [](const Equations& e, double t, nb::handle state) {
            return array(e.rate(t, state_of(state)));
          },
          "t"_a = 0.0, "state"_a = nb::none(), "xi', shape (n,)")
      .def(
          "inertia",
          [](const Equations& e, nb::handle state) {
            return matrix_of(e.inertia(state_of(state)));
          },
          "state"_a = nb::none(), "I(g), shape (n, n)")
      .def(
          "rows",
          [](const Equations& e, nb::handle state, double t) { return e.rows(state_of(state), t); },
          "state"_a = nb::none(), "t"_a = 0.0)
      .def(
          "reactions",
          [](const Equations& e, nb::handle state, double t) {
            return array(e.reactions(state_of(state), t));
          },
          "state"_a = nb::none(), "t"_a = 0.0, "multipliers of the rows, shape (k,)")
      .def(
          "momentum",
          [](const Equations& e, nb::handle state) { return array(e.momentum(state_of(state))); },
          "state"_a = nb::none(), "I(g) xi, shape (n,)")
      .def(
          "energy", [](const Equations& e, nb::handle state) { return e.energy(state_of(state)); },
          "state"_a = nb::none(), "kinetic and potential, J")
      .def("formulas", &Equations::formulas, "notation"_a = "latex",
           "The equations as formulas, parameters as numbers: 'latex', 'c', 'numpy' or 'sympy'. "
           "ConfigError where the system has no recorded formulas.")
      .def("_repr_latex_",
           [](const Equations& e) -> std::optional<std::string> {
             try {
               return "$$" + e.formulas("latex") + "$$";
             } catch (const ConfigError&) {  // it has no formulas
               return {};
             }
           })
      .def(
          "as_numpy", [](const Equations& e) { return defined(e, "numpy"); },
          nb::sig("def as_numpy(self) -> types.SimpleNamespace"),
          "Functions rate(t, q, xi, u) and coordinate_rates(q, xi), made of formulas('numpy').")
      .def(
          "as_sympy", [](const Equations& e) { return defined(e, "sympy"); },
          nb::sig("def as_sympy(self) -> types.SimpleNamespace"),
          "Symbols t, q, xi, u and matrices rate, coordinate_rates, made of formulas('sympy').")
      .def_prop_ro("arguments", &Equations::arguments, "what a quantity has a jacobian of")
      .def(
          "jacobian",
          [](const Equations& e, const std::string& quantity, const std::string& of,
             nb::handle state, double t) { return e.jacobian(quantity, of, state_of(state), t); },
          "quantity"_a, "of"_a, "state"_a = nb::none(), "t"_a = 0.0,
          "Derivatives of 'rate', 'momentum', 'reactions' or 'energy' (rows) by 'velocity', "
          "'configuration' (along g tau(e_j x)), 'time', a parameter or an input (columns), with "
          "the error of each.")
      .def("__repr__", [](const Equations& e) {
        return "<hamel.Equations of " + e.name() +
               ", n = " + std::to_string(e.velocities().size()) + ">";
      });
  m.def(
      "equations",
      [](nb::handle system, const nb::kwargs& options) {
        return Equations(builder_of(system, options).simulation);
      },
      "system"_a, "options"_a,
      nb::sig("def equations(system: _System, **options: typing.Any) -> Equations"),
      "The equations of a system with these parameters, inputs and start, options as those of "
      "run.");
}

}  // namespace hamel::python
