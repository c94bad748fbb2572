// Reading a formula: from muParser's byte code, which is in reverse Polish notation, to
// instructions.
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
