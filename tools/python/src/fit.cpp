// Fits and derivatives of runs: hamel.fit, hamel.sensitivities, their results.
#include <cmath>
#include <limits>

#include "long_call.hpp"

namespace hamel::python {
namespace {

nb::object matrix_of_numbers(const NumberMatrix& m) {
  return matrix(m.values, static_cast<size_t>(m.columns));
}

std::vector<double> column_given(const std::string& name, nb::handle values) {
  std::vector<double> out;
  try {
    for (const nb::handle one : values)
      out.push_back(one.is_none() ? std::numeric_limits<double>::quiet_NaN()
                                  : nb::cast<double>(nb::float_(one)));
  } catch (const std::exception&) {
    throw ConfigError({"data: " + name + ": expected numbers, or None where one is missing"});
  }
  return out;
}

// A file, or a mapping of columns: a dict, a DataFrame.
Recording recording_of(nb::handle data, size_t number) {
  if (nb::isinstance<nb::str>(data) || nb::hasattr(data, "__fspath__"))
    return read_recording(text("data", data));
  Recording out;
  out.name = "data " + std::to_string(number);
  if (!nb::hasattr(data, "keys"))
    throw ConfigError({out.name + ": expected a CSV file, or a dict of columns with t"});
  for (const nb::handle key : data.attr("keys")()) {
    const std::string name = nb::cast<std::string>(nb::str(key));
    std::vector<double> values = column_given(name, data[key]);
    if (name == "t") {
      out.t = std::move(values);
      continue;
    }
    out.columns.push_back(name);
    out.values.push_back(std::move(values));
  }
  if (out.t.empty()) throw ConfigError({out.name + ": expected a column t, the time in s"});
  for (size_t i = 0; i < out.columns.size(); ++i)
    if (out.values[i].size() != out.t.size())
      throw ConfigError({out.name + ": " + out.columns[i] + ": got " +
                         std::to_string(out.values[i].size()) + " numbers, expected " +
                         std::to_string(out.t.size())});
  return out;
}

std::vector<Recording> recordings_of(nb::handle data) {
  const bool many = nb::isinstance<nb::list>(data) || nb::isinstance<nb::tuple>(data);
  std::vector<Recording> out;
  if (!many) return {recording_of(data, 1)};
  for (const nb::handle one : data) out.push_back(recording_of(one, out.size() + 1));
  return out;
}

FitName fit_name_of(const std::string& name, nb::handle given) {
  FitName out{name};
  if (given.is_none()) return out;
  if (!nb::isinstance<nb::tuple>(given) && !nb::isinstance<nb::list>(given)) {
    out.guess = nb::cast<double>(nb::float_(given));
    return out;
  }
  const auto numbers = nb::cast<std::vector<double>>(given);
  if (numbers.size() != 3)
    throw ConfigError({"fit: " + name + ": expected a guess, or (guess, low, high)"});
  out.guess = numbers[0];
  out.low = numbers[1];
  out.high = numbers[2];
  return out;
}

// "offset=0.2:0:1", or a dict of name: guess, (guess, low, high) or None.
std::vector<FitName> fit_names_of(nb::handle names) {
  std::vector<FitName> out;
  if (nb::isinstance<nb::str>(names)) return {parse_fit_name(nb::cast<std::string>(names))};
  if (nb::isinstance<nb::dict>(names)) {
    for (const auto [name, given] : nb::cast<nb::dict>(names))
      out.push_back(fit_name_of(nb::cast<std::string>(name), given));
    return out;
  }
  for (const nb::handle one : names) out.push_back(parse_fit_name(nb::cast<std::string>(one)));
  return out;
}

Fit fit_by_python(nb::handle system, nb::handle data, nb::handle names,
                  std::map<std::string, double> sigma, std::map<std::string, std::string> observe,
                  std::optional<double> huber, std::optional<int> segments,
                  const nb::kwargs& options) {
  Builder builder = builder_of(system, options);
  const FitRequest request{.names = fit_names_of(names),
                           .recordings = recordings_of(data),
                           .sigma = std::move(sigma),
                           .observe = std::move(observe),
                           .huber = huber,
                           .segments = segments};
  return long_call(nb::none(), [&](std::atomic<bool>& stop, const std::function<void(double)>&) {
    return hamel::fit(builder.simulation, request, {}, &stop);
  });
}

}  // namespace

void bind_fit(nb::module_& m) {
  nb::class_<FittedNumber>(m, "FittedNumber", "A number of a fit.")
      .def_ro("name", &FittedNumber::name)
      .def_ro("unit", &FittedNumber::unit)
      .def_ro("value", &FittedNumber::value)
      .def_ro("guess", &FittedNumber::guess)
      .def_ro("sigma", &FittedNumber::sigma, "standard deviation; inf where undetermined")
      .def_ro("at_bound", &FittedNumber::at_bound);
  nb::class_<Fit>(m, "Fit",
                  "Numbers fitted to recordings: fit['offset'].value; true where the fit converged "
                  "and the data determine all numbers.")
      .def("__bool__", [](const Fit& f) { return f.ok(); })
      .def(
          "__getitem__",
          [](const Fit& f, const std::string& name) {
            std::vector<std::string> known;
            for (const FittedNumber& one : f.parameters) {
              if (one.name == name) return one;
              known.push_back(one.name);
            }
            throw ConfigError({unknown_name("fitted number", name, known)});
          },
          "name"_a)
      .def_ro("parameters", &Fit::parameters)
      .def_ro("converged", &Fit::converged)
      .def_ro("reason", &Fit::reason, "'' where it is true")
      .def_prop_ro(
          "covariance", [](const Fit& f) { return matrix_of_numbers(f.covariance); },
          "of the numbers, NaN where undetermined")
      .def_ro("chi2", &Fit::chi2)
      .def_ro("dof", &Fit::dof)
      .def_ro("sigma", &Fit::sigma, "of the columns, as given or estimated")
      .def_ro("undetermined", &Fit::undetermined,
              "directions that the data do not see, as relative changes")
      .def_ro("segments", &Fit::segments, "of each recording")
      .def_ro("iterations", &Fit::iterations)
      .def_ro("runs", &Fit::runs)
      .def_ro("notes", &Fit::notes)
      .def_prop_ro(
          "toml", [](const Fit& f) { return f.run.to_toml(); }, "the fitted run")
      .def(
          "residuals",
          [](const Fit& f, const std::string& name, size_t recording) {
            if (recording >= f.residuals.size())
              throw ConfigError(
                  {"recording: expected one of 0 to " + std::to_string(f.residuals.size() - 1)});
            return column_of(f.residuals[recording], name);
          },
          "name"_a, "recording"_a = 0,
          nb::sig("def residuals(self, name: str, recording: int = 0) -> "
                  "numpy.typing.NDArray[numpy.float64]"),
          "A column: t, 'omega' (data), 'omega.fit', 'omega.residual'.");
  nb::class_<Sensitivities>(m, "Sensitivities", "Derivatives along a run: s['d(omega)/d(offset)'].")
      .def("__bool__", [](const Sensitivities& s) { return s.status.ok; })
      .def(
          "__getitem__",
          [](const Sensitivities& s, const std::string& name) { return column_of(s.rows, name); },
          "name"_a,
          nb::sig("def __getitem__(self, name: str) -> numpy.typing.NDArray[numpy.float64]"))
      .def_prop_ro("columns", [](const Sensitivities& s) { return columns_of(s.rows); })
      .def_ro("names", &Sensitivities::names)
      .def_ro("errors", &Sensitivities::errors, "the largest, of each derivative")
      .def_ro("end_time", &Sensitivities::end_time,
              "derivatives of the time at which an event ended the run, by each name")
      .def_ro("growth", &Sensitivities::growth)
      .def_ro("status", &Sensitivities::status)
      .def("csv", [](const Sensitivities& s) { return s.rows.csv(); });
  nb::class_<Gradient>(m, "Gradient", "The derivative of a number at the end of a run, by names.")
      .def("__bool__", [](const Gradient& g) { return g.status.ok; })
      .def(
          "__getitem__",
          [](const Gradient& g, const std::string& name) {
            for (size_t i = 0; i < g.by.size(); ++i)
              if (g.names[i] == name) return g.by[i];
            throw ConfigError({unknown_name("number", name, g.names)});
          },
          "name"_a)
      .def_ro("value", &Gradient::value, "the number itself")
      .def_ro("names", &Gradient::names)
      .def_prop_ro(
          "by", [](const Gradient& g) { return array(g.by); },
          nb::sig("def by(self) -> numpy.typing.NDArray[numpy.float64]"))
      .def_ro("errors", &Gradient::errors)
      .def_ro("status", &Gradient::status);
  m.def(
      "fit", &fit_by_python, "system"_a, "data"_a, "names"_a, nb::kw_only(),
      "sigma"_a = std::map<std::string, double>(),
      "observe"_a = std::map<std::string, std::string>(), "huber"_a = nb::none(),
      "segments"_a = nb::none(), "options"_a,
      nb::sig(
          "def fit(system: _System, data: typing.Any, names: str | "
          "collections.abc.Sequence[str] | dict[str, typing.Any], *, sigma: dict[str, float] "
          "= {}, observe: dict[str, str] = {}, huber: float | None = None, segments: int | None = "
          "None, **options: typing.Any) -> Fit"),
      "Fits parameters, starts ('start.omega') and constant inputs to recordings. data: a CSV "
      "file, or a mapping of columns with t, or a list of such; names: 'offset=0.2:0:1', a list, "
      "or a dict of guesses or (guess, low, high); segments: of each recording, "
      "whose first states are unknowns too (multiple shooting), by how fast a displacement grows "
      "where it is not given.");
  m.def(
      "sensitivities",
      [](nb::handle system, const std::vector<std::string>& names, const nb::kwargs& options) {
        return builder_of(system, options).simulation.sensitivities(names);
      },
      "system"_a, "names"_a, "options"_a,
      nb::sig("def sensitivities(system: _System, names: collections.abc.Sequence[str], **options: "
              "typing.Any) -> Sensitivities"),
      "Derivatives of a run by parameters, constant inputs and its start, along it.");
}

}  // namespace hamel::python
