#include <hamel/framework/graph/export_c.hpp>

#include <cctype>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace hamel::graph {
namespace {

std::string literal(double x) {
  if (std::isnan(x)) return "NAN";
  if (std::isinf(x)) return x > 0 ? "INFINITY" : "(-INFINITY)";
  char text[40];
  std::snprintf(text, sizeof text, std::signbit(x) ? "(%a)" : "%a", x);
  return text;
}

const char* function_name(Op op) {
  switch (op) {
    case Op::min: return "hamel_min";
    case Op::max: return "hamel_max";
    case Op::abs: return "fabs";
    case Op::sqrt: return "sqrt";
    case Op::round: return "rint";
    case Op::exp: return "exp";
    case Op::log: return "log";
    case Op::asin: return "asin";
    case Op::acos: return "acos";
    case Op::atan: return "atan";
    case Op::sinh: return "sinh";
    case Op::cosh: return "cosh";
    case Op::tanh: return "tanh";
    case Op::atan2: return "atan2";
    case Op::pow: return "pow";
    case Op::sin_beyond: return "hamel_sin";
    case Op::cos_beyond: return "hamel_cos";
    default: return nullptr;
  }
}

const char* operator_name(Op op) {
  switch (op) {
    case Op::add: return " + ";
    case Op::subtract: return " - ";
    case Op::multiply: return " * ";
    case Op::divide: return " / ";
    case Op::less: return " < ";
    case Op::less_equal: return " <= ";
    case Op::equal: return " == ";
    case Op::both: return " && ";
    case Op::either: return " || ";
    default: return nullptr;
  }
}

std::string formula(const Instruction& i, const std::string& a, const std::string& b,
                    const std::string& c) {
  if (const char* name = function_name(i.op)) {
    return std::string(name) + '(' + a + (b.empty() ? "" : ", " + b) + ')';
  }
  if (const char* name = operator_name(i.op)) return a + name + b;
  if (i.op == Op::negate) return '-' + a;
  if (i.op == Op::opposite) return '!' + a;
  return a + " ? " + b + " : " + c;
}

bool is_identifier(const std::string& name) {
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0]))) return false;
  for (const char c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_') return false;
  }
  return true;
}

// Names in a comment: none of them ends it.
std::string listed(const char* of, const std::vector<std::string>& names) {
  std::string text = std::string("/* ") + of + ':';
  for (const std::string& name : names) {
    text += ' ';
    for (const char c : name) text += c == '*' || c == '/' || c == '\\' || c == '\n' ? '_' : c;
  }
  return text + " */\n";
}

}  // namespace

std::string c_preamble() {
  return "#include <math.h>\n"
         "/* Compile with -ffp-contract=off. */\n"
         "#define HAMEL_LARGEST_ANGLE " +
         literal(kLargestAngle) +
         "\n"
         "static inline double hamel_min(double a, double b) { return b < a ? b : a; }\n"
         "static inline double hamel_max(double a, double b) { return a < b ? b : a; }\n"
         "static inline double hamel_sin(double s, double x) {\n"
         "  return fabs(x) <= HAMEL_LARGEST_ANGLE ? s : sin(x);\n"
         "}\n"
         "static inline double hamel_cos(double c, double x) {\n"
         "  return fabs(x) <= HAMEL_LARGEST_ANGLE ? c : cos(x);\n"
         "}\n";
}

std::string c_function(const Program& program, const std::string& name) {
  if (!is_identifier(name))
    throw std::invalid_argument("graph::c_function: '" + name + "' is no name in C");
  const auto value = [&](int v) -> std::string {
    if (v < 0) return "";
    if (v < program.first_constant()) return "x[" + std::to_string(v) + ']';
    if (v >= program.first_result()) return 't' + std::to_string(v - program.first_result());
    return literal(program.constants()[static_cast<size_t>(v - program.first_constant())]);
  };
  std::string text = listed("x", program.inputs()) + listed("y", program.outputs()) + "void " +
                     name +
                     "(const double *restrict x, double *restrict y) {\n  (void)x;\n  (void)y;\n";
  int result = program.first_result();
  for (const Instruction& i : program.instructions()) {
    text += std::string(is_condition(i.op) ? "  const int " : "  const double ") + value(result++) +
            " = " + formula(i, value(i.a), value(i.b), value(i.c)) + ";\n";
  }
  for (size_t k = 0; k < program.results().size(); ++k) {
    text += "  y[" + std::to_string(k) + "] = " + value(program.results()[k]) + ";\n";
  }
  return text + "}\n";
}

}  // namespace hamel::graph
