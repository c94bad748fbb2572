#include <hamel/framework/graph/formula_text.hpp>

#include <algorithm>
#include <cmath>

namespace hamel::graph {
namespace {

// How tightly a text holds together.
enum Level { kChoice, kEither, kBoth, kNot, kComparison, kSum, kProduct, kPower, kAtom };

// Operations from which on a value that is used again has a name; most in one formula.
constexpr int kShort = 4, kShortInLatex = 8, kLongest = 60, kLongestInLatex = 30;

std::string parenthesised(const std::string& text, Notation notation) {
  return notation == Notation::latex ? "\\left(" + text + "\\right)" : '(' + text + ')';
}

bool is_trigonometric(Op op) { return op == Op::sin || op == Op::cos; }

}  // namespace

FormulaText::FormulaText(const Recording& recording, Notation notation,
                         std::vector<std::string> inputs, const std::vector<Number>& values,
                         std::string prefix)
    : recording_(recording),
      notation_(notation),
      inputs_(std::move(inputs)),
      prefix_(std::move(prefix)),
      uses_(recording.nodes().size(), 0),
      names_(recording.nodes().size()) {
  count_uses(values);
  choose_names();
  find_constants();
  for (size_t k = 0; k < order_.size(); ++k) {
    const std::string number = std::to_string(k + 1);
    names_[static_cast<size_t>(order_[k])] =
        notation == Notation::latex ? prefix_ + "_{" + number + '}' : prefix_ + number;
  }
}

void FormulaText::count_uses(const std::vector<Number>& values) {
  for (const Number& x : values)
    if (!x.constant()) ++uses_[static_cast<size_t>(x.node())];
  for (size_t i = uses_.size(); i-- > 0;) {
    const Node& n = recording_.nodes()[i];
    if (uses_[i] == 0 || n.op == Op::input) continue;
    for (const int operand : {n.a, n.b, n.c})
      if (operand >= 0) ++uses_[static_cast<size_t>(operand)];
  }
}

void FormulaText::choose_names() {
  const bool latex = notation_ == Notation::latex;
  std::vector<int> sizes(uses_.size(), 0);  // operations where it is written out
  for (size_t i = 0; i < uses_.size(); ++i) {
    const Node& n = recording_.nodes()[i];
    if (uses_[i] == 0 || n.op == Op::input || n.op == Op::constant) continue;
    sizes[i] = 1;
    for (const int operand : {n.a, n.b, n.c})
      if (operand >= 0) sizes[i] += sizes[static_cast<size_t>(operand)];
    const bool again = uses_[i] > 1 && sizes[i] >= (latex ? kShortInLatex : kShort);
    if ((!again && sizes[i] <= (latex ? kLongestInLatex : kLongest)) || is_condition(n.op))
      continue;
    order_.push_back(static_cast<int>(i));
    names_[i] = prefix_;
    sizes[i] = 0;
  }
}

std::vector<std::pair<std::string, std::string>> FormulaText::definitions() const {
  std::vector<std::pair<std::string, std::string>> out;
  for (const int i : order_) out.emplace_back(names_[static_cast<size_t>(i)], formula_of(i).text);
  return out;
}

std::string FormulaText::text(const Number& x) const {
  return x.constant() ? constant_text(x.value(), notation_) : written(x.node()).text;
}

// ---- formulas -----------------------------------------------------------------------------------

FormulaText::Written FormulaText::written(int i) const {
  return named(i) ? Written{names_[static_cast<size_t>(i)], kAtom} : formula_of(i);
}

std::string FormulaText::within(int i, int level) const {
  const Written out = written(i);
  return out.level < level ? parenthesised(out.text, notation_) : out.text;
}

FormulaText::Written FormulaText::formula_of(int i) const {
  const Node& n = node(i);
  if (known(i)) return {constant_text(*known(i), notation_), *known(i) < 0 ? kSum : kAtom};
  if (n.op == Op::input) return {inputs_[static_cast<size_t>(n.a)], kAtom};
  if (n.op == Op::constant) return {constant_text(n.value, notation_), n.value < 0 ? kSum : kAtom};
  if (is_sum(i)) return sum(i);
  if (is_product(i)) return product(i);
  if (n.op == Op::select || is_condition(n.op)) return choice(i);
  return call(i);
}

FormulaText::Written FormulaText::sum(int i) const {
  std::vector<Factors> joined = joined_terms(i);
  std::string out;
  for (Factors& factors : joined) {
    const bool negative = factors.coefficient < 0;
    factors.coefficient = std::abs(factors.coefficient);
    if (out.empty()) out = negative ? "-" : "";
    else out += negative ? " - " : " + ";
    out += product_text(factors);
  }
  if (joined.empty()) return {constant_text(0, notation_), kAtom};
  return {out, joined.size() == 1 && out.front() != '-' ? kProduct : kSum};
}

FormulaText::Written FormulaText::product(int i) const {
  Factors factors;
  collect_factors(i, 1, true, factors);
  join_roots(factors);
  if (factors.coefficient == 0) return {constant_text(0, notation_), kAtom};
  const bool negative = factors.coefficient < 0;
  factors.coefficient = std::abs(factors.coefficient);
  return {(negative ? "-" : "") + product_text(factors), negative ? kSum : kProduct};
}

std::string FormulaText::power_text(int i, int power) const {
  const bool latex = notation_ == Notation::latex;
  if (power == 1) return within(i, kPower);
  if (latex && !named(i) && is_trigonometric(node(i).op))
    return function_text(node(i).op, notation_) + "^{" + std::to_string(power) + "}" +
           parenthesised(written(node(i).a).text, notation_);
  const std::string base = within(i, kAtom);
  if (latex)
    return (base.find('^') == std::string::npos ? base : '{' + base + '}') + "^{" +
           std::to_string(power) + '}';
  if (notation_ != Notation::c) return base + "**" + std::to_string(power);
  if (power > 4) return "pow(" + written(i).text + ", " + std::to_string(power) + ')';
  std::string out = base;
  for (int k = 1; k < power; ++k) out += " * " + base;
  return out;
}

std::string FormulaText::product_text(const Factors& factors) const {
  const bool latex = notation_ == Notation::latex;
  const std::string times = latex ? " \\, " : " * ";
  const bool fraction =
      latex && std::ranges::any_of(factors.powers, [](const auto& p) { return p.second < 0; });
  const auto alone = [&](int side) {  // a factor that needs no parentheses
    return fraction && std::ranges::count_if(factors.powers, [side](const auto& p) {
                         return p.second * side > 0;
                       }) == 1;
  };
  std::string above, below;
  int count_below = 0;
  const bool unit = factors.coefficient == 1;
  const auto append = [&](std::string& to, const std::string& factor) {
    to += (to.empty() ? "" : times) + factor;
  };
  if (!unit) above = constant_text(factors.coefficient, notation_);
  for (const auto& [base, power] : factors.powers) {
    if (power == 1 && unit && alone(1)) append(above, written(base).text);
    else if (power > 0) append(above, power_text(base, power));
    if (power < 0) {
      append(below, power == -1 && alone(-1) ? written(base).text : power_text(base, -power));
      count_below += notation_ == Notation::c ? -power : 1;
    }
  }
  if (above.empty()) above = notation_ == Notation::c ? "1.0" : "1";
  if (below.empty()) return above;
  if (latex) return "\\frac{" + above + "}{" + below + '}';
  return above + " / " + (count_below > 1 ? '(' + below + ')' : below);
}

FormulaText::Written FormulaText::call(int i) const {
  const Node& n = node(i);
  const std::string a = written(n.a).text, b = n.b < 0 ? "" : written(n.b).text;
  if (notation_ != Notation::latex)
    return {function_text(n.op, notation_) + '(' + a + (b.empty() ? "" : ", " + b) + ')', kAtom};
  if (n.op == Op::sqrt) return {"\\sqrt{" + a + '}', kAtom};
  if (n.op == Op::abs) return {"\\left|" + a + "\\right|", kAtom};
  if (n.op == Op::pow) return {within(n.a, kAtom) + "^{" + b + '}', kPower};
  return {
      function_text(n.op, notation_) + parenthesised(a + (b.empty() ? "" : ", " + b), notation_),
      kPower};
}

FormulaText::Written FormulaText::choice(int i) const {
  const Node& n = node(i);
  const bool latex = notation_ == Notation::latex, python = !latex && notation_ != Notation::c;
  const auto joined = [&](const char* in_latex, const char* in_python, const char* in_c,
                          int level) -> Written {
    return {within(n.a, level + 1) +
                (latex    ? in_latex
                 : python ? in_python
                          : in_c) +
                within(n.b, level + 1),
            level};
  };
  switch (n.op) {
    case Op::less: return joined(" < ", " < ", " < ", kComparison);
    case Op::less_equal: return joined(" \\le ", " <= ", " <= ", kComparison);
    case Op::equal:
      if (notation_ == Notation::sympy)
        return {"sympy.Eq(" + written(n.a).text + ", " + written(n.b).text + ')', kAtom};
      return joined(" = ", " == ", " == ", kComparison);
    // & and | of Python hold tighter than comparisons.
    case Op::both:
      return python ? Written{within(n.a, kAtom) + " & " + within(n.b, kAtom), kBoth}
                    : joined(" \\wedge ", "", " && ", kBoth);
    case Op::either:
      return python ? Written{within(n.a, kAtom) + " | " + within(n.b, kAtom), kEither}
                    : joined(" \\vee ", "", " || ", kEither);
    case Op::opposite: return {(latex ? "\\neg " : python ? "~" : "!") + within(n.a, kAtom), kNot};
    default: break;
  }
  const std::string c = written(n.a).text, x = written(n.b).text, y = written(n.c).text;
  if (latex)
    return {"\\begin{cases} " + x + " & " + c + " \\\\ " + y + " & \\text{else} \\end{cases}",
            kChoice};
  if (notation_ == Notation::numpy) return {"np.where(" + c + ", " + x + ", " + y + ')', kAtom};
  if (notation_ == Notation::sympy)
    return {"sympy.Piecewise((" + x + ", " + c + "), (" + y + ", True))", kAtom};
  return {'(' + within(n.a, kEither) + " ? " + x + " : " + y + ')', kAtom};
}

}  // namespace hamel::graph
