// Many runs from one file: hamel.ensemble.
#include "long_call.hpp"

namespace hamel::python {
namespace {

Shard shard_of(nb::handle given) {
  if (given.is_none()) return {};
  const auto [index, count] = nb::cast<std::pair<long, long>>(given);
  return {index, count};
}

EnsembleResult ensemble(nb::handle file, int threads, nb::handle folder, nb::handle shard,
                        bool merge, bool fresh, nb::object progress) {
  const std::string given = text("file", file);
  Ensemble out(registry(), given.find('\n') == std::string::npos
                               ? read_ensemble(given, registry())
                               : parse_ensemble(given, "ensemble.toml", registry()));
  out.threads(threads).fresh(fresh);
  if (!folder.is_none()) out.folder(text("folder", folder));
  if (!shard.is_none()) out.shard(shard_of(shard));
  return long_call(progress_of(progress),
                   [&](std::atomic<bool>& stop, const std::function<void(double)>& report) {
                     out.stop(&stop).progress(report);
                     return merge ? out.merge() : out.run();
                   });
}

}  // namespace

void bind_ensemble(nb::module_& m) {
  nb::class_<EnsembleResult>(m, "EnsembleResult",
                             "What was kept of the members: one row for each, result['end.omega']; "
                             "true where all are done.")
      .def("__bool__", [](const EnsembleResult& r) { return r.complete; })
      .def("__len__", [](const EnsembleResult& r) { return r.table.rows(); })
      .def(
          "__getitem__",
          [](const EnsembleResult& r, const std::string& name) { return column_of(r.table, name); },
          "name"_a,
          nb::sig("def __getitem__(self, name: str) -> numpy.typing.NDArray[numpy.float64] | "
                  "list[int] | list[str]"),
          "A column: numbers as an array, shape (members,), NaN where a member has no value.")
      .def_prop_ro("columns", [](const EnsembleResult& r) { return columns_of(r.table); })
      .def_prop_ro("units", [](const EnsembleResult& r) { return units_of(r.table); })
      .def_prop_ro(
          "record",
          [](const EnsembleResult& r) {
            return nb::module_::import_("json").attr("loads")(r.record());
          },
          nb::sig("def record(self) -> dict[str, typing.Any]"),
          "The record of `hamel ensemble --json`: statistics, classes, failures.")
      .def_ro("complete", &EnsembleResult::complete)
      .def_ro("notes", &EnsembleResult::notes)
      .def_ro("resumed", &EnsembleResult::resumed, "members taken over from the journal")
      .def_ro("threads", &EnsembleResult::threads)
      .def_ro("seconds", &EnsembleResult::seconds)
      .def(
          "write",
          [](const EnsembleResult& r, nb::handle folder) { r.write(text("folder", folder)); },
          "folder"_a, nb::sig("def write(self, folder: str | os.PathLike[str]) -> None"),
          "ensemble.h5 (where the build has HDF5), ensemble.csv and ensemble.json.")
      .def(
          "to_pandas", [](nb::handle self) { return helper("_frames", "table_to_pandas")(self); },
          nb::sig("def to_pandas(self) -> pandas.DataFrame"), "A row for each member.")
      .def(
          "_repr_html_",
          [](nb::handle self) { return helper("_figures", "html_of_ensemble")(self); },
          nb::sig("def _repr_html_(self) -> str"))
      .def(
          "figures",
          [](nb::handle self) { return helper("_figures", "figures_of_ensemble")(self); },
          nb::sig("def figures(self) -> dict[str, _Figure]"), "A figure for each kept number.")
      .def("__repr__", [](const EnsembleResult& r) {
        return "<hamel.EnsembleResult of " + std::to_string(r.table.rows()) + " members" +
               (r.complete ? "" : ", stopped") + ">";
      });
  m.def(
      "ensemble", &ensemble, "file"_a, nb::kw_only(), "threads"_a = 0, "folder"_a = nb::none(),
      "shard"_a = nb::none(), "merge"_a = false, "fresh"_a = false, "progress"_a = nb::none(),
      nb::sig("def ensemble(file: str | os.PathLike[str], *, threads: int = 0, folder: str | "
              "os.PathLike[str] | None = None, shard: tuple[int, int] | None = None, merge: bool "
              "= False, fresh: bool = False, progress: collections.abc.Callable[[float], object] "
              "| bool | None = None) -> EnsembleResult"),
      "The members of an ensemble's file (or of its text), as `hamel ensemble` runs them. threads: "
      "0 is all cores. folder: keeps a journal there and resumes from it. shard=(i, n): the part "
      "i of n, from 1; merge=True joins the parts in the folder. Ctrl-C stops it.");
}

}  // namespace hamel::python
