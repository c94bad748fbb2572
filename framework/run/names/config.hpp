// A run as plain data: what the builder fills, the command line overrides, and a file keeps.
//
// Config::fields is the one list of a run's options. Files, the command line and its help, the
// record, the axes of a study and the table of tools/README.md follow from it: one more option is a
// member here, a line there, and the place that uses it.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/io/export.hpp>
#include <hamel/framework/mechanics/parameters.hpp>
#include <hamel/framework/mechanics/start.hpp>
#include <hamel/framework/run/names/input_signals.hpp>
#include <hamel/framework/schemes/error_scale.hpp>

namespace hamel {

/// Option of a run: a double (or none), long, bool or string, or a list of doubles or
/// strings.
struct Option {
  const char* name;  // in files and records; on the command line with dashes, --on-failure
  const char* unit;  // "" for names, "1" for plain numbers
  const char* meaning;
  bool axis = false;                 // whether a study may vary it
  bool (*allows)(double) = nullptr;  // for numbers, each entry of a list
  const char* expected = "";         // the allowed values, as text
};

struct HAMEL_API Config {
  std::string system;
  Parameters parameters;
  InputSignals inputs;
  Start start;
  std::optional<double> speed;            // in place of a start
  std::vector<std::string> start_values;  // "steer.angle=0.1", in place of the usual ones
  std::string scheme;                     // empty, and step, none: see completed()
  std::string retraction = "cayley";
  double s = 0.5;
  std::string solver = "newton";
  std::string force_at = "nodes";
  std::string compose = "none";
  std::string on_failure = "stop";
  double tolerance = 1e-13;
  std::optional<double> step;
  std::optional<double> rtol, atol;  // given: steps chosen by the error
  std::optional<double> step_max;
  long steps_max = 0;  // 0: no limit
  double from = 0;
  double until = 20;
  long every = 1;
  std::optional<double> output_step;
  std::vector<double> output_times;
  std::vector<std::string> events, stop_at;
  bool slip = false;
  bool check = false;
  bool force = false;
  bool no_exact = false;

  /// Calls f(Option, member pointer) for each option; axes in the order in which a study runs
  /// through them.
  template <class F>
  static void fields(F&& f) {
    f(Option{"scheme", "",
             "scheme of integration; without one dop853, with a step of one size lift", true},
      &Config::scheme);
    f(Option{"retraction", "", "retraction map", true}, &Config::retraction);
    f(Option{"s", "1", "discretisation parameter, in [0, 1]", true,
             [](double x) { return x >= 0 && x <= 1; }, "a number in [0, 1]"},
      &Config::s);
    f(Option{"solver", "", "solver of the implicit equation", true}, &Config::solver);
    f(Option{"force_at", "", "where a step of lift takes the forces: nodes (half at each) or base",
             true},
      &Config::force_at);
    f(Option{"compose", "", "composition: yoshida4 suzuki4 yoshida6 kahan_li6 suzuki_umeno8", true},
      &Config::compose);
    f(Option{"on_failure", "",
             "a failed step: stop, halve (two of half the size, each halved again where it fails), "
             "or retry:SOLVER",
             true},
      &Config::on_failure);
    f(Option{"tolerance", "1", "residual of each step, relative to the scale of its equation", true,
             [](double x) { return x > 0 && x < 1; }, "a number in (0, 1)"},
      &Config::tolerance);
    f(Option{"step", "s",
             "step, of either sign; where the error chooses them the first one; without one 0.01, "
             "or chosen at rtol 1e-8 where no scheme is named either",
             true, [](double x) { return std::isfinite(x) && x != 0; },
             "a finite number other than 0"},
      &Config::step);
    constexpr auto tolerance = [](double x) { return x > 0 && x < 1; };
    f(Option{"rtol", "1",
             "steps chosen by the error: relative tolerance (dopri5 tsit5 dop853; lift, balance at "
             "s = 0.5)",
             true, tolerance, "a number in (0, 1)"},
      &Config::rtol);
    f(Option{"atol", "1", "absolute tolerance beside it; that of rtol where not given", true,
             tolerance, "a number in (0, 1)"},
      &Config::atol);
    f(Option{"step_max", "s",
             "where steps are chosen, the largest: what is shorter may be stepped over, events too",
             false, [](double x) { return x > 0 && std::isfinite(x); }, "a number above 0"},
      &Config::step_max);
    f(Option{"steps_max", "1",
             "end the run, as failed, where so many steps do not suffice; 0: no limit", false,
             [](double x) { return x >= 0; }, "0 or more"},
      &Config::steps_max);
    f(Option{"speed", "m/s",
             "start, straight ahead at this speed, for systems that define a straight motion",
             false, [](double v) { return std::isfinite(v); }, "a finite number"},
      &Config::speed);
    f(Option{"start", "",
             "start, coordinates and velocities by name, NAME=VALUE; the others are as usual"},
      &Config::start_values);
    f(Option{"from", "s", "start time", false, [](double x) { return std::isfinite(x); },
             "a finite number"},
      &Config::from);
    f(Option{"until", "s",
             "end time, beyond the start in the direction of the step; whole steps only", false,
             [](double x) { return std::isfinite(x); }, "a finite number"},
      &Config::until);
    f(Option{"every", "1", "record every this many steps, first and last always", false,
             [](double x) { return x >= 1; }, "at least 1"},
      &Config::every);
    f(Option{"output_step", "s", "rows at this distance in time, by dense output, instead", false,
             [](double x) { return x > 0 && std::isfinite(x); }, "a number above 0"},
      &Config::output_step);
    f(Option{"output_times", "s", "rows at these times", false,
             [](double x) { return std::isfinite(x); }, "finite numbers"},
      &Config::output_times);
    f(Option{"events", "", "events to locate and record (hamel describe SYSTEM), or COLUMN=VALUE"},
      &Config::events);
    f(Option{"stop_at", "", "the same, where the run ends"}, &Config::stop_at);
    f(Option{"slip", "",
             "the start may slip: it is not projected onto the rows of contacts that may slide"},
      &Config::slip);
    f(Option{"check", "", "estimate the error by two finer runs: half the step, and a quarter"},
      &Config::check);
    f(Option{"force", "", "compose a step that is not reversible all the same"}, &Config::force);
    f(Option{"no_exact", "", "leave out the comparison with the exact motion"}, &Config::no_exact);
  }
  /// Calls it for the members of a Start.
  template <class F>
  static void start_fields(F&& f) {
    f(Option{"configuration", "", "start, in the element's CSV columns"}, &Start::configuration);
    f(Option{"velocity", "", "start, body components; projected onto the constraint, with a note"},
      &Start::velocity);
    f(Option{"momentum", "", "the same as body momentum"}, &Start::momentum);
  }

  /// An option by name, as text; set throws ConfigError for no such option, or text that does not
  /// fit.
  std::string text(const std::string& option) const;
  void set(const std::string& option, const std::string& text);
  /// Has it the value that it has where it is not given?
  bool is_default(const std::string& option) const;

  /// With the scheme and the steps used where none are given: neither scheme nor step, dop853
  /// at rtol 1e-8 with rows every kUsualStep; a step of one size, or a composition of such, lift;
  /// rtol or atol, dop853; a scheme, steps of kUsualStep.
  Config completed() const;
  static constexpr double kUsualStep = 0.01, kUsualRtol = 1e-8;
  /// Is it all left to completed()?
  bool leaves_method() const;
  /// The step; where none is given one of kUsualStep in the direction of the run.
  double step_or_usual() const { return step.value_or(std::copysign(kUsualStep, until - from)); }
  /// Are steps chosen by the error? Without atol both tolerances are the same.
  bool chooses_steps() const { return rtol || atol; }
  ErrorScale errors() const { return {rtol.value_or(0), atol.value_or(rtol.value_or(0))}; }

  /// The times of the rows where they are given by output_step or output_times, else none.
  std::vector<double> recorded_times() const;
  /// The number of whole steps: (until - from) / step rounded down, up to round-off.
  long steps() const;
  /// As TOML; reads back to an equal Config.
  std::string to_toml() const;
  /// Keys as on the command line. Throws ConfigError with line and column, or the nearest key.
  static Config from_toml(const std::string& text, const std::string& origin = "config");
  /// A run that resumes where that of a record (Result::record, `-o x.json`) ended: its system,
  /// parameters and options, its last state as the start, its time as `from`, for as long again.
  /// ConfigError for what is no record.
  static Config continued(const std::string& record, const std::string& origin = "record");
  /// Everything wrong with the numbers themselves (names are the registry's business).
  std::vector<std::string> mistakes() const;
};

/// Reads a file with from_toml; ConfigError when it cannot be read.
HAMEL_API Config read_config(const std::string& path);

/// The value of an option as text, lists separated by commas, and back: exact for numbers.
/// ConfigError that begins with `option` for text that does not fit.
HAMEL_API std::string text_of(double value);
HAMEL_API std::string text_of(std::optional<double> value);  // "" for none
HAMEL_API std::string text_of(long value);
HAMEL_API std::string text_of(bool value);
HAMEL_API std::string text_of(const std::string& value);
HAMEL_API std::string text_of(const std::vector<double>& value);
HAMEL_API std::string text_of(const std::vector<std::string>& value);
HAMEL_API void read_text(const std::string& option, const std::string& text, double& out);
HAMEL_API void read_text(const std::string& option, const std::string& text,
                         std::optional<double>& out);
HAMEL_API void read_text(const std::string& option, const std::string& text, long& out);
HAMEL_API void read_text(const std::string& option, const std::string& text, bool& out);
HAMEL_API void read_text(const std::string& option, const std::string& text, std::string& out);
HAMEL_API void read_text(const std::string& option, const std::string& text,
                         std::vector<double>& out);
HAMEL_API void read_text(const std::string& option, const std::string& text,
                         std::vector<std::string>& out);

}  // namespace hamel
