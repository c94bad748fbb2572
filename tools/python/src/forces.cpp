// Drives of a mechanism by parts: motors, forces, springs, prescribed rates, events, the start;
// functions of Python and compiled ones.
#include <cstdint>
#include <span>

#include "bindings.hpp"

namespace hamel::python {
namespace {

// A function of C, "float64(float64, CPointer(float64), CPointer(float64), CPointer(float64))" of
// t, coordinates, velocity and inputs, or "float64(float64)": called without the interpreter.
using Compiled = double (*)(double, const double*, const double*, const double*);
using CompiledOfTime = double (*)(double);

// The class `name` of a module that is loaded; invalid where it is not.
nb::object loaded(const char* module, const char* name) {
  const nb::object found =
      nb::module_::import_("sys").attr("modules").attr("get")(module, nb::none());
  return found.is_none() ? nb::object() : nb::getattr(found, name, nb::none());
}
bool is_a(nb::handle value, const nb::object& type) {
  return type.is_valid() && !type.is_none() && PyObject_IsInstance(value.ptr(), type.ptr()) == 1;
}

// The address of a compiled function of so many pointers behind t: of what numba.cfunc returns, or
// of a function of ctypes, with the types above. An attribute `address` alone is a number that
// anything may have. 0 for others.
std::uintptr_t address_of(const std::string& name, nb::handle value, size_t pointers) {
  std::string expected = "float64(float64";
  for (size_t i = 0; i < pointers; ++i) expected += ", CPointer(float64)";
  expected += ")";
  if (is_a(value, loaded("numba.core.ccallback", "CFunc"))) {
    std::string signature = "(float64";
    for (size_t i = 0; i < pointers; ++i) signature += ", float64*";
    const std::string got = utf8(name, nb::str(value.attr("_sig")));
    if (got == signature + ") -> float64") return nb::cast<std::uintptr_t>(value.attr("address"));
    throw ConfigError({name + ": a numba.cfunc of " + got + ", expected " + expected});
  }
  if (!is_a(value, loaded("_ctypes", "CFuncPtr"))) return 0;
  const nb::module_ ctypes = nb::module_::import_("ctypes");
  const nb::object real = ctypes.attr("c_double"), pointer = ctypes.attr("POINTER")(real);
  const nb::object none = nb::none(), types = value.attr("argtypes");
  bool fits = value.attr("restype").is(real) && !types.is_none() && nb::len(types) == 1 + pointers;
  for (size_t i = 0; fits && i < 1 + pointers; ++i) {
    const nb::object type = types[i];
    fits = i == 0 ? type.is(real) : type.is(pointer) || type.is(ctypes.attr("c_void_p"));
  }
  if (!fits)
    throw ConfigError({name + ": a function of ctypes of other types, expected " + expected});
  return nb::cast<std::uintptr_t>(
      ctypes.attr("cast")(value, ctypes.attr("c_void_p")).attr("value"));
}

std::vector<double> copied(std::span<const double> values) {
  return {values.begin(), values.end()};
}

// A number, a compiled function, or one of Python: f(t, coordinates, velocity, inputs).
Signal signal(const std::string& name, nb::handle value, Functions& functions) {
  if (const std::uintptr_t address = address_of(name, value, 3); address != 0) {
    const auto compiled = reinterpret_cast<Compiled>(address);
    return [compiled, alive = functions.add(value)](const SignalInput& in) {
      (void)alive.object();
      return compiled(in.t, in.coordinates.data(), in.velocity.data(), in.inputs.data());
    };
  }
  if (PyCallable_Check(value.ptr()) == 0) {
    const double constant = number(name, value);
    return [constant](const SignalInput&) { return constant; };
  }
  return [name, function = functions.add(value)](const SignalInput& in) {
    const Entered python;
    return number(name,
                  function(in.t, copied(in.coordinates), copied(in.velocity), copied(in.inputs)));
  };
}

std::function<double(double)> of_time(const std::string& name, nb::handle value,
                                      Functions& functions) {
  if (value.is_none()) return {};
  if (const std::uintptr_t address = address_of(name, value, 0); address != 0) {
    return [compiled = reinterpret_cast<CompiledOfTime>(address),
            alive = functions.add(value)](double t) {
      (void)alive.object();
      return compiled(t);
    };
  }
  return [name, function = functions.add(value)](double t) {
    const Entered python;
    return number(name, function(t));
  };
}

Range range(std::optional<double> least, std::optional<double> most) {
  Range out;
  if (least) out.least = *least;
  if (most) out.most = *most;
  return out;
}

}  // namespace

void bind_forces(nb::class_<ByParts>& mechanism) {
  mechanism
      .def(
          "prescribe",
          [](ByParts& self, const std::string& joint, nb::handle rate, nb::handle angle,
             nb::handle slope, std::optional<double> least, std::optional<double> most) {
            if (rate.is_none()) self.prescribe(joint, range(least, most));
            else if (PyCallable_Check(rate.ptr()) != 0)
              self.prescribe(joint, of_time("rate", rate, self.functions),
                             of_time("angle", angle, self.functions),
                             of_time("slope", slope, self.functions));
            else
              self.prescribe(joint, number("rate", rate), of_time("angle", angle, self.functions));
          },
          "joint"_a, "rate"_a = nb::none(), nb::kw_only(), "angle"_a = nb::none(),
          "slope"_a = nb::none(), "least"_a = nb::none(), "most"_a = nb::none(),
          nb::sig(
              "def prescribe(self, joint: str, rate: float | _OfTime | None = None, *, angle: "
              "_OfTime | None = None, slope: _OfTime | None = None, least: float | None = None, "
              "most: float | None = None) -> None"),
          "The rate of a hinge or slider: a function of t, a constant, or (without one) an input "
          "of the run, 'steer.rate', between least and most.")
      .def(
          "ground_height",
          [](ByParts& self, const std::string& formula, const Parameters& constants) {
            self.ground_height(formula, constants);
          },
          "formula"_a, nb::kw_only(), "constants"_a = Parameters(),
          "The ground at rest is z = height(x, y), a formula; constants: names that it may use.")
      .def(
          "ground",
          [](ByParts& self, double rate, const Point& velocity) { self.ground(rate, velocity); },
          "rate"_a, "velocity"_a = kOrigin,
          "The ground turns about the origin [rad/s] and moves [m/s].")
      .def(
          "redundant", [](ByParts& self, const std::string& policy) { self.redundant(policy); },
          "policy"_a, "'refuse', or 'drop': what becomes of rows that repeat others.")
      .def(
          "distribution",
          [](ByParts& self, const std::string& policy) { self.distribution(policy); }, "policy"_a,
          "'equal_compliance', 'stated' (by the share of each contact) or 'refuse': loads of "
          "contacts that statics and the motion leave open.")
      .def(
          "gravity", [](ByParts& self, const Point& acceleration) { self.gravity(acceleration); },
          "acceleration"_a, "[m/s^2], three numbers")
      .def(
          "spring",
          [](ByParts& self, const std::string& name, const std::string& a, const std::string& b,
             const Point& from, const Point& to, double stiffness, std::optional<double> rest,
             double damping) {
            self.spring(name, a, b, {from, to, stiffness, rest, damping});
          },
          "name"_a, "a"_a, "b"_a, nb::kw_only(), "from_"_a = kOrigin, "to"_a = kOrigin,
          "stiffness"_a = 0.0, "rest"_a = nb::none(), "damping"_a = 0.0,
          "Between two points [m] as drawn; stiffness [N/m], rest [m] (left out: as drawn).")
      .def(
          "motor",
          [](ByParts& self, const std::string& joint, nb::handle effort, bool time_dependent,
             std::optional<double> least, std::optional<double> most) {
            if (effort.is_none()) self.motor(joint, range(least, most));
            else self.motor(joint, signal("effort", effort, self.functions), time_dependent);
          },
          "joint"_a, "effort"_a = nb::none(), nb::kw_only(), "time_dependent"_a = true,
          "least"_a = nb::none(), "most"_a = nb::none(),
          nb::sig("def motor(self, joint: str, effort: _SignalFunction | float | None = None, *, "
                  "time_dependent: bool = True, least: float | None = None, most: float | None = "
                  "None) -> None"),
          "A torque [N m] or force [N] in a joint: a function f(t, coordinates, velocity, inputs) "
          "of Python or of numba.cfunc, or (without one) an input of the run, 'steer.torque'.")
      .def(
          "brake",
          [](ByParts& self, const std::string& joint, double least, std::optional<double> most) {
            self.brake(joint, range(least, most));
          },
          "joint"_a, nb::kw_only(), "least"_a = 0.0, "most"_a = nb::none(),
          "Dry friction in a hinge or slider up to an input of the run, 'rear.brake' [N m or N].")
      .def(
          "force",
          [](ByParts& self, const std::string& name, const std::string& body, nb::sequence along,
             const Point& at, bool of_body, bool time_dependent) {
            if (nb::len(along) != 3)
              throw ConfigError({"force '" + name + "': along has " +
                                 std::to_string(nb::len(along)) + " entries, expected 3"});
            self.force(name, body,
                       {at,
                        {signal("along", along[0], self.functions),
                         signal("along", along[1], self.functions),
                         signal("along", along[2], self.functions)},
                        of_body,
                        time_dependent});
          },
          "name"_a, "body"_a, "along"_a, nb::kw_only(), "at"_a = kOrigin, "of_body"_a = false,
          "time_dependent"_a = true,
          nb::sig("def force(self, name: str, body: str, along: "
                  "collections.abc.Sequence[_SignalFunction | float], "
                  "*, at: _Point = (0, 0, 0), of_body: bool = False, time_dependent: bool = True) "
                  "-> None"),
          "Three components [N], numbers or functions, of the world or of the body as drawn.")
      .def(
          "torque",
          [](ByParts& self, const std::string& name, const std::string& body, nb::sequence along,
             bool of_body, bool time_dependent) {
            if (nb::len(along) != 3)
              throw ConfigError({"torque '" + name + "': along has " +
                                 std::to_string(nb::len(along)) + " entries, expected 3"});
            self.torque(name, body,
                        {{signal("along", along[0], self.functions),
                          signal("along", along[1], self.functions),
                          signal("along", along[2], self.functions)},
                         of_body,
                         time_dependent});
          },
          "name"_a, "body"_a, "along"_a, nb::kw_only(), "of_body"_a = false,
          "time_dependent"_a = true,
          nb::sig("def torque(self, name: str, body: str, along: "
                  "collections.abc.Sequence[_SignalFunction | float], "
                  "*, of_body: bool = False, time_dependent: bool = True) -> None"),
          "A couple on a body, three components [N m] as of a force.")
      .def(
          "input",
          [](ByParts& self, const std::string& name, const std::string& unit,
             const std::string& meaning, std::optional<double> least, std::optional<double> most) {
            self.input({name, unit, meaning, range(least, most)});
          },
          "name"_a, "unit"_a = "", "meaning"_a = "", nb::kw_only(), "least"_a = nb::none(),
          "most"_a = nb::none(), "An input of the run that signals may use.")
      .def(
          "event",
          [](ByParts& self, const std::string& name, nb::callable value, int direction,
             const std::string& meaning) {
            self.event({name, meaning, direction,
                        [name, function = self.functions.add(value)](
                            double t, std::span<const double> coordinates,
                            std::span<const double> velocity) {
                          const Entered python;
                          return number(name, function(t, copied(coordinates), copied(velocity)));
                        }});
          },
          "name"_a, "value"_a, nb::kw_only(), "direction"_a = 0, "meaning"_a = "",
          nb::sig("def event(self, name: str, value: collections.abc.Callable[[float, list[float], "
                  "list[float]], "
                  "float], *, direction: int = 0, meaning: str = '') -> None"),
          "An event of a run, where value(t, coordinates, velocity) is zero; direction +1, -1, or "
          "0 for both ways.")
      .def(
          "sensor",
          [](ByParts& self, const std::string& name, const std::string& body, const Point& at) {
            self.sensor(name, body, at);
          },
          "name"_a, "body"_a, nb::kw_only(), "at"_a = kOrigin,
          "A point of a body whose place, velocity, yaw, acceleration and path are columns of "
          "every "
          "run: tip.x, tip.vz, tip.ax, tip.path.")
      .def(
          "state",
          [](ByParts& self, const std::string& name, const std::string& rate,
             const std::string& unit, const Parameters& constants) {
            self.state(name, {rate, unit, constants});
          },
          "name"_a, "rate"_a, nb::kw_only(), "unit"_a = "1", "constants"_a = Parameters(),
          "A scalar whose rate is a formula linear in velocities, with coefficients of coordinates "
          "and states.")
      .def(
          "output",
          [](ByParts& self, const std::string& name, const std::string& formula,
             const std::string& unit, const std::string& meaning) {
            self.output(name, formula, {unit, meaning});
          },
          "name"_a, "formula"_a, nb::kw_only(), "unit"_a = "", "meaning"_a = "",
          "A column of every run by a formula of other columns: 'hypot(tip.vx, tip.vy)'.")
      .def(
          "start",
          [](ByParts& self, const std::map<std::string, double>& values, const nb::kwargs& more) {
            std::map<std::string, double> all = values;
            for (const auto& [key, value] : more) all[key_of(key)] = number(key_of(key), value);
            self.start(all);
          },
          "values"_a = std::map<std::string, double>(), "more"_a,
          nb::sig("def start(self, values: collections.abc.Mapping[str, float] = {}, **more: "
                  "float) -> None"),
          "Coordinates and velocities by name, and 'speed'; the others follow from the rows.")
      .def(
          "push",
          [](ByParts& self, const std::string& name, double value) { self.push(name, value); },
          "name"_a, "value"_a, "A velocity beside the speed of a run that starts at one.");
}

}  // namespace hamel::python
