#include <hamel/framework/io/expression.hpp>

#include <algorithm>
#include <numbers>

#include <fmt/format.h>
#include <muParser.h>

#include <hamel/framework/io/errors.hpp>

namespace hamel {

struct Expression::Compiled {
  mu::Parser parser;
  std::vector<double> values;
  std::vector<std::string> used;
};

Expression::Expression(const std::string& text, const std::vector<std::string>& names)
    : compiled_(std::make_shared<Compiled>()) {
  mu::Parser& parser = compiled_->parser;
  compiled_->values.resize(std::max<size_t>(1, names.size()));
  try {
    parser.DefineNameChars("0123456789_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.");
    parser.DefineConst("pi", std::numbers::pi);
    for (size_t i = 0; i < names.size(); ++i) parser.DefineVar(names[i], &compiled_->values[i]);
    parser.SetExpr(text);
    for (const auto& [name, place] : parser.GetUsedVar()) compiled_->used.push_back(name);
    parser.Eval();
  } catch (const mu::Parser::exception_type& error) {
    const auto at = static_cast<size_t>(std::max(0, static_cast<int>(error.GetPos())));
    const std::string token = error.GetToken();
    if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN && !token.empty())
      throw ExpressionError(unknown_name("name", token, names), at);
    throw ExpressionError(error.GetMsg(), at);
  }
  for (const std::string& name : compiled_->used) {
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw ExpressionError(unknown_name("name", name, names), text.find(name));
  }
}

double Expression::operator()(std::span<const double> values) const {
  std::copy(values.begin(), values.end(), compiled_->values.begin());
  return compiled_->parser.Eval();
}

const std::vector<std::string>& Expression::used() const { return compiled_->used; }

}  // namespace hamel
