// Poincare sections: hamel.section.
#include "long_call.hpp"

namespace hamel::python {
namespace {

std::vector<Start> starts_of(nb::handle given, const Config& config) {
  if (given.is_none()) return {};
  if (nb::isinstance<nb::str>(given) || nb::hasattr(given, "__fspath__"))
    return read_starts(text("starts", given), registry(), config);
  std::vector<Start> out;
  for (const nb::handle one : given) out.push_back(start_of("starts", one));
  return out;
}

Section section(nb::handle system, const std::string& event, long count, int direction,
                nb::handle starts, std::optional<double> energy, std::optional<double> until,
                nb::object progress, const nb::kwargs& options) {
  Builder builder = builder_of(system, options);
  const Config& config = builder.simulation.config();
  const SectionRequest request{.event = event,
                               .direction = direction,
                               .count = count,
                               .starts = starts_of(starts, config),
                               .energy = energy,
                               .longest = until};
  return long_call(progress_of(progress),
                   [&](std::atomic<bool>& stop, const std::function<void(double)>& report) {
                     return hamel::section(builder.simulation, request, report, &stop);
                   });
}

}  // namespace

void bind_section(nb::module_& m) {
  nb::class_<SectionOrbit>(m, "SectionOrbit", "One motion of a section.")
      .def_ro("energy", &SectionOrbit::energy, "at its start, J")
      .def_ro("energy_change", &SectionOrbit::energy_change, "the largest at its points, J")
      .def_ro("found", &SectionOrbit::found, "points")
      .def_ro("time", &SectionOrbit::time, "reached, s")
      .def_ro("reason", &SectionOrbit::reason, "'' where all points were found");
  nb::class_<Section>(m, "Section",
                      "The states in which motions cross an event: one row for each point, "
                      "section['t']; true where all points were found.")
      .def("__bool__", [](const Section& s) { return s.complete; })
      .def("__len__", [](const Section& s) { return s.points.rows(); })
      .def(
          "__getitem__",
          [](const Section& s, const std::string& name) { return column_of(s.points, name); },
          "name"_a,
          nb::sig("def __getitem__(self, name: str) -> numpy.typing.NDArray[numpy.float64] | "
                  "list[int] | list[str]"),
          "A column, shape (points,): start, n, t, those of the element and the velocity, energy.")
      .def_prop_ro("columns", [](const Section& s) { return columns_of(s.points); })
      .def_prop_ro("units", [](const Section& s) { return units_of(s.points); })
      .def_ro("orbits", &Section::orbits)
      .def_ro("complete", &Section::complete)
      .def("csv", [](const Section& s) { return s.points.csv(); })
      .def(
          "to_pandas", [](nb::handle self) { return helper("_frames", "table_to_pandas")(self); },
          nb::sig("def to_pandas(self) -> pandas.DataFrame"), "A row for each point.")
      .def("__repr__", [](const Section& s) {
        return "<hamel.Section of " + std::to_string(s.points.rows()) + " points of " +
               std::to_string(s.orbits.size()) + " motions>";
      });
  m.def(
      "section", &section, "system"_a, "event"_a, "count"_a, nb::kw_only(), "direction"_a = 0,
      "starts"_a = nb::none(), "energy"_a = nb::none(), "until"_a = nb::none(),
      "progress"_a = nb::none(), "options"_a,
      nb::sig("def section(system: _System, event: str, count: int, *, direction: int = 0, starts: "
              "str | os.PathLike[str] | collections.abc.Sequence[dict[str, _Numbers]] | None = "
              "None, energy: float | None = None, until: float | None = None, progress: "
              "collections.abc.Callable[[float], object] | bool | None = None, **options: "
              "typing.Any) -> Section"),
      "The first count states in which the motion crosses an event (a name, or a formula: "
      "'x=0'), where its function grows (direction=1), falls (-1) or both (0). starts: dicts of "
      "configuration and velocity, or a CSV file; energy [J]: every start gets it by a factor of "
      "its velocity; until [s]: gives a start up. Without scheme, step and tolerance: dop853 at "
      "rtol 1e-10. Ctrl-C ends it, with KeyboardInterrupt.");
}

}  // namespace hamel::python
