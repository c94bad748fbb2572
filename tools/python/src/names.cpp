// Names and their descriptions: hamel.list and hamel.describe.
#include <hamel/framework/run/names/system_file.hpp>

#include "bindings.hpp"

namespace hamel::python {
namespace {

const char* const kKinds[] = {"groups", "retractions", "schemes", "solvers", "systems"};

std::vector<std::string> names_of(const std::string& kind) {
  if (kind == "groups") return groups();
  if (kind == "retractions") return retractions();
  if (kind == "schemes") return schemes();
  if (kind == "solvers") return solvers();
  if (kind == "systems") return systems();
  throw ConfigError({unknown_name("kind", kind, {std::begin(kKinds), std::end(kKinds)})});
}

ModelDescription describe(nb::handle system) {
  const bool named = nb::isinstance<nb::str>(system);
  const std::string name = named ? utf8("system", system) : "";
  if (!named || names_file(name) || name.find('\n') != std::string::npos)
    return described(builder_of(system).simulation);
  const SystemDescription stated = describe_system(name);  // ConfigError where there is none
  ModelDescription out = described(simulate(name));
  static_cast<SystemDescription&>(out) = stated;
  return out;
}

std::string text_of_description(const ModelDescription& d) {
  std::string out = d.name + " on " + d.group;
  const auto line = [&out](const std::string& title, const std::string& text) {
    if (!text.empty()) out += "\n  " + title + std::string(13 - title.size(), ' ') + text;
  };
  line("summary", d.summary);
  line("formula", d.formula);
  for (const Field& f : d.parameters)
    line("parameter", f.name + " = " + join(f.value) + (f.unit.empty() ? "" : " [" + f.unit + "]") +
                          "  " + f.meaning);
  for (const InputField& f : d.inputs)
    line("input", f.name + (f.unit.empty() ? "" : " [" + f.unit + "]") + "  " + f.meaning);
  line("coordinates", join(d.coordinates));
  line("velocities", join(d.velocities));
  line("events", join(d.events));
  line("known", d.known);
  line("source", d.source);
  return out;
}

}  // namespace

void bind_names(nb::module_& m) {
  nb::class_<Field>(m, "Parameter", "A parameter of a system, as it states it.")
      .def_ro("name", &Field::name)
      .def_ro("value", &Field::value, "the default")
      .def_ro("unit", &Field::unit)
      .def_ro("meaning", &Field::meaning)
      .def_prop_ro(
          "range", [](const Field& f) { return f.range.words(); }, "'' for all numbers")
      .def("__repr__", [](const Field& f) {
        return "<hamel.Parameter " + f.name + " = " + join(f.value) + " [" + f.unit + "]>";
      });
  nb::class_<InputField>(m, "Input", "An input of a system, as it states it.")
      .def_ro("name", &InputField::name)
      .def_ro("unit", &InputField::unit)
      .def_ro("meaning", &InputField::meaning)
      .def_prop_ro("range", [](const InputField& f) { return f.range.words(); })
      .def("__repr__",
           [](const InputField& f) { return "<hamel.Input " + f.name + " [" + f.unit + "]>"; });
  nb::class_<ModelDescription>(m, "Description", "What is stated about a system.")
      .def_ro("name", &ModelDescription::name)
      .def_ro("group", &ModelDescription::group)
      .def_ro("summary", &ModelDescription::summary)
      .def_ro("formula", &ModelDescription::formula)
      .def_ro("known", &ModelDescription::known, "what is known exactly of its motion")
      .def_ro("source", &ModelDescription::source)
      .def_ro("parameters", &ModelDescription::parameters)
      .def_ro("inputs", &ModelDescription::inputs)
      .def_ro("coordinates", &ModelDescription::coordinates, "columns of the element")
      .def_ro("coordinate_units", &ModelDescription::coordinate_units)
      .def_ro("velocities", &ModelDescription::velocities, "components of xi, in order")
      .def_ro("velocity_units", &ModelDescription::velocity_units)
      .def_ro("events", &ModelDescription::events)
      .def_ro("parts", &ModelDescription::parts, "the bodies of a mechanism")
      .def("__str__", &text_of_description)
      .def("__repr__", &text_of_description);
  m.def("names", &names_of, "kind"_a,
        "What there is by name: 'groups', 'retractions', 'schemes', 'solvers' or 'systems'.");
  m.def(
      "names",
      [] {
        std::map<std::string, std::vector<std::string>> out;
        for (const char* kind : kKinds) out[kind] = names_of(kind);
        return out;
      },
      "All kinds with their names.");
  m.def(
      "retractions", [](const std::string& group) { return retractions(group); }, "group"_a = "",
      "Of a group, also of a product 'se2*so2^3'; without one all.");
  m.def("describe", &describe, "system"_a, nb::sig("def describe(system: _System) -> Description"),
        "What is stated about a system: parameters with units, inputs, coordinates, velocities, "
        "events.");
}

}  // namespace hamel::python
