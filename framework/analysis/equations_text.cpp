#include <hamel/framework/analysis/equations_text.hpp>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/analysis/equation_names.hpp>
#include <hamel/framework/graph/substitute.hpp>

namespace hamel {
namespace {

using graph::FormulaText;
using graph::Notation;
using graph::Number;
using Numbers = std::vector<Number>;
using Texts = std::vector<std::string>;

constexpr size_t kWidth = 96;  // of a line of code

// xi_j is 0 or a constant multiple of one independent velocity.
bool is_short(const graph::Recording& recording, const Number& x) {
  if (x.constant()) return true;
  const graph::Node& node = recording.nodes()[static_cast<size_t>(x.node())];
  const auto is = [&](int i, graph::Op op) {
    return i >= 0 && recording.nodes()[static_cast<size_t>(i)].op == op;
  };
  switch (node.op) {
    case graph::Op::input: return true;
    case graph::Op::negate: return is(node.a, graph::Op::input);
    case graph::Op::multiply:
    case graph::Op::divide:
      return (is(node.a, graph::Op::constant) && is(node.b, graph::Op::input)) ||
             (is(node.b, graph::Op::constant) && is(node.a, graph::Op::input));
    default: return false;
  }
}

// Formulas of admissible velocities, and their places among the inputs.
struct ShownMotion {
  graph::Recording recording;
  Numbers rates, coordinate_rates, pivots, rows;  // rows: dependent velocities by the others
  std::vector<size_t> dependent;                  // of xi
  std::vector<bool> replaced;                     // of xi
  size_t coordinates, velocities;

  explicit ShownMotion(const MotionFormulas& motion)
      : replaced(motion.rates.size()),
        coordinates(motion.variables.coordinates.size()),
        velocities(motion.rates.size()) {
    const graph::Recording& from = *motion.recording;
    Numbers inputs;
    for (const std::string& name : from.inputs()) inputs.push_back(recording.input(name));
    Numbers values = motion.admissible;
    values = substituted(from, values, inputs);
    for (size_t j = 0; j < velocities; ++j) {
      const auto index = static_cast<int>(j);
      if (std::ranges::find(motion.independent, index) != motion.independent.end()) continue;
      dependent.push_back(j);
      rows.push_back(values[j]);
      if (!is_short(recording, values[j])) continue;
      replaced[j] = true;
      inputs[1 + coordinates + j] = values[j];
    }
    rates = substituted(from, motion.rates, inputs);
    coordinate_rates = substituted(from, motion.variables.coordinate_rates, inputs);
    pivots = substituted(from, motion.pivots, inputs);
    recording.end();
  }
};

// Continues a line of code behind its last blank within the width.
std::string broken(const std::string& line, size_t indent, size_t extra = 4) {
  std::string out;
  size_t from = 0, width = kWidth;
  while (line.size() - from > width) {
    const size_t at = line.rfind(' ', from + width);
    if (at == std::string::npos || at <= from + indent) break;
    out += line.substr(from, at - from) + '\n' + std::string(indent + extra, ' ');
    from = at + 1;
    width = kWidth - indent - extra;
  }
  return out + line.substr(from);
}

std::string assignment(const std::string& name, const std::string& formula, Notation notation,
                       size_t indent) {
  const std::string before = std::string(indent, ' ') + name + " = ";
  if (notation == Notation::c) return broken(before + formula + ';', indent) + '\n';
  if (before.size() + formula.size() <= kWidth) return before + formula + '\n';
  return broken(before + '(' + formula + ')', indent) + '\n';
}

// Values as text, with the definitions that they need.
struct WrittenValues {
  std::vector<std::pair<std::string, std::string>> definitions;
  Texts values;
  std::string all;  // in one

  WrittenValues(const FormulaText& of, const Numbers& numbers) {
    for (const Number& x : numbers) {
      values.push_back(of.text(x));
      all += values.back() + '\n';
    }
    const auto stated = of.definitions();
    for (auto d = stated.rbegin(); d != stated.rend(); ++d) {
      if (!occurs(d->first, all)) continue;  // its terms have cancelled
      all += d->second + '\n';
      definitions.push_back(*d);
    }
    std::reverse(definitions.begin(), definitions.end());
  }
};

class Document {
 public:
  Document(const MotionFormulas& motion, const std::string& name, const std::string& title,
           Notation notation)
      : shown_(motion),
        name_(identifier(name)),
        title_(title),
        notation_(notation),
        stated_(motion.recording->inputs()),
        names_(names_of(stated_, notation)),
        prefix_(free_prefix(names_)) {}

  std::string text() const {
    switch (notation_) {
      case Notation::latex: return latex();
      case Notation::c: return c();
      case Notation::numpy: return python();
      case Notation::sympy: return sympy();
    }
    return "";
  }

 private:
  size_t velocity(size_t j) const { return 1 + shown_.coordinates + j; }
  size_t first_input() const { return velocity(shown_.velocities); }
  Texts slice(const Texts& names, size_t from, size_t to) const {
    return {names.begin() + static_cast<std::ptrdiff_t>(from),
            names.begin() + static_cast<std::ptrdiff_t>(to)};
  }
  std::string listed(size_t from, size_t to) const {
    return fmt::format("{}", fmt::join(slice(stated_, from, to), ", "));
  }
  FormulaText formulas(const Numbers& values) const {
    return {shown_.recording, notation_, names_, values, prefix_};
  }

  // Lines of the comment in front.
  Texts head() const {
    Texts out = {title_};
    std::string arguments = fmt::format("q = ({}), xi = ({})", listed(1, velocity(0)),
                                        listed(velocity(0), first_input()));
    if (first_input() < stated_.size())
      arguments += fmt::format(", u = ({}), which are held", listed(first_input(), stated_.size()));
    out.push_back(arguments);
    if (!shown_.dependent.empty())
      out.push_back("Of velocities that satisfy the rows" +
                    std::string(shown_.pivots.empty() ? "." : ", where no pivot of them is 0."));
    return out;
  }
  std::string comment(const std::string& before, const std::string& behind) const {
    std::string out;
    for (const std::string& line : head()) out += before + line + behind + '\n';
    return out;
  }

  std::string latex() const {
    std::string out = comment("% ", "") + "% Numbers to 6 digits.\n\\begin{aligned}\n";
    const auto line = [&out](const std::string& left, const std::string& right) {
      out += left + " &= " + right + " \\\\\n";
    };
    // In the order of lines, so that what only rates of dependent velocities need is left out.
    const auto is_dependent = [this](size_t j) {
      return std::ranges::find(shown_.dependent, j) != shown_.dependent.end();
    };
    Numbers values;
    Texts left;
    const auto add = [&](const std::string& name, const Number& value) {
      left.push_back(name + " &= ");
      values.push_back(value);
    };
    for (size_t j = 0; j < shown_.velocities; ++j)
      if (!is_dependent(j)) add(latex_rate(stated_[velocity(j)]), shown_.rates[j]);
    for (size_t i = 0; i < shown_.dependent.size(); ++i)
      add(names_[velocity(shown_.dependent[i])], shown_.rows[i]);
    for (size_t i = 0; i < shown_.coordinates; ++i)
      add(latex_rate(stated_[1 + i]), shown_.coordinate_rates[i]);
    for (const Number& pivot : shown_.pivots) {
      left.emplace_back("0 &\\ne ");
      values.push_back(pivot);
    }
    const WrittenValues written(formulas(values), values);
    for (const auto& [name, formula] : written.definitions) line(name, formula);
    for (size_t i = 0; i < values.size(); ++i) {
      const std::string& right = written.values[i];
      if (left[i] != right + " &= ") out += left[i] + right + " \\\\\n";
    }
    return out + "\\end{aligned}\n";
  }

  // Arguments that occur, by their names.
  template <class Take>
  void take_arguments(const WrittenValues& written, Take&& take) const {
    for (size_t i = 1; i < names_.size(); ++i) {
      if (!occurs(names_[i], written.all)) continue;
      const size_t first = i < velocity(0) ? 1 : i < first_input() ? velocity(0) : first_input();
      take(names_[i], fmt::format("{}[{}]",
                                  first == 1             ? "q"
                                  : first == velocity(0) ? "xi"
                                                         : "u",
                                  i - first));
    }
  }
  // The lines of a function that writes values to out.
  std::string body(const Numbers& values, const std::string& out_name) const {
    const WrittenValues written(formulas(values), values);
    const size_t indent = notation_ == Notation::c ? 2 : 4;
    const std::string type = notation_ == Notation::c ? "const double " : "";
    std::string out;
    take_arguments(written, [&](const std::string& name, const std::string& argument) {
      out += assignment(type + name, argument, notation_, indent);
    });
    for (const auto& [name, formula] : written.definitions)
      out += assignment(type + name, formula, notation_, indent);
    for (size_t i = 0; i < values.size(); ++i)
      out += assignment(fmt::format("{}[{}]", out_name, i), written.values[i], notation_, indent);
    return out;
  }
  std::string c() const {
    const auto function = [&](const std::string& what, const Numbers& values,
                              const std::string& out_name, bool in_time) {
      const std::string unused = in_time ? "  (void)t;\n  (void)q;\n  (void)xi;\n  (void)u;\n"
                                         : "  (void)q;\n  (void)xi;\n";
      return fmt::format(
          "\nvoid {}_{}({}const double *q, const double *xi, {}double *{}) {{\n{}{}}}\n", name_,
          what, in_time ? "double t, " : "", in_time ? "const double *u, " : "", out_name, unused,
          body(values, out_name));
    };
    std::string out = "/*\n" + comment(" * ", "") + " */\n#include <math.h>\n";
    out += function("rate", shown_.rates, "rate", true);
    return out + function("coordinate_rates", shown_.coordinate_rates, "q_rate", false);
  }
  std::string python() const {
    std::string out = comment("# ", "") + "import numpy as np\n\n\ndef rate(t, q, xi, u=()):\n";
    out += "    \"\"\"xi' at these coordinates, velocities and inputs.\"\"\"\n";
    out += fmt::format("    rate = np.empty({})\n{}    return rate\n", shown_.rates.size(),
                       body(shown_.rates, "rate"));
    out += "\n\ndef coordinate_rates(q, xi):\n    \"\"\"q'.\"\"\"\n";
    return out + fmt::format("    q_rate = np.empty({})\n{}    return q_rate\n",
                             shown_.coordinate_rates.size(),
                             body(shown_.coordinate_rates, "q_rate"));
  }
  std::string sympy() const {
    std::string out = comment("# ", "") + "import sympy\n\n";
    const auto symbols = [&](const std::string& of, size_t from, size_t to) {
      std::string line = of + " = (";
      for (size_t i = from; i < to; ++i) line += fmt::format("sympy.Symbol(\"{}\"), ", stated_[i]);
      if (line.ends_with(' ')) line.pop_back();
      out += broken(line + ')', 0) + '\n';
    };
    out += "t = sympy.Symbol(\"t\")\n";
    symbols("q", 1, velocity(0));
    symbols("xi", velocity(0), first_input());
    symbols("u", first_input(), stated_.size());
    Numbers values = shown_.rates;
    values.insert(values.end(), shown_.coordinate_rates.begin(), shown_.coordinate_rates.end());
    const WrittenValues written(formulas(values), values);
    take_arguments(written, [&](const std::string& name, const std::string& argument) {
      out += assignment(name, argument, notation_, 0);
    });
    for (const auto& [name, formula] : written.definitions)
      out += assignment(name, formula, notation_, 0);
    const auto vector = [&](const std::string& name, size_t from, size_t to) {
      out += name + " = sympy.Matrix([\n";
      for (size_t i = from; i < to; ++i) out += broken("    " + written.values[i] + ',', 4) + '\n';
      out += "])\n";
    };
    vector("rate", 0, shown_.velocities);
    vector("coordinate_rates", shown_.velocities, values.size());
    return out;
  }

  ShownMotion shown_;
  std::string name_, title_;
  Notation notation_;
  Texts stated_, names_;
  std::string prefix_;
};

}  // namespace

std::string equations_text(const MotionFormulas& motion, const std::string& name,
                           const std::string& title, Notation notation) {
  return Document(motion, name, title, notation).text();
}

}  // namespace hamel
