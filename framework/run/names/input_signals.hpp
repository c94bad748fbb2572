// Values that a user gives for the inputs of a run (mechanics/inputs.hpp), as text and as TOML;
// files read, all checked.
//
//   2.5                a constant
//   gait.csv           a table, columns t,value, linear between its rows
//   gait.csv:hold      held from row to row
// A table with other columns, t,force,torque as a plan has them, gives the one with the name of the
// input. Lines of a table that begin with # are left out. Its times increase, and cover the run.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <hamel/framework/io/export.hpp>
#include <hamel/framework/mechanics/input_table.hpp>

namespace hamel {

class Inputs;
struct SystemModel;

/// A table that is read when the run is built.
struct InputFile {
  std::string path;
  bool hold = false;
  bool operator==(const InputFile&) const = default;
};
using InputSignal = std::variant<double, InputFile, InputTable>;
using InputSignals = std::map<std::string, InputSignal>;

/// A number, or a file's name with or without ":hold"; and back (a table: its size).
HAMEL_API InputSignal input_signal(const std::string& text);
HAMEL_API std::string text_of(const InputSignal& signal);

/// The table of a file for an input. ConfigError "what: path:line: ...".
HAMEL_API InputTable read_input_table(const std::string& what, const std::string& input,
                                      const InputFile& file);
/// Reads a file whose text is at hand in the same way.
HAMEL_API InputTable read_input_table(const std::string& what, const std::string& input,
                                      const InputFile& file, const std::string& text);

/// The span of a run, either way.
struct RunSpan {
  double from, until;
};
/// The inputs of a run of `system`, those not given 0; what is wrong goes to mistakes, and then
/// null.
std::shared_ptr<Inputs> make_inputs(const SystemModel& system, const InputSignals& given,
                                    const RunSpan& span, std::vector<std::string>& mistakes);
/// The system as these inputs drive it: no longer the one whose motion and invariants are known.
void drive(SystemModel& system, const std::shared_ptr<const Inputs>& inputs);
/// The index of an input. ConfigError with the nearest name where there is none.
size_t input_index(const std::string& system, const std::vector<InputField>& fields,
                   const std::string& name);
/// ConfigError where the value is out of the range that the system states.
void check_input(const std::string& system, const InputField& field, double value);

}  // namespace hamel
