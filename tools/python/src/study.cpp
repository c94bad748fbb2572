// Comparative studies: hamel.study.
#include "long_call.hpp"

namespace hamel::python {
namespace {

std::string word_of(nb::handle value) {
  if (nb::isinstance<nb::str>(value)) return utf8("value of an axis", value);
  return text_of(number("value of an axis", value));
}

StudySystem system_of(nb::handle given) {
  StudySystem out;
  const auto take = [&out](nb::handle system) {
    if (nb::isinstance<ByParts>(system)) {
      const auto& parts = nb::cast<const ByParts&>(system);
      out.name = parts.name();
      out.model = maker(parts);
      return;
    }
    SystemText read = system_text("system", system);
    out.name = std::move(read.name);
    out.data = std::move(read.toml);
  };
  if (!nb::isinstance<nb::dict>(given)) {
    take(given);
    out.label = out.name;
    return out;
  }
  for (const auto& [key, value] : dict("system", given)) {
    const auto name = key_of(key);
    if (name == "label") out.label = text(name, value);
    else if (name == "system" || name == "name") take(value);
    else if (name == "configuration") out.start.configuration = numbers(name, value);
    else if (name == "velocity") out.start.velocity = numbers(name, value);
    else if (name == "momentum") out.start.momentum = numbers(name, value);
    else if (name == "parameters") {
      for (const auto& [parameter, number] : dict(name, value))
        out.parameters[key_of(parameter)] = numbers(name, number);
    } else if (name == "inputs") {
      for (const auto& [input, signal] : dict(name, value))
        out.inputs[key_of(input)] = signal_of(name, signal);
    } else {
      throw ConfigError({unknown_name(
          "key of a system", name,
          {"label", "system", "parameters", "inputs", "configuration", "velocity", "momentum"})});
    }
  }
  if (out.label.empty()) out.label = out.name;
  return out;
}

// A list of systems or of values, and not one of them.
bool has_several(nb::handle value) {
  return !nb::isinstance<nb::str>(value) && !nb::isinstance<nb::dict>(value) &&
         nb::hasattr(value, "__iter__");
}

// A file, a text of one, or none: then keywords alone, or a dict of them.
StudyConfig study_of(nb::handle file, const nb::dict& options) {
  StudyConfig config;
  if (nb::isinstance<nb::dict>(file)) {
    config = study_of(nb::none(), nb::borrow<nb::dict>(file));
  } else if (nb::isinstance<ByParts>(file)) {
    config.systems.push_back(system_of(file));
  } else if (!file.is_none()) {
    const std::string given = text("file", file);
    config = given.find('\n') == std::string::npos ? read_study(given, registry())
                                                   : parse_study(given, "study.toml", registry());
  }
  for (const auto& [key, value] : options) {
    const auto name = key_of(key);
    if (name == "title") config.title = text(name, value);
    else if (name == "until") config.until = number(name, value);
    else if (name == "repeats") config.repeats = static_cast<int>(number(name, value));
    else if (name == "zipped") config.zipped = nb::cast<bool>(value);
    else if (name == "reference") config.reference = nb::cast<bool>(value);
    else if (name == "system") {
      config.systems.clear();
      if (!has_several(value)) config.systems.push_back(system_of(value));
      else
        for (const nb::handle each : value) config.systems.push_back(system_of(each));
    } else {
      StudyValues& values = config.axes[name];
      values.clear();
      if (!has_several(value)) values.push_back(word_of(value));
      else
        for (const nb::handle each : value) values.push_back(word_of(each));
    }
  }
  return config;
}

StudyResult study(nb::handle file, int threads, nb::handle folder, bool fresh, nb::object progress,
                  const nb::kwargs& options) {
  Study out(registry(), study_of(file, options));
  out.threads(threads).fresh(fresh);
  if (!folder.is_none()) out.folder(text("folder", folder));
  return long_call(progress_of(progress),
                   [&](std::atomic<bool>& stop, const std::function<void(double)>& report) {
                     return out.stop(&stop).progress(report).run();
                   });
}

}  // namespace

void bind_study(nb::module_& m) {
  nb::class_<StudyResult> result(
      m, "StudyResult",
      "What a study measured: one row for each combination, axes and metrics "
      "as columns, study['error']; true where it is complete.");
  result.def("__bool__", [](const StudyResult& r) { return r.complete; })
      .def("__len__", [](const StudyResult& r) { return r.cells.size(); })
      .def(
          "__getitem__",
          [](const StudyResult& r, const std::string& name) { return column_of(r.table(), name); },
          "name"_a,
          nb::sig("def __getitem__(self, name: str) -> numpy.typing.NDArray[numpy.float64] | "
                  "list[int] | list[str]"),
          "A column: numbers as an array, shape (cells,), NaN where nothing was measured.")
      .def_prop_ro("columns", [](const StudyResult& r) { return columns_of(r.table()); })
      .def_prop_ro("units", [](const StudyResult& r) { return units_of(r.table()); })
      .def_prop_ro(
          "record",
          [](const StudyResult& r) {
            return nb::module_::import_("json").attr("loads")(r.record());
          },
          nb::sig("def record(self) -> dict[str, typing.Any]"), "record.json of the study.")
      .def_ro("complete", &StudyResult::complete)
      .def_ro("notes", &StudyResult::notes)
      .def_ro("resumed", &StudyResult::resumed, "cells taken over from the journal")
      .def_ro("threads", &StudyResult::threads)
      .def_ro("seconds", &StudyResult::seconds)
      .def("csv", [](const StudyResult& r) { return r.table().csv(); })
      .def(
          "write", [](const StudyResult& r, nb::handle folder) { r.write(text("folder", folder)); },
          "folder"_a, nb::sig("def write(self, folder: str | os.PathLike[str]) -> None"),
          "cells.csv, record.json and, where the build has HDF5, cells.h5.")
      .def(
          "write_page",
          [](const StudyResult& r, nb::handle path) { write_page(r, text("path", path)); },
          "path"_a, nb::sig("def write_page(self, path: str | os.PathLike[str]) -> None"),
          "The page of hamel study, one HTML file that a browser opens from disk.")
      .def(
          "to_pandas", [](nb::handle self) { return helper("_frames", "table_to_pandas")(self); },
          nb::sig("def to_pandas(self) -> pandas.DataFrame"), "A row for each cell.")
      .def("__repr__", [](const StudyResult& r) {
        return "<hamel.StudyResult of " + std::to_string(r.cells.size()) + " cells" +
               (r.complete ? "" : ", stopped") + ">";
      });
  bind_figures(result, "html_of_study",
               "Work-precision diagrams, the error over the step and the tolerance, heat maps.",
               [](const StudyResult& r) { return figures::of_study(r); });
  m.def("study", &study, "file"_a = nb::none(), nb::kw_only(), "threads"_a = 0,
        "folder"_a = nb::none(), "fresh"_a = false, "progress"_a = nb::none(), "options"_a,
        nb::sig("def study(file: str | os.PathLike[str] | dict[str, typing.Any] | Mechanism | None "
                "= None, *, "
                "threads: int = 0, folder: "
                "str | os.PathLike[str] | None = None, fresh: bool = False, progress: "
                "collections.abc.Callable[[float], object] | bool | None = None, **options: "
                "typing.Any) -> StudyResult"),
        "Every combination of the lists in a file (or its text), measured alike. Without a file, "
        "as a dict, or beside it: system (names, texts, Mechanisms, or dicts of system, label, "
        "parameters, inputs, velocity, …), until [s], repeats, title, zipped, reference, and any "
        "option that a study may vary "
        "with its values: scheme=['lift', 'balance'], step=[0.1, 0.05]. threads: 0 is all cores. "
        "folder: keeps a journal there and resumes from it, but not for a Mechanism, which a "
        "journal cannot have. Ctrl-C stops it.");
}

}  // namespace hamel::python
