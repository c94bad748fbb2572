// Mechanisms by parts, hamel.Mechanism, with the parts and options of C++ as keywords.
#include <limits>

#include "bindings.hpp"

namespace hamel::python {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<double> given(const char* name, nb::handle value) {
  return value.is_none() ? std::vector<double>() : numbers(name, value);
}

Parameters parameters(const nb::kwargs& values) {
  Parameters out;
  for (const auto& [key, value] : values) {
    const auto name = key_of(key);
    out[name] = numbers(name, value);
  }
  return out;
}

// The arguments that all joints have.
JointOptions joint_options(const Point& at, const Point& axis, const Point& axis2, double stiffness,
                           double rest, double damping, const nb::kwargs& values = {}) {
  return {at,
          axis,
          axis2,
          stiffness,
          rest,
          damping,
          values.is_valid() ? parameters(values) : Parameters()};
}

constexpr Point kUp = {0, 0, 1}, kLeft = {0, 1, 0}, kAhead = {1, 0, 0};

void bind_joints(nb::class_<ByParts>& mechanism) {
  using Root = void (Mechanism::*)(const std::string&, const std::string&, const JointOptions&);
  const auto root = [&](const char* name, Root member, const char* help) {
    mechanism.def(
        name,
        [member](ByParts& self, const std::string& joint, const std::string& child, const Point& at,
                 const Point& axis) {
          (self.*member)(joint, child, joint_options(at, axis, kLeft, 0, 0, 0));
        },
        "name"_a, "child"_a, nb::kw_only(), "at"_a = kOrigin, "axis"_a = kUp, help);
  };
  root("free", &Mechanism::free, "The child moves freely in space.");
  root("planar", &Mechanism::planar, "The child moves in a plane.");
  using Between = void (Mechanism::*)(const std::string&, const std::string&, const std::string&,
                                      const JointOptions&);
  const auto between = [&](const char* name, Between member, const char* help) {
    mechanism.def(
        name,
        [member](ByParts& self, const std::string& joint, const std::string& parent,
                 const std::string& child, const Point& at, const Point& axis, const Point& axis2,
                 double stiffness, double rest, double damping, std::optional<double> friction,
                 std::optional<double> restitution, const std::vector<double>& stop) {
          JointOptions options = joint_options(at, axis, axis2, stiffness, rest, damping);
          options.friction = friction;
          options.restitution = restitution;
          options.stop = stop;
          (self.*member)(joint, parent, child, options);
        },
        "name"_a, "parent"_a, "child"_a, nb::kw_only(), "at"_a = kOrigin, "axis"_a = kUp,
        "axis2"_a = kLeft, "stiffness"_a = 0.0, "rest"_a = 0.0, "damping"_a = 0.0,
        "friction"_a = nb::none(), "restitution"_a = nb::none(), "stop"_a = std::vector<double>(),
        help);
  };
  between("hinge", &Mechanism::hinge,
          "Turns about an axis through a point [m]; stiffness [N m/rad], rest [rad], damping "
          "[N m s/rad]; dry friction [N m]; stop: low, high [rad], with restitution.");
  between("slider", &Mechanism::slider,
          "Slides along an axis; stiffness [N/m], rest [m], damping [N s/m]; dry friction [N]; "
          "stop: low, high [m], with restitution.");
  between("ball_joint", &Mechanism::ball_joint, "Turns about a point.");
  between("universal", &Mechanism::universal,
          "Two hinges, axis on the parent and axis2 on the child, that meet at a point.");
  mechanism
      .def(
          "weld",
          [](ByParts& self, const std::string& name, const std::string& parent,
             const std::string& child) { self.weld(name, parent, child); },
          "name"_a, "parent"_a, "child"_a, "The child is fixed.")
      .def(
          "joint",
          [](ByParts& self, const std::string& kind, const std::string& name,
             const std::string& parent, const std::string& child, const Point& at,
             const Point& axis, const Point& axis2, double stiffness, double rest, double damping,
             const nb::kwargs& values) {
            self.joint(kind, name, parent, child,
                       joint_options(at, axis, axis2, stiffness, rest, damping, values));
          },
          "kind"_a, "name"_a, "parent"_a, "child"_a, nb::kw_only(), "at"_a = kOrigin,
          "axis"_a = kUp, "axis2"_a = kLeft, "stiffness"_a = 0.0, "rest"_a = 0.0, "damping"_a = 0.0,
          "values"_a,
          nb::sig(
              "def joint(self, kind: str, name: str, parent: str, child: str, *, at: _Point = "
              "(0, 0, 0), axis: _Point = (0, 0, 1), axis2: _Point = (0, 1, 0), stiffness: float "
              "= 0, rest: float = 0, damping: float = 0, **values: _Numbers) -> None"),
          "By the name of its kind; values: what this kind has beside them.");
}

using Maybe = std::optional<double>;

void bind_contacts(nb::class_<ByParts>& mechanism) {
  using Rolls = void (Mechanism::*)(const std::string&, const std::string&, const WheelOptions&);
  const auto rolls = [&](const char* name, Rolls member, const char* help) {
    mechanism.def(
        name,
        [member](ByParts& self, const std::string& contact, const std::string& body,
                 const Point& at, const Point& axle, double radius, double angle, Maybe friction,
                 Maybe restitution, Maybe load, std::optional<bool> unilateral,
                 Maybe static_friction, Maybe tangential_restitution, Maybe share,
                 const std::string& on, const std::string& inside) {
          (self.*member)(contact, body,
                         {at, axle, radius, angle, friction, restitution, load, unilateral,
                          static_friction, tangential_restitution, share, on, inside});
        },
        "name"_a, "body"_a, nb::kw_only(), "at"_a = kOrigin, "axle"_a = kLeft, "radius"_a = 0.0,
        "angle"_a = 0.0, "friction"_a = nb::none(), "restitution"_a = nb::none(),
        "load"_a = nb::none(), "unilateral"_a = nb::none(), "static_friction"_a = nb::none(),
        "tangential_restitution"_a = nb::none(), "share"_a = nb::none(), "on"_a = "",
        "inside"_a = "", help);
  };
  rolls("wheel", &Mechanism::wheel, "at: its centre [m]; axle to the left; radius [m].");
  rolls("roller", &Mechanism::roller, "A wheel with rollers at an angle [rad] to its plane.");
  rolls("ball", &Mechanism::ball,
        "A ball that rolls on the ground, or on or inside the sphere or cylinder of a body.");
  mechanism
      .def(
          "blade",
          [](ByParts& self, const std::string& name, const std::string& body, const Point& at,
             const Point& along, Maybe friction, Maybe restitution, Maybe load,
             std::optional<bool> unilateral, Maybe static_friction, Maybe tangential_restitution,
             Maybe share) {
            self.blade(name, body,
                       {at, along, friction, restitution, load, unilateral, static_friction,
                        tangential_restitution, share});
          },
          "name"_a, "body"_a, nb::kw_only(), "at"_a = kOrigin, "along"_a = kAhead,
          "friction"_a = nb::none(), "restitution"_a = nb::none(), "load"_a = nb::none(),
          "unilateral"_a = nb::none(), "static_friction"_a = nb::none(),
          "tangential_restitution"_a = nb::none(), "share"_a = nb::none(),
          "Slides along a direction, not across it; with friction also across.")
      .def(
          "point",
          [](ByParts& self, const std::string& name, const std::string& body, const Point& at,
             Maybe friction, Maybe restitution, Maybe load, std::optional<bool> unilateral,
             Maybe static_friction, Maybe tangential_restitution, Maybe share) {
            self.point(name, body,
                       {at, friction, restitution, load, unilateral, static_friction,
                        tangential_restitution, share});
          },
          "name"_a, "body"_a, nb::kw_only(), "at"_a = kOrigin, "friction"_a = nb::none(),
          "restitution"_a = nb::none(), "load"_a = nb::none(), "unilateral"_a = nb::none(),
          "static_friction"_a = nb::none(), "tangential_restitution"_a = nb::none(),
          "share"_a = nb::none(),
          "A point of a body on the ground, or above it with friction on a free root.")
      .def(
          "wall",
          [](ByParts& self, const std::string& name, const std::string& distance,
             double restitution, const std::optional<double>& friction, const std::string& slip) {
            self.wall(name, {distance, restitution, {}, friction, slip});
          },
          "name"_a, nb::kw_only(), "distance"_a, "restitution"_a = 0.0, "friction"_a = nb::none(),
          "slip"_a = "",
          "What joint coordinates run against: distance, a formula of them, is not negative; with "
          "friction slip is the velocity along it, linear in rates.")
      .def(
          "contact",
          [](ByParts& self, const std::string& kind, const std::string& name,
             const std::string& body, const Point& at, const nb::kwargs& values) {
            self.contact(kind, name, body, {at, parameters(values)});
          },
          "kind"_a, "name"_a, "body"_a, nb::kw_only(), "at"_a = kOrigin, "values"_a,
          nb::sig("def contact(self, kind: str, name: str, body: str, *, at: _Point = (0, 0, 0), "
                  "**values: _Numbers) -> None"),
          "By the name of its kind; values: its fields.")
      .def(
          "loop",
          [](ByParts& self, const std::string& name, const std::string& a, const std::string& b,
             const Point& at, const Point& axis) {
            self.loop(name, a, b, {at, axis});
          },
          "name"_a, "a"_a, "b"_a, nb::kw_only(), "at"_a = kOrigin, "axis"_a = kOrigin,
          "A joint that closes a chain; axis of a hinge, 0 of a ball joint.")
      .def(
          "coupling",
          [](ByParts& self, const std::string& name, const std::string& joint,
             const std::string& to, double ratio, double offset, const std::string& formula,
             const std::string& rates) {
            self.coupling(name, {joint, to, ratio, offset, formula, rates, {}});
          },
          "name"_a, nb::kw_only(), "joint"_a = "", "to"_a = "", "ratio"_a = 1.0, "offset"_a = 0.0,
          "formula"_a = "", "rates"_a = "",
          "joint = ratio * to + offset (a gear); or a formula of joint coordinates, or one of "
          "rates that is linear in them, which is 0.")
      .def(
          "hold",
          [](ByParts& self, const std::string& joint, std::optional<double> at) {
            if (at) self.hold(joint, *at);
            else self.hold(joint);
          },
          "joint"_a, "at"_a = nb::none(),
          "Locks a hinge or slider where a run starts, or at an angle [rad] or position [m].");
}

void bind_text(nb::module_& m) {
  nb::class_<SystemText>(m, "SystemText",
                         "A system by data, or a mechanism, as TOML: formulas of names, no "
                         "compiler. Wherever a system is expected; pickles.")
      .def(
          "__init__",
          [](SystemText* self, const std::string& toml, const std::string& name) {
            new (self) SystemText{toml, name};
          },
          "toml"_a, "name"_a = "system.toml")
      .def_ro("toml", &SystemText::toml)
      .def_ro("name", &SystemText::name, "in messages and records")
      .def(
          "describe",
          [](const SystemText& self) { return described(simulate_text(self.toml, self.name)); },
          "What is stated about the system; ConfigError with line and column.")
      .def(
          "equations",
          [](const SystemText& self) { return Equations(simulate_text(self.toml, self.name)); },
          "Its equations of motion.")
      .def("__getstate__",
           [](const SystemText& self) { return nb::make_tuple(self.toml, self.name); })
      .def("__setstate__",
           [](SystemText& self, const std::pair<std::string, std::string>& state) {
             new (&self) SystemText{state.first, state.second};
           })
      .def("__repr__",
           [](const SystemText& self) { return "<hamel.SystemText " + self.name + ">"; });
}

}  // namespace

ModelDescription described(const Simulation& simulation) {
  return describe_model(simulation.build().system());
}

void bind_mechanism(nb::module_& m) {
  bind_text(m);
  nb::class_<ByParts> mechanism(
      m, "Mechanism",
      "Bodies, joints, wheels, blades and balls put together; nothing is derived by hand. Points "
      "[m] and directions are those of one pose as drawn: x ahead, z up, the ground z = 0. Names "
      "are checked when it is used, all mistakes at once. The world is 'ground'.",
      nb::type_slots(Collected<ByParts>::slots));
  mechanism.def(nb::init<std::string>(), "name"_a)
      .def_prop_ro("name", [](const ByParts& self) { return self.name(); })
      .def(
          "body",
          [](ByParts& self, const std::string& name, double mass, const Point& at,
             nb::handle inertia, const Point& box, nb::handle cylinder, double sphere,
             const Point& axis) {
            return self.body(name, {mass, at, given("inertia", inertia), box,
                                    given("cylinder", cylinder), sphere, axis});
          },
          "name"_a, nb::kw_only(), "mass"_a = kNan, "at"_a = kOrigin, "inertia"_a = nb::none(),
          "box"_a = kOrigin, "cylinder"_a = nb::none(), "sphere"_a = 0.0, "axis"_a = kUp,
          nb::sig(
              "def body(self, name: str, *, mass: float, at: _Point = (0, 0, 0), inertia: "
              "_Numbers | None = None, box: _Point = (0, 0, 0), cylinder: _Numbers | None = None, "
              "sphere: float = 0, axis: _Point = (0, 0, 1)) -> str"),
          "mass [kg], at: its mass centre [m]; inertia: 3, 6 or 9 numbers [kg m^2], or that of a "
          "shape: box (edges), cylinder (radius, length, about axis), sphere (radius). Returns "
          "the name.");
  bind_joints(mechanism);
  bind_contacts(mechanism);
  bind_forces(mechanism);
  mechanism
      .def_static(
          "from_toml",
          [](const std::string& toml, const std::string& name) {
            return SystemText{toml, name};
          },
          "toml"_a, "name"_a = "mechanism.toml", "A mechanism in a text.")
      .def_static(
          "from_file",
          [](nb::handle path) {
            const nb::object file = nb::module_::import_("pathlib").attr("Path")(path);
            return SystemText{utf8("path", file.attr("read_text")("encoding"_a = "utf-8")),
                              text("path", path)};
          },
          "path"_a, nb::sig("def from_file(path: str | os.PathLike[str]) -> SystemText"),
          "A mechanism in a file.")
      .def(
          "describe", [](const ByParts& self) { return described(simulate(self)); },
          nb::sig("def describe(self) -> Description"), "What is stated about the system.")
      .def(
          "equations", [](const ByParts& self) { return Equations(simulate(self)); },
          nb::sig("def equations(self) -> Equations"), "Its equations of motion.")
      .def("__repr__", [](const ByParts& self) { return "<hamel.Mechanism " + self.name() + ">"; });
  m.attr("WORLD") = kWorld;
}

}  // namespace hamel::python
