// Steady motions, their stability and linearisation: hamel.steady, hamel.linearisation.
#include <algorithm>
#include <cmath>

#include "bindings.hpp"

namespace hamel::python {
namespace {

nb::object array_of(const NumberMatrix& m) {
  return matrix(m.values, static_cast<size_t>(m.columns));
}

// (name, from, to, count), (name, values), or "name=from:to:count".
struct Vary {
  std::string name;
  std::vector<double> values;

  explicit Vary(nb::handle given) {
    if (nb::isinstance<nb::str>(given)) {
      read(utf8("vary", given));
      return;
    }
    const nb::tuple parts(given);
    if (parts.size() != 2 && parts.size() != 4)
      throw ConfigError({"vary: expected (name, values) or (name, from, to, count)"});
    name = text("vary", parts[0]);
    if (parts.size() == 2) values = numbers("vary", parts[1]);
    else spread(number("from", parts[1]), number("to", parts[2]), number("count", parts[3]));
  }

 private:
  void read(const std::string& text) {
    const size_t equal = text.find('=');
    std::string list = equal == std::string::npos ? "" : text.substr(equal + 1);
    std::replace(list.begin(), list.end(), ':', ',');
    std::vector<double> numbers;
    if (!list.empty()) read_text("vary", list, numbers);
    if (numbers.size() == 2) numbers.push_back(101);
    if (numbers.size() != 3 || equal == 0)
      throw ConfigError({"vary: got '" + text + "', expected name=from:to:count"});
    name = text.substr(0, equal);
    spread(numbers[0], numbers[1], numbers[2]);
  }
  void spread(double from, double to, double count) {
    if (count != std::floor(count) || count < 2 || count > 100000)
      throw ConfigError(
          {"vary: got " + text_of(count) + " values, expected a whole number from 2 to 100000"});
    for (int i = 0; i < count; ++i) values.push_back(from + (to - from) * i / (count - 1));
  }
};

SteadySweep sweep(nb::handle system, nb::handle vary, bool branches, const nb::kwargs& options) {
  const Simulation run = builder_of(system, options).simulation;
  const Vary along(vary);
  const auto at = [&](double value) {
    Simulation out = run;
    if (along.name == "speed") out.speed(value);
    else out.set(along.name, value);
    return out;
  };
  const Away free;
  SteadySweep out = sweep_steady(registry(), along.values, at, branches);
  out.parameter = along.name;
  out.unit = figures::unit_of(along.name, at(along.values.front()).build().system());
  return out;
}

SteadyMotion steady(nb::handle system, const nb::kwargs& options) {
  const Simulation run = builder_of(system, options).simulation;
  const Away free;
  return steady_motion(registry(), run);
}

void bind_motion(nb::module_& m) {
  nb::class_<SteadyMotion>(m, "SteadyMotion",
                           "A steady motion and the eigenvalues of its linearisation; true where "
                           "one was found.")
      .def("__bool__", [](const SteadyMotion& s) { return s.found; })
      .def_ro("found", &SteadyMotion::found)
      .def_prop_ro(
          "element", [](const SteadyMotion& s) { return array(s.element); },
          nb::sig("def element(self) -> numpy.typing.NDArray[numpy.float64]"), "coordinates")
      .def_prop_ro(
          "velocity", [](const SteadyMotion& s) { return array(s.velocity); },
          nb::sig("def velocity(self) -> numpy.typing.NDArray[numpy.float64]"), "xi, shape (n,)")
      .def_ro("residual", &SteadyMotion::residual)
      .def_prop_ro(
          "eigenvalues", [](const SteadyMotion& s) { return complex_array(s.eigenvalues); },
          nb::sig("def eigenvalues(self) -> numpy.typing.NDArray[numpy.complex128]"),
          "[1/s], by real part, largest first, without the neutral ones")
      .def_prop_ro(
          "round_off", [](const SteadyMotion& s) { return array(s.round_off); },
          nb::sig("def round_off(self) -> numpy.typing.NDArray[numpy.float64]"),
          "error of each eigenvalue")
      .def_prop_ro(
          "modes",
          [](const SteadyMotion& s) {
            std::vector<std::map<std::string, double>> out;
            for (const auto& mode : s.modes) {
              auto& parts = out.emplace_back();
              for (const ModePart& part : mode) parts[part.name] = part.size;
            }
            return out;
          },
          "of each eigenvalue how much every velocity takes part, 1 the largest, and the "
          "coordinates of "
          "the shape beside it")
      .def_ro("neutral", &SteadyMotion::neutral, "directions of symmetry, and zeros of the family")
      .def_ro("family", &SteadyMotion::family)
      .def_prop_ro("growing", &SteadyMotion::decided_growing,
                   "how many eigenvalues have a positive real part; None where the errors cover it")
      .def_prop_ro(
          "stable", [](const SteadyMotion& s) { return s.decided_growing() == 0; },
          "whether no eigenvalue grows, beyond doubt")
      .def("__repr__", [](const SteadyMotion& s) {
        if (!s.found) return std::string("<hamel.SteadyMotion: none found>");
        return "<hamel.SteadyMotion at velocity [" + join(s.velocity) + "], " +
               std::to_string(s.growing()) + " of " + std::to_string(s.eigenvalues.size()) +
               " eigenvalues grow>";
      });
}

void bind_sweep(nb::module_& m) {
  nb::class_<SteadyPlace>(m, "SteadyPlace", "A steady motion at a value of the parameter.")
      .def_ro("value", &SteadyPlace::value)
      .def_ro("element", &SteadyPlace::element)
      .def_ro("velocity", &SteadyPlace::velocity);
  nb::class_<SteadyCrossing>(m, "SteadyCrossing", "Where the stability of a branch changes.")
      .def_ro("value", &SteadyCrossing::value)
      .def_ro("round_off", &SteadyCrossing::round_off, "of the value")
      .def_ro("pair", &SteadyCrossing::pair, "of complex eigenvalues; else a real one")
      .def_prop_ro(
          "kind", [](const SteadyCrossing& c) { return name_of(c.kind); }, "'pitchfork', 'hopf', …")
      .def_ro("supercritical", &SteadyCrossing::supercritical,
              "of a pitchfork: the other branch is where this one is unstable")
      .def_ro("other", &SteadyCrossing::other, "on the branch that crosses this one")
      .def("__repr__", [](const SteadyCrossing& c) {
        return "<hamel.SteadyCrossing " + name_of(c.kind) + " at " + text_of(c.value) + ">";
      });
  nb::class_<SteadyEnd>(m, "SteadyEnd", "Where a branch ends before the last value.")
      .def_ro("value", &SteadyEnd::value)
      .def_ro("round_off", &SteadyEnd::round_off)
      .def_ro("towards_last", &SteadyEnd::towards_last, "of the values; else towards the first")
      .def_prop_ro("kind", [](const SteadyEnd& e) { return name_of(e.kind); })
      .def_ro("other", &SteadyEnd::other, "on the branch that continues");
  nb::class_<SteadySweep> sweep(m, "SteadySweep", "A branch of steady motions along a parameter.");
  sweep.def_ro("parameter", &SteadySweep::parameter, "the name of what is varied; '' of branches")
      .def_prop_ro(
          "values", [](const SteadySweep& s) { return array(s.values); },
          nb::sig("def values(self) -> numpy.typing.NDArray[numpy.float64]"), "of the parameter")
      .def_ro("motions", &SteadySweep::motions, "one for each value; not found where it is not")
      .def_ro("crossings", &SteadySweep::crossings)
      .def_ro("ends", &SteadySweep::ends,
              "where it ends between the values, two at most; else it leaves the range")
      .def_ro("start", &SteadySweep::start, "of a branch that crosses another one")
      .def_ro("branches", &SteadySweep::branches, "the others that were met and followed")
      .def("__repr__", [](const SteadySweep& s) {
        return "<hamel.SteadySweep of " + std::to_string(s.values.size()) + " values, " +
               std::to_string(s.crossings.size()) + " crossings>";
      });
  bind_figures(sweep, "html_of_sweep",
               "Real parts (growth) and imaginary parts (frequency) of the eigenvalues along the "
               "parameter.",
               [](const SteadySweep& s) { return figures::of_sweep(s); });
}

void bind_linearisation(nb::module_& m) {
  nb::class_<Linearisation>(m, "Linearisation",
                            "x' = A x + B u, y = values + C x, about a steady motion: states, "
                            "inputs and quantities by name.")
      .def_ro("motion", &Linearisation::motion)
      .def_ro("states", &Linearisation::states)
      .def_ro("inputs", &Linearisation::inputs)
      .def_ro("quantities", &Linearisation::quantities)
      .def_ro("unused", &Linearisation::unused, "inputs that drive rates, not efforts")
      .def_prop_ro(
          "A", [](const Linearisation& l) { return array_of(l.a); },
          nb::sig("def A(self) -> numpy.typing.NDArray[numpy.float64]"), "shape (states, states)")
      .def_prop_ro(
          "B", [](const Linearisation& l) { return array_of(l.b); },
          nb::sig("def B(self) -> numpy.typing.NDArray[numpy.float64]"), "shape (states, inputs)")
      .def_prop_ro(
          "C", [](const Linearisation& l) { return array_of(l.c); },
          nb::sig("def C(self) -> numpy.typing.NDArray[numpy.float64]"),
          "shape (quantities, states)")
      .def_prop_ro(
          "A_error", [](const Linearisation& l) { return array_of(l.a_error); },
          nb::sig("def A_error(self) -> numpy.typing.NDArray[numpy.float64]"), "of each entry of A")
      .def_prop_ro(
          "B_error", [](const Linearisation& l) { return array_of(l.b_error); },
          nb::sig("def B_error(self) -> numpy.typing.NDArray[numpy.float64]"), "of each entry of B")
      .def_prop_ro(
          "C_error", [](const Linearisation& l) { return array_of(l.c_error); },
          nb::sig("def C_error(self) -> numpy.typing.NDArray[numpy.float64]"), "of each entry of C")
      .def_prop_ro(
          "values", [](const Linearisation& l) { return array(l.values); },
          nb::sig("def values(self) -> numpy.typing.NDArray[numpy.float64]"),
          "the quantities of the motion")
      .def_prop_ro(
          "embedding", [](const Linearisation& l) { return array_of(l.embedding); },
          nb::sig("def embedding(self) -> numpy.typing.NDArray[numpy.float64]"),
          "shape (2n, states)")
      .def(
          "sampled",
          [](const Linearisation& l, double h) {
            const DiscretePair pair = l.sampled(h);
            return nb::make_tuple(array_of(pair.a), array_of(pair.b));
          },
          "h"_a,
          nb::sig("def sampled(self, h: float) -> tuple[numpy.typing.NDArray[numpy.float64], "
                  "numpy.typing.NDArray[numpy.float64]]"),
          "The pair (A, B) of x(t + h) = A x + B u for inputs held for h seconds.")
      .def(
          "state",
          [](const Linearisation& l, nb::handle coordinates, nb::handle velocity) {
            return array(
                l.state(numbers("coordinates", coordinates), numbers("velocity", velocity)));
          },
          "coordinates"_a, "velocity"_a,
          nb::sig("def state(self, coordinates: _Numbers, velocity: _Numbers) -> "
                  "numpy.typing.NDArray[numpy.float64]"),
          "The states of a state of a run, to first order, shape (states,).")
      .def("__repr__", [](const Linearisation& l) {
        return "<hamel.Linearisation: states " + join(l.states) + "; inputs " + join(l.inputs) +
               ">";
      });
}

}  // namespace

void bind_steady(nb::module_& m) {
  bind_motion(m);
  bind_sweep(m);
  bind_linearisation(m);
  m.def("steady", &sweep, "system"_a, nb::kw_only(), "vary"_a, "branches"_a = false, "options"_a,
        nb::sig("def steady(system: _System, *, vary: _Vary, branches: bool = False, **options: "
                "typing.Any) "
                "-> SteadySweep"),
        "The branch of steady motions along a parameter or 'speed', vary = ('speed', 1, 8, 71) or "
        "'speed=1:8:71'; branches: those that meet it are followed too.");
  m.def("steady", &steady, "system"_a, "options"_a,
        nb::sig("def steady(system: _System, **options: typing.Any) -> SteadyMotion"),
        "A steady motion near the start of a run (speed, velocity, … as in hamel.run), and its "
        "stability.");
  m.def(
      "linearisation",
      [](nb::handle system, const nb::kwargs& options) {
        const Simulation run = builder_of(system, options).simulation;
        const Away free;
        return hamel::linearisation(registry(), run);
      },
      "system"_a, "options"_a,
      nb::sig("def linearisation(system: _System, **options: typing.Any) -> Linearisation"),
      "About the steady motion near the start of a run; its inputs are zero. ConfigError where "
      "there is none.");
}

}  // namespace hamel::python
