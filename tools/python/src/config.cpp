// A run as plain data, hamel.Config, and the options of hamel.run: both follow from Config::fields.
#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <string_view>

#include <hamel/framework/io/whole_number.hpp>

#include "bindings.hpp"

namespace hamel::python {
namespace {

void read(const std::string& name, nb::handle value, std::string& out) { out = text(name, value); }
void read(const std::string& name, nb::handle value, double& out) { out = number(name, value); }
void read(const std::string&, nb::handle value, bool& out) {
  const int truth = PyObject_IsTrue(value.ptr());
  if (truth < 0) nb::raise_python_error();
  out = truth == 1;
}
void read(const std::string& name, nb::handle value, long& out) {
  const double given = number(name, value);
  if (const auto whole = whole_number(given)) out = *whole;
  else read_text(name, text_of(given), out);  // throws
}
void read(const std::string& name, nb::handle value, std::optional<double>& out) {
  out.reset();
  if (!value.is_none()) out = number(name, value);
}
void read(const std::string& name, nb::handle value, std::vector<double>& out) {
  out = numbers(name, value);
}
void read(const std::string& name, nb::handle value, std::vector<std::string>& out) {
  out = texts(name, value);
}

using Setter = std::function<void(Config&, const std::string& name, nb::handle value)>;

template <class Value, class Owner>
Setter setter(Value Owner::*member, Owner& (*owner)(Config&)) {
  return [member, owner](Config& config, const std::string& name, nb::handle value) {
    Value& out = owner(config).*member;
    // Text goes the way of the command line, with its errors.
    if constexpr (!std::is_same_v<Value, std::string>) {
      if (nb::isinstance<nb::str>(value)) return read_text(name, text(name, value), out);
    }
    read(name, value, out);
  };
}

void read_inputs(Config& config, const std::string& name, nb::handle value) {
  for (const auto& [input, signal] : dict(name, value)) {
    const std::string key = text(name, input);
    config.inputs[key] = signal_of(name + "." + key, signal);
  }
}

void read_parameters(Config& config, const std::string& name, nb::handle value) {
  for (const auto& [parameter, given] : dict(name, value)) {
    const std::string key = text(name, parameter);
    config.parameters[key] = numbers(key, given);
  }
}

// The options that are data, by name.
const std::map<std::string, Setter, std::less<>>& setters() {
  static const auto all = [] {
    std::map<std::string, Setter, std::less<>> out;
    constexpr auto self = +[](Config& config) -> Config& { return config; };
    constexpr auto start = +[](Config& config) -> Start& { return config.start; };
    Config::fields(
        [&](const Option& option, auto member) { out[option.name] = setter(member, self); });
    Config::start_fields(
        [&](const Option& option, auto member) { out[option.name] = setter(member, start); });
    out["from_"] = out.at("from");
    out["inputs"] = read_inputs;
    out["parameters"] = read_parameters;
    return out;
  }();
  return all;
}

std::string help_of(const Option& option) {
  const std::string unit = option.unit, expected = option.expected;
  return std::string(option.meaning) + (unit.empty() || unit == "1" ? "" : " [" + unit + "]") +
         (expected.empty() ? "" : "; " + expected);
}

// `from` is a word of Python.
const char* name_of(const Option& option) {
  return option.name == std::string("from") ? "from_" : option.name;
}

// Text that lives as long as the module: nanobind refers to it.
const char* kept(std::string text) {
  static std::deque<std::string> all;
  return all.emplace_back(std::move(text)).c_str();
}

// The type of an option, as a stub has it.
const char* type_of(std::string Config::*) { return "str"; }
const char* type_of(double Config::*) { return "float"; }
const char* type_of(std::optional<double> Config::*) { return "float | None"; }
const char* type_of(long Config::*) { return "int"; }
const char* type_of(bool Config::*) { return "bool"; }
const char* type_of(std::vector<double> Config::*) { return "_Numbers"; }
const char* type_of(std::vector<std::string> Config::*) {
  return "str | collections.abc.Sequence[str]";
}

// Is its method one of two numbers, as in C++ (builder.cpp)?
bool has_own_setter(std::string_view name) { return name == "solver" || name == "tolerance"; }

// Has the system this parameter before the options? False where it cannot be built without them.
bool is_parameter(const Builder& builder, const std::string& name) {
  try {
    const std::vector<Field> fields = described(builder.simulation).parameters;
    return std::ranges::any_of(fields, [&](const Field& field) { return field.name == name; });
  } catch (const ConfigError&) {
    return false;
  }
}

// A name that is no option is a parameter, unless its value is a text that no parameter has.
std::string unknown_option(const std::string& name) {
  std::vector<std::string> known;
  for (const auto& [option, unused] : setters()) known.push_back(option);
  return unknown_name("option", name, known);
}

Config with(Config config, const nb::kwargs& options) {
  Builder builder{simulate(config.system)};
  builder.simulation.config(std::move(config));
  apply(builder, options);
  return builder.simulation.config();
}

}  // namespace

void apply(Builder& builder, const nb::kwargs& options) {
  Config config = builder.simulation.config();
  std::vector<std::string> mistakes;
  std::vector<std::pair<std::string, nb::handle>> functions;
  for (const auto& [key, value] : options) {
    const std::string name = key_of(key);
    const auto option = setters().find(name);
    try {
      if (option != setters().end()) option->second(config, name, value);
      else if (name == "observe" || name == "on_event" || name == "progress" ||
               name == "record_to" || name == "keep_rows" || name == "resume")
        functions.emplace_back(name, value);
      else if (!nb::isinstance<nb::str>(value)) config.parameters[name] = numbers(name, value);
      else if (is_parameter(builder, name))
        read_text(name, text(name, value), config.parameters[name]);
      else mistakes.push_back(unknown_option(name));
    } catch (const ConfigError& error) {
      mistakes.insert(mistakes.end(), error.mistakes().begin(), error.mistakes().end());
    }
  }
  if (!mistakes.empty()) throw ConfigError(mistakes);
  builder.simulation.config(std::move(config));
  if (functions.empty()) return;
  const nb::object self = nb::cast(&builder, nb::rv_policy::reference);
  for (const auto& [name, value] : functions) {
    if (value.is_none()) continue;
    if (name == "on_event") {
      for (const auto& [event, impact] : dict(name, value)) self.attr("on_event")(event, impact);
    } else if (name == "record_to") {
      for (const std::string& path : texts(name, value)) self.attr("record_to")(path);
    } else {
      self.attr(name.c_str())(value);
    }
  }
}

static InputTable table_of(std::vector<double> times, std::vector<double> values, bool hold) {
  if (times.empty() || times.size() != values.size())
    throw ConfigError({"InputTable: got " + std::to_string(times.size()) + " times and " +
                       std::to_string(values.size()) + " values, expected a value for each time"});
  return {std::move(times), std::move(values), hold};
}

void bind_config(nb::module_& m) {
  nb::class_<InputTable>(m, "InputTable",
                         "Values of an input over time: linear between its times [s], or held "
                         "from each to the next.")
      .def(
          "__init__",
          [](InputTable* self, nb::handle times, nb::handle values, bool hold) {
            new (self)
                InputTable(table_of(numbers("times", times), numbers("values", values), hold));
          },
          "times"_a, "values"_a, "hold"_a = false,
          nb::sig(
              "def __init__(self, times: _Numbers, values: _Numbers, hold: bool = False) -> None"))
      .def_ro("times", &InputTable::times, "increasing [s]")
      .def_ro("values", &InputTable::values)
      .def_ro("hold", &InputTable::hold)
      .def("at", &InputTable::at, "t"_a, "The value at t; on a jump the one behind it.")
      .def("__getstate__",
           [](const InputTable& t) { return nb::make_tuple(t.times, t.values, t.hold); })
      .def("__setstate__",
           [](InputTable& t,
              const std::tuple<std::vector<double>, std::vector<double>, bool>& state) {
             new (&t)
                 InputTable(table_of(std::get<0>(state), std::get<1>(state), std::get<2>(state)));
           });

  nb::class_<Config> config(
      m, "Config",
      "A run as plain data: its system, parameters, inputs, start and options. Pickles, compares "
      "and goes through TOML unchanged.");
  config
      .def(
          "__init__",
          [](Config* self, const std::string& system, const nb::kwargs& options) {
            Config start;
            start.system = system;
            new (self) Config(with(std::move(start), options));
          },
          "system"_a, "options"_a,
          nb::sig("def __init__(self, system: str, **options: typing.Any) -> None"),
          "The options are those of hamel.run.")
      .def_rw("system", &Config::system, "a registered name, or a file .toml")
      .def_rw("parameters", &Config::parameters, "numbers by name, in the unit of the system")
      .def("to_toml", &Config::to_toml, "As TOML, which hamel run --config reads.")
      .def_static("from_toml", &Config::from_toml, "text"_a, "origin"_a = "config",
                  "Keys as on the command line; ConfigError with line and column.")
      .def_static("read", &read_config, "path"_a, "From a file of TOML.")
      .def_static("continued", &Config::continued, "record"_a, "origin"_a = "record",
                  "Resumes where the run of a record (JSON) ended, for as long again.")
      .def(
          "replace",
          [](const Config& self, const nb::kwargs& options) { return with(self, options); },
          "options"_a, nb::sig("def replace(self, **options: typing.Any) -> Config"),
          "The same with some options changed.")
      .def("completed", &Config::completed,
           "With the scheme and the steps that are used where none are given.")
      .def("mistakes", &Config::mistakes, "What is wrong with the numbers themselves.")
      .def(
          "__eq__",
          [](const Config& a, nb::handle b) {
            Config other;
            return nb::try_cast(b, other) && a.to_toml() == other.to_toml();
          },
          nb::sig("def __eq__(self, other: object, /) -> bool"))
      .def("__repr__",
           [](const Config& c) { return "hamel.Config.from_toml('''\n" + c.to_toml() + "''')"; })
      .def("__getstate__", [](const Config& c) { return c.to_toml(); })
      .def("__setstate__", [](Config& c, const std::string& toml) {
        new (&c) Config(Config::from_toml(toml, "pickle"));
      });
  nb::class_<Recorded>(m, "Recorded", "A run in a file, .h5: how to resume it.")
      .def_ro("path", &Recorded::path, "without .part")
      .def_ro("finished", &Recorded::finished)
      .def_ro("config", &Recorded::config,
              "unfinished: as it was given; finished: where it ended, for as long again");
  m.def(
      "read_recorded", [](nb::handle path) { return read_recorded(text("path", path)); }, "path"_a,
      nb::sig("def read_recorded(path: str | os.PathLike[str]) -> Recorded"),
      "The run in a file, .h5; an unfinished one is resumed by run(r.config, resume=r.path, "
      "record_to=r.path).");
  config.attr("__hash__") = nb::none();
  Config::fields([&](const Option& option, auto member) {
    config.def_rw(name_of(option), member, kept(help_of(option)));
  });
  Config::start_fields([&](const Option& option, auto member) {
    config.def_prop_rw(
        option.name, [member](const Config& c) { return c.start.*member; },
        [member](Config& c, std::vector<double> value) { c.start.*member = std::move(value); },
        kept(help_of(option)));
  });
}

void bind_setters(nb::class_<Builder>& builder) {
  Config::fields([&](const Option& option, auto member) {
    const char* name = name_of(option);
    if (has_own_setter(name)) return;
    const std::string type = type_of(member), otherwise = type == "bool" ? " = True" : "";
    const auto set = [name](nb::object self, nb::handle value) {
      nb::kwargs options = nb::steal<nb::kwargs>(PyDict_New());
      options[name] = value;
      apply(nb::cast<Builder&>(self), options);
      return self;
    };
    const char* signature =
        kept("def " + std::string(name) + "(self, value: " + type + otherwise + ") -> Simulation");
    const char* help = kept(help_of(option));
    if (type == "bool") builder.def(name, set, "value"_a = true, nb::sig(signature), help);
    else builder.def(name, set, "value"_a, nb::sig(signature), help);
  });
}

std::string options_of_a_run() {
  std::string out;
  const auto line = [&out](const std::string& name, const std::string& help) {
    out += "\n    " + name + ": " + help;
  };
  Config::start_fields([&](const Option& option, auto) { line(option.name, help_of(option)); });
  Config::fields([&](const Option& option, auto) { line(name_of(option), help_of(option)); });
  line("parameters", "a dict of parameters, beside those given by their names");
  line("inputs", "a dict: a number, an InputTable, a pair (times, values), or 'table.csv'");
  line("on_event", "a dict of functions that change the state (EventState) at an event");
  line("observe", "a function of each recorded State; returning False stops the run");
  line("progress", "True, or a function of the fraction done");
  line("record_to", "files .csv, .csv.gz, .h5, .json, written as the rows come");
  line("keep_rows", "about so many rows beside the files");
  line("resume", "the unfinished run in a file .h5");
  return out;
}

}  // namespace hamel::python
