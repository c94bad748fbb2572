#include <hamel/framework/io/expression.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <iterator>
#include <numbers>
#include <optional>

#include <fmt/format.h>
#include <muParser.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/expression_rules.hpp>

namespace hamel {

namespace {

using namespace rules;

// The names that muParser accepts; the instructions call the rules themselves.
double call_one(void* rule, double x) { return static_cast<const Rule*>(rule)->value(x, 0); }
double call_two(void* rule, double x, double y) {
  return static_cast<const Rule*>(rule)->value(x, y);
}
// A number where a formula goes on, read by muParser: 1e-400 would be 0 there.
int read_number(const char* text, int* place, double* out) {
  if (std::isdigit(static_cast<unsigned char>(*text)) == 0 && *text != '.') return 0;
  const auto [behind, why] = std::from_chars(text, text + std::strlen(text), *out);
  if (why == std::errc::result_out_of_range)
    throw ExpressionError(
        fmt::format("the number {} is too large or too small", std::string(text, behind)),
        static_cast<size_t>(*place));
  *place += static_cast<int>(behind - text);
  return behind == text ? 0 : 1;
}
double minus(double x) { return -x; }
double plus(double x) { return x; }

constexpr const char* kLetters =
    "0123456789_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.'";

}  // namespace

// From muParser's byte code, which is in reverse Polish notation, to instructions.
class Expression::Reader {
 public:
  Reader(Expression& out, const std::string& text, const std::vector<std::string>& variables,
         const std::map<std::string, double>& constants)
      : out_(out),
        text_(text),
        parser_(of_no_names()),
        values_(variables.size() + 1, 0.0),
        variable_slot_(variables.size()) {
    parser_.EnableOptimizer(false);  // a copy does not take that over
    names_ = variables;
    for (const auto& [name, value] : constants) {
      if (std::find(variables.begin(), variables.end(), name) != variables.end())
        throw ExpressionError(fmt::format("two things are called '{}'", name), 0);
      names_.push_back(name);
      if (occurs(name)) parser_.DefineConst(name, value);
    }
    for (size_t i = 0; i < variables.size(); ++i)
      if (occurs(variables[i])) parser_.DefineVar(variables[i], &values_[i]);
  }

  void read() {
    if (text_.size() > kMostCharacters)
      throw ExpressionError(
          fmt::format("{} characters, more than {}", text_.size(), kMostCharacters), 0);
    if (const size_t at = text_.find('\0'); at != std::string::npos)  // where muParser ends
      throw ExpressionError("a character U+0000", at);
    try {
      parser_.SetExpr(text_);
      parser_.Eval();  // compiles
    } catch (const mu::Parser::exception_type& error) {
      refuse(error);
    }
    const mu::ParserByteCode& code = parser_.GetByteCode();
    for (size_t i = 0; i < code.GetSize(); ++i) take(code.GetBase()[i]);
    if (stack_.size() != 1) throw ExpressionError("expected one value", 0);
    out_.result_ = stack_.back();
    leave_out_unused();
    out_.slopes_.resize(out_.slots_.size());
  }

 private:
  // Made once: to define the functions costs as much as to read seven formulas.
  static const mu::Parser& of_no_names() {
    static const mu::Parser made = [] {
      mu::Parser parser;
      parser.DefineNameChars(kLetters);
      parser.AddValIdent(read_number);
      parser.ClearFun();
      parser.ClearConst();
      parser.ClearInfixOprt();
      parser.DefineInfixOprt("-", minus);
      parser.DefineInfixOprt("+", plus);
      for (const Rule& rule : kFunctions) {
        void* data = const_cast<Rule*>(&rule);
        if (rule.arguments == 1) parser.DefineFunUserData(rule.name, call_one, data);
        else parser.DefineFunUserData(rule.name, call_two, data);
      }
      parser.DefineConst("pi", std::numbers::pi);
      return parser;
    }();
    return made;
  }

  // Only such a name is made known to muParser: a file has many, a formula few.
  bool occurs(const std::string& name) const {
    return text_.find(name) != std::string::npos && allows(name);
  }
  [[noreturn]] void refuse(const mu::Parser::exception_type& error) const {
    const size_t at =
        std::min(text_.size(), static_cast<size_t>(std::max(0, static_cast<int>(error.GetPos()))));
    std::vector<std::string> unusable;  // with a blank, for example
    std::ranges::copy_if(names_, std::back_inserter(unusable),
                         [](const std::string& name) { return !allows(name); });
    for (const std::string& name : unusable)
      if (const size_t there = text_.find(name); !name.empty() && there != std::string::npos)
        throw ExpressionError(cannot_stand(name), there);
    if (error.GetCode() != mu::ecUNASSIGNABLE_TOKEN) throw ExpressionError(error.GetMsg(), at);
    const size_t end = std::min(text_.size(), text_.find_first_not_of(kLetters, at));
    if (end == at) {
      size_t next = at + 1;  // of a letter in UTF-8 all bytes
      while (next < text_.size() && (text_[next] & 0xC0) == 0x80) ++next;
      throw ExpressionError(fmt::format("'{}' has no meaning here", text_.substr(at, next - at)),
                            at);
    }
    std::vector<std::string> known = names_;
    if (end < text_.size() && text_[end] == '(') known = functions();
    std::string what = unknown_name("name", text_.substr(at, end - at), known);
    for (const std::string& name : unusable)
      if (what.ends_with(fmt::format("did you mean '{}'?", name))) what += " " + cannot_stand(name);
    throw ExpressionError(what, at);
  }
  static std::string cannot_stand(const std::string& name) {
    return fmt::format(
        "'{}' is not allowed in a formula: expected a letter, then letters, digits, _ . '", name);
  }

  void leave_out_unused() {
    std::vector<bool> needed(out_.slots_.size(), false);
    needed[out_.result_] = true;
    for (size_t k = out_.instructions_.size(); k-- > 0;) {
      const Instruction& i = out_.instructions_[k];
      if (needed[i.to]) needed[i.a] = needed[i.b] = needed[i.c] = true;
    }
    std::erase_if(out_.instructions_, [&](const Instruction& i) { return !needed[i.to]; });
    std::erase_if(out_.inputs_, [&](const auto& input) { return !needed[input.first]; });
  }

  void take(const mu::SToken& token) {
    switch (token.Cmd) {
      case mu::cmVAL: push(constant(token.Val.data2)); return;
      case mu::cmVAR: push(variable(static_cast<size_t>(token.Val.ptr - values_.data()))); return;
      case mu::cmFUNC: call(token); return;
      case mu::cmIF: conditions_.push_back({pop(), 0}); return;
      case mu::cmELSE: conditions_.back().second = pop(); return;
      case mu::cmENDIF: {
        const size_t no = pop();
        const auto [condition, yes] = conditions_.back();
        conditions_.pop_back();
        push(emit(nullptr, condition, yes, no));
        return;
      }
      case mu::cmEND: return;
      default: break;
    }
    const Rule* rule = rule_of(token.Cmd);
    if (rule == nullptr)
      throw ExpressionError("'=' gives no value; '==' compares",
                            std::min(text_.size(), text_.find('=')));
    const size_t y = pop(), x = pop();
    const double power = token.Cmd == mu::cmPOW && out_.fixed_[y] ? out_.slots_[y] : 0;
    const size_t square = power == 2 || power == 3 ? emit(&kSquare, x, x, x) : x;
    if (power == 2) push(square);
    else if (power == 3) push(emit(rule_of(mu::cmMUL), square, x, x));
    else push(emit(rule, x, y, y));
  }
  void call(const mu::SToken& token) {
    if (token.Fun.cb._pRawFun == reinterpret_cast<mu::erased_fun_type>(&plus)) return;
    const auto* rule = static_cast<const Rule*>(token.Fun.cb._pUserData);
    if (rule == nullptr) rule = &kMinus;
    const size_t y = pop(), x = rule->arguments == 2 ? pop() : y;
    push(emit(rule, x, y, y));
  }

  void push(size_t slot) { stack_.push_back(slot); }
  size_t pop() {
    if (stack_.empty()) throw ExpressionError("a value is missing", 0);
    const size_t slot = stack_.back();
    stack_.pop_back();
    return slot;
  }
  size_t slot(double value, bool fixed) {
    out_.slots_.push_back(value);
    out_.fixed_.push_back(fixed);
    return out_.slots_.size() - 1;
  }
  size_t constant(double value) { return slot(value, true); }
  size_t variable(size_t i) {
    if (!variable_slot_[i]) {
      variable_slot_[i] = slot(0, false);
      out_.inputs_.emplace_back(*variable_slot_[i], i);
    }
    return *variable_slot_[i];
  }
  static Op op_of(const Rule* rule) {
    if (rule == nullptr) return Op::choose;
    if (rule == rule_of(mu::cmADD)) return Op::add;
    if (rule == rule_of(mu::cmSUB)) return Op::subtract;
    if (rule == rule_of(mu::cmMUL)) return Op::multiply;
    return rule == &kSquare ? Op::square : Op::rule;
  }
  // The value of constants at once; what was computed already not again.
  size_t emit(const Rule* rule, size_t a, size_t b, size_t c) {
    if (rule == nullptr && out_.fixed_[a]) return out_.slots_[a] != 0 ? b : c;
    if (out_.fixed_[a] && out_.fixed_[b] && out_.fixed_[c])
      return constant(rule->value(out_.slots_[a], out_.slots_[b]));
    for (const size_t factor : {a, b}) {  // nothing that an input of zero is a factor of
      if (rule == rule_of(mu::cmMUL) && out_.fixed_[factor] && out_.slots_[factor] == 0)
        return constant(0);
    }
    for (const Instruction& i : out_.instructions_) {
      if (i.rule == rule && i.a == a && i.b == b && i.c == c) return i.to;
    }
    const size_t to = slot(0, false);
    out_.instructions_.push_back({op_of(rule), rule, a, b, c, to});
    return to;
  }

  Expression& out_;
  const std::string& text_;
  mu::Parser parser_;
  std::vector<double> values_;
  std::vector<std::optional<size_t>> variable_slot_;
  std::vector<std::string> names_;
  std::vector<size_t> stack_;
  std::vector<std::pair<size_t, size_t>> conditions_;
};

Expression::Expression(const std::string& text, const std::vector<std::string>& variables,
                       const std::map<std::string, double>& constants) {
  Reader(*this, text, variables, constants).read();
}

double Expression::operator()(std::span<const double> values) const {
  for (const auto& [slot, variable] : inputs_) slots_[slot] = values[variable];
  for (const Instruction& i : instructions_) slots_[i.to] = value_of(i);
  return slots_[result_];
}

double Expression::value_of(const Instruction& i) const {
  const double x = slots_[i.a], y = slots_[i.b];
  switch (i.op) {
    case Op::add: return x + y;
    case Op::subtract: return x - y;
    case Op::multiply: return x * y;
    case Op::square: return x * x;
    case Op::rule: return i.rule->value(x, y);
    case Op::choose: return x != 0 ? y : slots_[i.c];
  }
  return 0;
}

void Expression::pass_slope(const Instruction& i) const {
  const double x = slots_[i.a], y = slots_[i.b], slope = slopes_[i.to];
  double &by_first = slopes_[i.a], &by_second = slopes_[i.b];
  switch (i.op) {
    case Op::add: by_first += slope, by_second += slope; return;
    case Op::subtract: by_first += slope, by_second -= slope; return;
    case Op::multiply: by_first += slope * y, by_second += slope * x; return;
    case Op::square: by_first += 2 * slope * x; return;
    case Op::choose: (x != 0 ? by_second : slopes_[i.c]) += slope; return;
    case Op::rule: break;
  }
  if (!fixed_[i.a]) by_first += slope * i.rule->by_first(x, y);
  if (i.rule->arguments == 2 && !fixed_[i.b]) by_second += slope * i.rule->by_second(x, y);
}

double Expression::differentiate(std::span<const double> values, double factor,
                                 std::span<double> out) const {
  const double value = (*this)(values);
  std::fill(slopes_.begin(), slopes_.end(), 0.0);
  slopes_[result_] = factor;
  for (size_t k = instructions_.size(); k-- > 0;) {
    if (slopes_[instructions_[k].to] != 0) pass_slope(instructions_[k]);
  }
  for (const auto& [slot, variable] : inputs_) out[variable] += slopes_[slot];
  return value;
}

double Expression::rate_of(const Instruction& i) const {
  const double x = slots_[i.a], y = slots_[i.b], of_x = slopes_[i.a], of_y = slopes_[i.b];
  switch (i.op) {
    case Op::add: return of_x + of_y;
    case Op::subtract: return of_x - of_y;
    case Op::multiply: return of_x * y + x * of_y;
    case Op::square: return 2 * x * of_x;
    case Op::choose: return x != 0 ? of_y : slopes_[i.c];
    case Op::rule: break;
  }
  // No slope of a constant argument, which may be infinite there.
  const double by_first = of_x == 0 ? 0 : of_x * i.rule->by_first(x, y);
  return i.rule->arguments == 1 || of_y == 0 ? by_first : by_first + of_y * i.rule->by_second(x, y);
}

double Expression::rate(std::span<const double> values, std::span<const double> rates) const {
  std::fill(slopes_.begin(), slopes_.end(), 0.0);
  for (const auto& [slot, variable] : inputs_) {
    slots_[slot] = values[variable];
    slopes_[slot] = rates[variable];
  }
  for (const Instruction& i : instructions_) {
    slots_[i.to] = value_of(i);
    slopes_[i.to] = rate_of(i);
  }
  return slopes_[result_];
}

std::vector<size_t> Expression::used() const {
  std::vector<size_t> out;
  for (const auto& [slot, variable] : inputs_) out.push_back(variable);
  return out;
}

bool Expression::linear() const {
  std::vector<int> degrees(slots_.size(), 0);  // 2: any that is not 0 or 1
  for (const auto& [slot, variable] : inputs_) degrees[slot] = 1;
  for (const Instruction& i : instructions_) {
    const int a = degrees[i.a], b = degrees[i.b];
    const bool divides = i.rule == rule_of(mu::cmDIV);
    int degree = 2;
    if (i.op == Op::add || i.op == Op::subtract || i.rule == &kMinus) degree = std::max(a, b);
    else if (i.op == Op::multiply || (divides && b == 0)) degree = a + b;
    degrees[i.to] = std::min(degree, 2);
  }
  return degrees[result_] < 2;
}

bool Expression::may_jump() const {
  return std::ranges::any_of(instructions_, [](const Instruction& i) {
    return i.op == Op::choose || (i.rule->by_first == kNone && i.rule->by_second == kNone);
  });
}

bool Expression::allows(const std::string& name) {
  return !name.empty() && name.size() <= 100 &&
         name.find_first_not_of(kLetters) == std::string::npos &&
         (std::isalpha(static_cast<unsigned char>(name[0])) != 0) && name != "pi" &&
         std::ranges::none_of(kFunctions, [&](const Rule& rule) { return rule.name == name; });
}

std::vector<std::string> Expression::functions() {
  std::vector<std::string> out;
  for (const Rule& rule : kFunctions) out.emplace_back(rule.name);
  return out;
}

}  // namespace hamel
