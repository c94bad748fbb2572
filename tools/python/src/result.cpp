// Result of a run, hamel.Result: its rows as views by name, its record, its pickle.
#include <deque>

#include "bindings.hpp"

namespace hamel::python {
namespace {

std::vector<std::string> split(const std::string& words) {
  std::vector<std::string> out(1);
  for (const char c : words) {
    if (c == ',') out.emplace_back();
    else out.back() += c;
  }
  return out;
}

nb::object loads(const std::string& json) {
  return nb::module_::import_("json").attr("loads")(json);
}

// Rows as they lie in the result, which the array keeps alive.
nb::object view(nb::handle self, size_t first, size_t columns, bool is_vector) {
  const auto& stored = nb::cast<const StoredResult&>(self);
  const Trajectory& rows = stored.read().trajectory;
  const double* data = rows.values().data() + first;
  const auto stride = static_cast<int64_t>(rows.columns().size());
  if (!is_vector) return nb::cast(ReadOnly(data, {rows.rows()}, self, {stride}));
  return nb::cast(ReadOnly(data, {rows.rows(), columns}, self, {stride, 1}));
}

nb::object item(nb::handle self, const std::string& name) {
  const auto& stored = nb::cast<const StoredResult&>(self);
  const auto place = stored.places().find(name);
  if (place != stored.places().end()) {
    const auto [first, columns] = place->second;
    return view(self, first, std::max<size_t>(columns, 1), columns > 0);
  }
  std::vector<std::string> known;
  for (const auto& [key, unused] : stored.places()) known.push_back(key);
  if (known.empty())
    throw nb::key_error((name + ": the rows of this run are in its files").c_str());
  throw nb::key_error(unknown_name("column", name, known).c_str());
}

std::map<std::string, std::string> units_of(const StoredResult& stored) {
  std::map<std::string, std::string> out;
  for (const ColumnGroup& group : stored.read().trajectory.groups()) {
    const auto units = split(group.unit);
    const auto unit = [&](size_t i) { return i < units.size() ? units[i] : units.front(); };
    for (size_t i = 0; i < group.columns.size(); ++i) out[group.columns[i]] = unit(i);
    for (const auto& [name, i] : group.other_names) out.emplace(name, unit(i));
  }
  return out;
}

void bind_measurements(nb::class_<StoredResult>& result) {
  static std::deque<std::string> texts_kept;  // nanobind refers to them
  Measurements::fields([&](const Quantity& quantity, const char* suffix, auto member) {
    texts_kept.push_back(std::string(quantity.name) + suffix);
    const char* name = texts_kept.back().c_str();
    const std::string unit = quantity.unit;
    texts_kept.push_back(std::string(quantity.meaning) + (unit == "1" ? "" : " [" + unit + "]") +
                         "; NaN where it is not measured");
    result.def_prop_ro(
        name, [member](const StoredResult& s) { return s.read().*member; },
        texts_kept.back().c_str());
  });
}

void bind_rows(nb::class_<StoredResult>& result) {
  result
      .def("__getitem__", &item, "name"_a,
           nb::sig("def __getitem__(self, name: str) -> numpy.typing.NDArray[numpy.float64]"),
           "The rows of a column ('R11', 'omega1', 'energy'), shape (rows,), "
           "or of a vector ('configuration', 'xi', 'mu', 'lambda'), shape (rows, n): a read-only "
           "view, nothing is copied.")
      .def("__contains__",
           [](const StoredResult& s, const std::string& name) { return s.places().contains(name); })
      .def(
          "__iter__",
          [](const StoredResult& s) {
            return nb::cast(s.read().trajectory.columns()).attr("__iter__")();
          },
          nb::sig("def __iter__(self) -> collections.abc.Iterator[str]"))
      .def(
          "keys", [](const StoredResult& s) { return s.read().trajectory.columns(); },
          "The columns.")
      .def("__len__", [](const StoredResult& s) { return s.read().trajectory.rows(); })
      .def_prop_ro(
          "t", [](nb::handle self) { return item(self, "t"); },
          nb::sig("def t(self) -> numpy.typing.NDArray[numpy.float64]"),
          "The times of the rows [s], shape (rows,).")
      .def_prop_ro(
          "values",
          [](nb::handle self) {
            const auto& s = nb::cast<const StoredResult&>(self);
            return view(self, 0, s.read().trajectory.columns().size(), true);
          },
          nb::sig("def values(self) -> numpy.typing.NDArray[numpy.float64]"),
          "All rows, shape (rows, columns): a read-only view.")
      .def_prop_ro("columns", [](const StoredResult& s) { return s.read().trajectory.columns(); })
      .def_prop_ro(
          "groups",
          [](const StoredResult& s) {
            std::map<std::string, std::vector<std::string>> out;
            for (const ColumnGroup& g : s.read().trajectory.groups()) out[g.name] = g.columns;
            return out;
          },
          "The columns of each vector or number.")
      .def_prop_ro(
          "names",
          [](const StoredResult& s) {
            for (const ColumnGroup& g : s.read().trajectory.groups())
              if (g.name == "xi") return g.columns;
            return std::vector<std::string>();
          },
          "The columns of the velocities xi1, xi2, …, in their order.")
      .def_prop_ro("units", &units_of, "The unit of each column, '1' or '' of plain numbers.");
}

}  // namespace

const StoredResult::Places& StoredResult::places() const {
  size_t first = 0;
  if (!places_.empty()) return places_;
  for (const ColumnGroup& group : read().trajectory.groups()) {
    const size_t n = group.columns.size();
    const auto add = [&](const std::string& name, size_t i) {
      places_.emplace(name, std::pair(first + i, size_t{0}));
    };
    for (size_t i = 0; i < n; ++i) add(group.columns[i], i);
    if (n != 1 || group.columns.front() != group.name)
      places_.emplace(group.name, std::pair(first, n));
    first += n;
  }
  first = 0;
  for (const ColumnGroup& group : read().trajectory.groups()) {  // behind the names of columns
    for (const auto& [name, i] : group.other_names)
      places_.emplace(name, std::pair(first + i, size_t{0}));
    first += group.columns.size();
  }
  return places_;
}

std::string StoredResult::report_text(Notes length) const {
  if (read().system != nullptr) return read().report(length);
  return length == Notes::brief ? report : verbose_report;
}

std::string StoredResult::record_text() const {
  return read().system == nullptr ? record : read().record();
}

void StoredResult::restore_system() {
  if (read().system != nullptr) return;
  Simulation again =
      source.empty() ? simulate(read().config.system) : simulate_text(source, read().config.system);
  const Result fresh = again.config(read().config).build().finish();
  const size_t columns = fresh.last.coordinates.size(), n = fresh.last.velocity.size();
  const Trajectory& rows = read().trajectory;
  if (read().last.coordinates.size() != columns || read().last.velocity.size() != n ||
      read().last.momentum.size() != n ||
      (rows.rows() > 0 && rows.columns().size() < 1 + columns + n))
    throw ConfigError({"a damaged pickle of a Result: its numbers are not those of the system '" +
                       read().config.system + "'"});
  read().system = fresh.system;
  read().inputs = fresh.inputs;
}

void StoredResult::write(const std::string& path) {
  restore_system();
  read().write(path);
}

nb::object result_of(Result result, std::string source, const Functions& functions) {
  return nb::cast(StoredResult(std::move(result), std::move(source), functions));
}

void bind_result(nb::module_& m) {
  nb::class_<EventMet>(m, "EventMet", "An event that was met, and the state there.")
      .def_ro("name", &EventMet::name)
      .def_ro("time", &EventMet::time, "[s]")
      .def_prop_ro(
          "coordinates", [](const EventMet& e) { return array(e.coordinates); },
          nb::sig("def coordinates(self) -> numpy.typing.NDArray[numpy.float64]"))
      .def_prop_ro(
          "velocity", [](const EventMet& e) { return array(e.velocity); },
          nb::sig("def velocity(self) -> numpy.typing.NDArray[numpy.float64]"))
      .def_prop_ro(
          "velocity_after", [](const EventMet& e) { return array(e.velocity_after); },
          nb::sig("def velocity_after(self) -> numpy.typing.NDArray[numpy.float64]"),
          "Behind a switch of a contact; else empty.")
      .def("__repr__", [](const EventMet& e) {
        return "<hamel.EventMet " + e.name + " at t = " + text_of(e.time) + ">";
      });
  nb::class_<StoredResult> result(
      m, "Result",
      "What a run leaves behind: true where it ended well. result['omega1'] are the rows of a "
      "column or a vector, as a read-only view. A numerical failure is in status; the good steps "
      "are here.",
      nb::type_slots(Collected<StoredResult>::slots));
  bind_rows(result);
  bind_measurements(result);
  const auto member = [](auto Result::*of) {
    return [of](const StoredResult& s) { return s.bare().*of; };
  };
  result.def_prop_ro("status", member(&Result::status))
      .def("__bool__", [](const StoredResult& s) { return s.bare().status.ok; })
      .def_prop_ro("config", member(&Result::config), "As it was run, the start filled in.")
      .def_prop_ro("notes", [](const StoredResult& s) { return s.read().notes; })
      .def_prop_ro("unused", member(&Result::unused), "Options that the scheme makes no use of.")
      .def_prop_ro("steps", member(&Result::steps))
      .def_prop_ro("events", member(&Result::events))
      .def_prop_ro("stopped_by_event", member(&Result::stopped_by_event))
      .def_prop_ro("stats", member(&Result::stats))
      .def_prop_ro("seconds", member(&Result::seconds), "Of the time loop, recording included.")
      .def_prop_ro("recording_seconds", member(&Result::recording_seconds),
                   "Of these, to measure and write states.")
      .def_prop_ro(
          "comparing_seconds", [](const StoredResult& s) { return s.read().comparing_seconds; },
          "Beside them: equations of motion, invariants, exact motion.")
      .def_prop_ro(
          "last",
          [](const StoredResult& s) {
            const auto& system = s.bare().system;
            return NamedState{s.bare().last,
                              system ? std::make_shared<const StateNames>(*system) : nullptr};
          },
          "The last good state.")
      .def_prop_ro(
          "invariants",
          [](const StoredResult& s) {
            std::map<std::string, double> out;
            for (const InvariantDrift& drift : s.read().invariants)
              out[drift.name] = drift.drift_max;
            return out;
          },
          "max |value - start| of each invariant of the exact motion")
      .def_prop_ro(
          "record", [](const StoredResult& s) { return loads(s.record_text()); },
          nb::sig("def record(self) -> dict[str, typing.Any]"),
          "The record, as hamel run --json has it.")
      .def("json", &StoredResult::record_text, "The record as text.")
      .def(
          "report",
          [](const StoredResult& s, bool verbose) { return s.report_text(Notes{verbose}); },
          "verbose"_a = false,
          "One screen of text; a note is cut to a line unless it is verbose (notes has them all).")
      .def(
          "write", [](StoredResult& s, nb::handle path) { s.write(text("path", path)); }, "path"_a,
          nb::sig("def write(self, path: str | os.PathLike[str]) -> None"),
          "By extension: .csv, .csv.gz, .h5 or .json. The file appears whole or not at all.")
      .def(
          "write_page",
          [](StoredResult& s, nb::handle path) {
            s.restore_system();
            write_page(registry(), s.read(), text("path", path));
          },
          "path"_a, nb::sig("def write_page(self, path: str | os.PathLike[str]) -> None"),
          "The page of hamel run --report, one HTML file that a browser opens from disk.")
      .def(
          "to_pandas", [](nb::handle self) { return helper("_frames", "to_pandas")(self); },
          nb::sig("def to_pandas(self) -> pandas.DataFrame"),
          "A row for each time (the index t), a column for each; attrs has the units.")
      .def(
          "to_xarray", [](nb::handle self) { return helper("_frames", "to_xarray")(self); },
          nb::sig("def to_xarray(self) -> xarray.Dataset"),
          "The dimension t, and one for each vector; units as attributes.")
      .def(
          "animation",
          [](nb::handle self, int height) {
            return helper("_animation", "Animation")(self, height);
          },
          "height"_a = 320, nb::sig("def animation(self, height: int = 320) -> _Animation"),
          "The drawing of the system in motion, which a notebook shows; height in pixels. "
          "ValueError where the system has no drawing, or the rows are in files.")
      .def("__str__", [](const StoredResult& s) { return s.report_text(Notes::brief); })
      .def("__repr__",
           [](const StoredResult& s) {
             return "<hamel.Result of " + s.read().config.system + ": " +
                    (s.read().status.ok ? "ok" : "failed") + ", " + std::to_string(s.read().steps) +
                    " steps to t = " + text_of(s.read().last.time) + ", " +
                    std::to_string(s.read().trajectory.rows()) + " rows>";
           })
      .def("__getstate__", [](const StoredResult& s) { return pack(s); })
      .def("__setstate__", [](StoredResult& s, const nb::dict& state) { unpack(s, state); });
  bind_figures(result, "html_of",
               "The figures of the report page, by the names of hamel report --figure; a notebook "
               "shows each.",
               [](StoredResult& s) {
                 s.restore_system();
                 return figures::of_run(registry(), s.read());
               });
}

}  // namespace hamel::python
