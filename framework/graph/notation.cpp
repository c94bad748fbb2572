#include <hamel/framework/graph/notation.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace hamel::graph {
namespace {

struct FunctionNames {
  Op op;
  const char *latex, *c, *numpy, *sympy;
};
constexpr FunctionNames kFunctions[] = {
    {Op::sin, "\\sin", "sin", "np.sin", "sympy.sin"},
    {Op::cos, "\\cos", "cos", "np.cos", "sympy.cos"},
    {Op::sqrt, "\\sqrt", "sqrt", "np.sqrt", "sympy.sqrt"},
    {Op::exp, "\\exp", "exp", "np.exp", "sympy.exp"},
    {Op::log, "\\ln", "log", "np.log", "sympy.log"},
    {Op::asin, "\\arcsin", "asin", "np.arcsin", "sympy.asin"},
    {Op::acos, "\\arccos", "acos", "np.arccos", "sympy.acos"},
    {Op::atan, "\\arctan", "atan", "np.arctan", "sympy.atan"},
    {Op::sinh, "\\sinh", "sinh", "np.sinh", "sympy.sinh"},
    {Op::cosh, "\\cosh", "cosh", "np.cosh", "sympy.cosh"},
    {Op::tanh, "\\tanh", "tanh", "np.tanh", "sympy.tanh"},
    {Op::atan2, "\\operatorname{atan2}", "atan2", "np.arctan2", "sympy.atan2"},
    {Op::pow, "", "pow", "np.power", "sympy.Pow"},
    {Op::min, "\\min", "fmin", "np.minimum", "sympy.Min"},
    {Op::max, "\\max", "fmax", "np.maximum", "sympy.Max"},
    {Op::abs, "", "fabs", "np.abs", "sympy.Abs"},
    {Op::round, "\\operatorname{rint}", "rint", "np.rint", "sympy.Function('rint')"},
};

// 1.5e-07 as a product with a power of ten.
std::string with_power_of_ten(const std::string& text) {
  const size_t e = text.find('e');
  if (e == std::string::npos) return text;
  return text.substr(0, e) + " \\cdot 10^{" + std::to_string(std::stoi(text.substr(e + 1))) + '}';
}

}  // namespace

std::string function_text(Op op, Notation notation) {
  for (const FunctionNames& f : kFunctions) {
    if (f.op != op) continue;
    switch (notation) {
      case Notation::latex: return f.latex;
      case Notation::c: return f.c;
      case Notation::numpy: return f.numpy;
      case Notation::sympy: return f.sympy;
    }
  }
  return "";
}

std::string constant_text(double x, Notation notation) {
  char text[40];
  if (notation == Notation::latex) {
    std::snprintf(text, sizeof text, "%.6g", x);
    return with_power_of_ten(text);
  }
  if (std::isnan(x)) return notation == Notation::c ? "NAN" : "float('nan')";
  if (std::isinf(x)) {
    const std::string size = notation == Notation::c ? "INFINITY" : "float('inf')";
    return x > 0 ? size : '-' + size;
  }
  for (int digits = 15; digits <= 17; ++digits) {  // the fewest that give x
    std::snprintf(text, sizeof text, "%.*g", digits, x);
    if (std::strtod(text, nullptr) == x) break;
  }
  std::string out(text);
  if (notation == Notation::c && out.find_first_of(".e") == std::string::npos) out += ".0";
  return out;
}

}  // namespace hamel::graph
