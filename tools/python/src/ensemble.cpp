// Many runs from one file: hamel.ensemble.
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "long_call.hpp"

namespace hamel::python {
namespace {

Shard shard_of(nb::handle given) {
  if (given.is_none()) return {};
  const auto [index, count] = nb::cast<std::pair<long, long>>(given);
  return {index, count};
}

// The number that a function gives; an exception in one line, as failures of members are listed.
template <class Argument>
double number_of(const Function& function, const Argument& argument) {
  try {
    return nb::cast<double>(function(argument));
  } catch (const nb::python_error& error) {
    const std::string type = nb::cast<std::string>(error.type().attr("__name__"));
    throw std::runtime_error(type + ": " + nb::cast<std::string>(nb::str(error.value())));
  } catch (const nb::cast_error&) {
    throw std::runtime_error("a function returned no number");
  }
}

// Variation: a number from the index.
std::function<double(long)> varied_by(const Function& function) {
  return [function](long member) {
    const Entered python;
    return number_of(function, member);
  };
}

// Kept quantity: a number from the state at the end.
std::function<double(Run&)> kept_by(const Function& function) {
  auto names = std::make_shared<std::shared_ptr<const StateNames>>();  // under Python's lock
  return [function, names](Run& run) {
    const Snapshot& state = run.state();
    const Entered python;
    if (*names == nullptr) *names = std::make_shared<const StateNames>(run.system());
    return number_of(function, NamedState{state, *names});
  };
}

// A file, its text, or a dict of the same keys; its system may be a text, a SystemText or a
// Mechanism. A Mechanism alone has its keys as options.
EnsembleConfig config_of(nb::handle file, const nb::kwargs& options) {
  nb::dict table;
  if (nb::isinstance<nb::dict>(file)) {
    table = nb::steal<nb::dict>(PyDict_Copy(file.ptr()));
  } else if (nb::isinstance<ByParts>(file)) {
    table["system"] = nb::borrow(file);
  } else {
    if (options.size() > 0)
      throw ConfigError(
          {"ensemble: keys beside a file: expected them in it, or a dict or a "
           "Mechanism in its place"});
    const std::string given = text("file", file);
    return given.find('\n') == std::string::npos
               ? read_ensemble(given, registry())
               : parse_ensemble(given, "ensemble.toml", registry());
  }
  for (const auto& [key, value] : options) table[key] = value;
  SystemText system;
  std::function<SystemModel(const Parameters&)> model;
  if (table.contains("system") && nb::isinstance<ByParts>(table["system"])) {
    const auto& parts = nb::cast<const ByParts&>(table["system"]);
    model = maker(parts);
    table["system"] = parts.name();
  } else if (table.contains("system")) {
    system = system_text("system", table["system"]);
    if (!system.toml.empty()) table["system"] = system.name;
  }
  return parse_ensemble(nb::cast<std::string>(helper("_toml", "dumps")(table)), "ensemble",
                        registry(), system.toml, std::move(model));
}

EnsembleResult ensemble(nb::handle file, int threads, nb::handle folder, nb::handle shard,
                        bool merge, bool fresh, nb::object progress, const nb::dict& vary_by,
                        const nb::dict& keep_by, const nb::kwargs& options) {
  EnsembleConfig config = config_of(file, options);
  Functions functions;
  for (const auto& [name, function] : vary_by)
    config.vary_by(nb::cast<std::string>(name), varied_by(functions.add(function)));
  for (const auto& [name, function] : keep_by)
    config.keep_by(nb::cast<std::string>(name), kept_by(functions.add(function)));
  Ensemble out(registry(), std::move(config));
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
  nb::class_<EnsembleResult> result(
      m, "EnsembleResult",
      "What was kept of the members: one row for each, result['end.omega']; "
      "true where all are done.");
  result.def("__bool__", [](const EnsembleResult& r) { return r.complete; })
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
          "write_page",
          [](const EnsembleResult& r, nb::handle path) {
            write_page(registry(), r, text("path", path));
          },
          "path"_a, nb::sig("def write_page(self, path: str | os.PathLike[str]) -> None"),
          "The page of hamel ensemble, one HTML file that a browser opens from disk. A member of "
          "each class is run again, for its motion.")
      .def(
          "to_pandas", [](nb::handle self) { return helper("_frames", "table_to_pandas")(self); },
          nb::sig("def to_pandas(self) -> pandas.DataFrame"), "A row for each member.")
      .def("__repr__", [](const EnsembleResult& r) {
        return "<hamel.EnsembleResult of " + std::to_string(r.table.rows()) + " members" +
               (r.complete ? "" : ", stopped") + ">";
      });
  bind_figures(result, "html_of_ensemble",
               "Each kept number over the varied ones, its distribution and its moments in time.",
               [](const EnsembleResult& r) { return figures::of_ensemble(r); });
  m.def(
      "ensemble", &ensemble, "file"_a, nb::kw_only(), "threads"_a = 0, "folder"_a = nb::none(),
      "shard"_a = nb::none(), "merge"_a = false, "fresh"_a = false, "progress"_a = nb::none(),
      "vary_by"_a = nb::dict(), "keep_by"_a = nb::dict(), "options"_a,
      nb::keep_alive<0, 1>(),  // a page runs members again: with the functions of a Mechanism
      nb::sig("def ensemble(file: str | os.PathLike[str] | dict[str, typing.Any] | Mechanism, *, "
              "threads: int = 0, "
              "folder: str | "
              "os.PathLike[str] | None = None, shard: tuple[int, int] | None = None, merge: bool "
              "= False, fresh: bool = False, progress: collections.abc.Callable[[float], object] "
              "| bool | None = None, vary_by: dict[str, collections.abc.Callable[[int], float]] = "
              "{}, keep_by: dict[str, collections.abc.Callable[[State], float]] = {}, **options: "
              "typing.Any) -> EnsembleResult"),
      "The members of an ensemble's file (or of its text), as `hamel ensemble` runs them; or of a "
      "dict of its keys, whose system may be a Mechanism; or of a Mechanism with them as options: "
      "until, vary, keep, members, …. A journal cannot have a Mechanism: no folder. threads: "
      "0 is all cores. folder: keeps a journal there and resumes from it. shard=(i, n): the part "
      "i of n, from 1; merge=True joins the parts in the folder. vary_by: names to vary, each by a "
      "function of the member's index; keep_by: further numbers, each a function of the member's "
      "State at the end. They are called from several threads, and depend on nothing else. Ctrl-C "
      "stops it.");
}

}  // namespace hamel::python
