#include <hamel/framework/run/names/input_signals.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/text_file.hpp>
#include <hamel/framework/mechanics/inputs.hpp>
#include <hamel/framework/mechanics/system.hpp>

namespace hamel {
namespace {

constexpr std::string_view kHold = ":hold";

// False where the text, but for blanks about it, is not all of one number; nan and inf are numbers
// here.
bool number(std::string_view text, double& out) {
  const auto first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  if (first == std::string_view::npos) return false;
  text = text.substr(first, last - first + 1);
  if (text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc() && end == text.data() + text.size();
}

std::vector<std::string_view> input_cells(std::string_view line) {
  std::vector<std::string_view> out;
  for (size_t comma = line.find(','); comma != std::string_view::npos; comma = line.find(',')) {
    out.push_back(line.substr(0, comma));
    line.remove_prefix(comma + 1);
  }
  out.push_back(line);
  return out;
}

// The column of the values of an input: of t,value the second, else that with its name; 0: none.
size_t input_column(const std::vector<std::string_view>& names, const std::string& input) {
  if (names[0] != "t") return 0;
  if (names.size() == 2 && names[1] == "value") return 1;
  const auto found = std::find(names.begin() + 1, names.end(), input);
  return found == names.end() ? 0 : static_cast<size_t>(found - names.begin());
}

std::string label(const std::string& system, const std::string& name) {
  return fmt::format("input '{}' of {}", name, system);
}

// The mistake of a value, or "".
std::string refusal(const std::string& what, const InputField& field, double value) {
  if (field.range.allows(value)) return "";
  const std::string words = field.range.words();
  return fmt::format("{}: got {}, expected {}{}", what, value,
                     words.empty() ? "a finite number" : words,
                     field.unit.empty() || words.empty() ? "" : " " + field.unit);
}

// The mistakes of a table for a field and a run.
std::string refusal(const std::string& what, const InputField& field, const InputTable& table,
                    const RunSpan& span) {
  const size_t count = table.times.size();
  if (count == 0 && table.values.empty())
    return fmt::format("{}: the table is empty, expected rows of a time and a value", what);
  if (table.values.size() != count) {
    return fmt::format("{}: a table of {} times and {} values, expected as many of both", what,
                       count, table.values.size());
  }
  for (size_t i = 0; i < count; ++i) {
    const double t = table.times[i];
    const std::string row = fmt::format("{}: row {}", what, i + 1);
    if (!std::isfinite(t))
      return fmt::format("{}: the time is {}, expected a finite number", row, t);
    if (i > 0 && t <= table.times[i - 1]) {
      return fmt::format("{}: the time {} comes after {}, expected increasing times", row, t,
                         table.times[i - 1]);
    }
    if (const std::string mistake = refusal(row, field, table.values[i]); !mistake.empty())
      return mistake;
  }
  const double first = std::min(span.from, span.until), last = std::max(span.from, span.until);
  const double close = 1e-9 * (last - first);
  if (table.times.front() > first + close || table.times.back() < last - close) {
    return fmt::format("{}: the table covers t = {} to {}, expected the whole run, {} to {}", what,
                       table.times.front(), table.times.back(), first, last);
  }
  return "";
}

}  // namespace

InputSignal input_signal(const std::string& text) {
  double value = 0;
  if (number(text, value)) return value;
  if (text.ends_with(kHold)) return InputFile{text.substr(0, text.size() - kHold.size()), true};
  return InputFile{text};
}

std::string text_of(const InputSignal& signal) {
  if (const double* value = std::get_if<double>(&signal)) return fmt::format("{}", *value);
  if (const InputFile* file = std::get_if<InputFile>(&signal))
    return file->path + std::string(file->hold ? kHold : "");
  const auto& table = std::get<InputTable>(signal);
  return fmt::format("a table of {} rows{}", table.times.size(), table.hold ? ", held" : "");
}

InputTable read_input_table(const std::string& what, const std::string& input,
                            const InputFile& file) {
  return read_input_table(what, input, file, read_text_file(what, file.path));
}

InputTable read_input_table(const std::string& what, const std::string& input,
                            const InputFile& file, const std::string& text) {
  std::istringstream lines(text);
  InputTable table{{}, {}, file.hold};
  size_t column = 0, count = 0;  // of the values, and of all columns
  long at = 0;
  for (std::string line; std::getline(lines, line);) {
    ++at;
    const auto refuse = [&](const std::string& expected) {
      throw ConfigError({fmt::format("{}: {}:{}: got '{}', expected {}", what, file.path, at,
                                     shortened(line), expected)});
    };
    if (line.ends_with('\r')) line.pop_back();
    if (line.starts_with('#')) continue;
    const std::vector<std::string_view> cells = input_cells(line);
    if (count == 0) {
      column = input_column(cells, input);
      count = cells.size();
      if (column == 0) refuse(fmt::format("the columns t,value or t and {}", input));
      continue;
    }
    double t = 0, value = 0;
    if (cells.size() != count || !number(cells[0], t) || !number(cells[column], value))
      refuse(count == 2 ? "two numbers, t,value" : fmt::format("{} numbers", count));
    table.times.push_back(t);
    table.values.push_back(value);
  }
  return table;
}

size_t input_index(const std::string& system, const std::vector<InputField>& fields,
                   const std::string& name) {
  std::vector<std::string> names;
  for (size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].name == name) return i;
    names.push_back(fields[i].name);
  }
  if (names.empty())
    throw ConfigError({fmt::format("input '{}': {} has no inputs", shortened(name), system)});
  throw ConfigError({unknown_name("input of " + system, name, names)});
}

void check_input(const std::string& system, const InputField& field, double value) {
  const std::string mistake = refusal(label(system, field.name), field, value);
  if (!mistake.empty()) throw ConfigError({mistake});
}

void drive(SystemModel& system, const std::shared_ptr<const Inputs>& inputs) {
  system.mechanics = system.drive(inputs);
  system.exact = nullptr;
  system.invariants.clear();
}

std::shared_ptr<Inputs> make_inputs(const SystemModel& system, const InputSignals& given,
                                    const RunSpan& span, std::vector<std::string>& mistakes) {
  std::vector<InputTable> tables(system.inputs.size(), {{}, {0}});
  const size_t before = mistakes.size();
  for (const auto& [name, signal] : given) {
    try {
      const size_t i = input_index(system.name, system.inputs, name);
      const InputField& field = system.inputs[i];
      const std::string what = label(system.name, name);
      if (const double* value = std::get_if<double>(&signal)) {
        check_input(system.name, field, *value);
        tables[i].values = {*value};
        continue;
      }
      const InputFile* file = std::get_if<InputFile>(&signal);
      tables[i] = file != nullptr ? read_input_table(what, field.name, *file)
                                  : std::get<InputTable>(signal);
      const std::string where = file != nullptr ? what + ": " + file->path : what;
      if (const std::string mistake = refusal(where, field, tables[i], span); !mistake.empty())
        mistakes.push_back(mistake);
    } catch (const ConfigError& error) {
      mistakes.insert(mistakes.end(), error.mistakes().begin(), error.mistakes().end());
    }
  }
  if (mistakes.size() > before) return nullptr;
  return std::make_shared<Inputs>(system.inputs, std::move(tables));
}

}  // namespace hamel
