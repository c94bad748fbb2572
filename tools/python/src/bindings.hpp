// The Python module hamel._hamel: what its sources share. It binds <hamel/simulate.hpp>, and names
// are those of C++.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/complex.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <hamel/framework/figures/figures.hpp>
#include <hamel/simulate.hpp>
#include <hamel/systems/by_text.hpp>

#include "functions.hpp"

namespace hamel::python {

namespace nb = nanobind;
using namespace nb::literals;

using Array = nb::ndarray<nb::numpy, double>;
using ReadOnly = nb::ndarray<nb::numpy, const double>;

/// Numbers of a sequence, an array or one number; ConfigError that names them where it is none.
std::vector<double> numbers(const std::string& name, nb::handle value);
double number(const std::string& name, nb::handle value);
std::string text(const std::string& name, nb::handle value);
nb::dict dict(const std::string& name, nb::handle value);
/// A dict of configuration and velocity or momentum.
Start start_of(const std::string& name, nb::handle value);
std::vector<std::string> texts(const std::string& name, nb::handle value);  // one text too

/// An array of its own memory.
nb::object array(std::vector<double> values);
nb::object matrix(std::vector<double> values, size_t columns);
nb::object complex_array(const std::vector<std::complex<double>>& values);

/// A text of Python in UTF-8; ConfigError that names it where it has lone surrogates.
std::string utf8(const std::string& name, nb::handle text);
/// The name of a keyword.
inline std::string key_of(nb::handle key) { return utf8("keyword", key); }

/// The function `name` of the Python module hamel.`module`, imported when it is called.
nb::object helper(const char* module, const char* name);

/// Binds figures(), _repr_html_() and _figures(): the JSON of what of(self) makes, for
/// hamel/_figures.py.
template <class Class, class Of>
void bind_figures(Class& bound, const char* html, const char* help, Of of) {
  bound
      .def(
          "_repr_html_", [html](nb::handle self) { return helper("_figures", html)(self); },
          nb::sig("def _repr_html_(self) -> str"))
      .def(
          "figures", [](nb::handle self) { return helper("_figures", "figures_of")(self); },
          nb::sig("def figures(self) -> dict[str, _Figure]"), help)
      .def("_figures", [of](typename Class::Type& self) { return figures::to_json(of(self)); });
}

/// A system by data, or a mechanism, whose text is at hand; the name is its file's.
struct SystemText {
  std::string toml, name;
};
/// The text of a system that is given as one, or as a SystemText; empty for a name or a file, which
/// are then its name.
SystemText system_text(const std::string& key, nb::handle system);
/// Description of the system of a run that could start.
ModelDescription described(const Simulation& simulation);

/// A run as Python states it: the builder, and the text that its system was read from.
struct Builder {
  Simulation simulation;
  std::string source = {};     // TOML; "" for a name or a file
  bool by_parts = false;       // a Mechanism
  Functions functions = {};    // all that follow, and those of a Mechanism
  bool has_functions = false;  // beside progress
  std::optional<Function> observer = {}, progress = {};
};

/// A Mechanism of Python, with the functions that its signals call.
struct ByParts : Mechanism {
  using Mechanism::Mechanism;
  Functions functions;
};

/// Builder of a registered name, a file, a TOML text (which has a line break), a Mechanism, a
/// Config or a Builder.
Builder builder_of(nb::handle system);
Builder builder_of(nb::handle system, const nb::kwargs& options);
/// The options as hamel.run has them; ConfigError with every one that does not fit.
void apply(Builder& builder, const nb::kwargs& options);
/// Their names and meanings, a line each.
std::string options_of_a_run();
/// The simulation with its observer and its progress, which Ctrl-C ends.
Simulation watched(const Builder& builder);
/// Runs with the interpreter free; Ctrl-C and exceptions of callbacks end it.
Result run(const Builder& builder);

/// The names by which a state is asked for.
struct StateNames {
  ModelDescription model;
  enum class Part { coordinate, velocity, momentum };
  std::map<std::string, std::pair<Part, size_t>> places;
  explicit StateNames(const SystemModel& system);
  double value(const Snapshot& state, const std::string& name) const;
};

/// A state with its names.
struct NamedState {
  Snapshot state;
  std::shared_ptr<const StateNames> names;  // null: by number only
};

/// A result, and what is kept of one that was pickled.
class StoredResult {
 public:
  using Places = std::map<std::string, std::pair<size_t, size_t>>;  // first column, number of them

  std::string source;  // as in Builder
  // Texts of a pickled result, whose system is null; the last has notes in full.
  std::string record, report, verbose_report;
  Functions functions;  // of its system

  StoredResult(Result of, std::string text, Functions called = {})
      : source(std::move(text)), functions(std::move(called)), result_(std::move(of)) {}
  /// All of it, and what is there without its rows.
  Result& read() { return result_.read(); }
  const Result& read() const { return result_.read(); }
  const Result& bare() const { return result_; }
  /// Columns, vectors and velocities by name; a column has the number 0. Found when first asked
  /// for.
  const Places& places() const;
  std::string record_text() const;
  std::string report_text(Notes length) const;
  void write(const std::string& path);
  /// Makes the system of a result that was pickled again, from its name or text.
  void restore_system();

 private:
  mutable Places places_;
  mutable Result result_;
};

nb::object result_of(Result result, std::string source, const Functions& functions);
nb::dict pack(const StoredResult& stored);
void unpack(StoredResult& self, const nb::dict& state);
/// A run to be stepped by hand.
nb::object by_hand(const Builder& builder);

/// A constant, an InputTable, a pair (times, values), or the name of a file.
InputSignal signal_of(const std::string& name, nb::handle value);

constexpr Point kOrigin = {0, 0, 0};

void bind_builder(nb::module_& m, nb::class_<Builder>& builder);
void bind_config(nb::module_& m);
void bind_ensemble(nb::module_& m);
void bind_equations(nb::module_& m);
void bind_fit(nb::module_& m);
void bind_forces(nb::class_<ByParts>& mechanism);
void bind_mechanism(nb::module_& m);
void bind_names(nb::module_& m);
void bind_plan(nb::module_& m);
void bind_result(nb::module_& m);
void bind_run(nb::module_& m);
void bind_section(nb::module_& m);
/// A method for each option of a run (Config::fields).
void bind_setters(nb::class_<Builder>& builder);
void bind_simulation(nb::module_& m);
void bind_steady(nb::module_& m);
void bind_study(nb::module_& m);

}  // namespace hamel::python
