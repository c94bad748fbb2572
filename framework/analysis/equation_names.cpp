#include <hamel/framework/analysis/equation_names.hpp>

#include <algorithm>
#include <cctype>

namespace hamel {
namespace {

using graph::Notation;
using Texts = std::vector<std::string>;

bool is_greek(const std::string& word) {
  static const Texts letters = {"alpha", "beta",  "gamma",  "delta", "epsilon", "zeta", "eta",
                                "theta", "kappa", "lambda", "mu",    "nu",      "xi",   "rho",
                                "sigma", "tau",   "phi",    "chi",   "psi",     "omega"};
  return std::ranges::find(letters, word) != letters.end();
}

bool is_reserved(const std::string& name) {
  static const Texts words = {
      "and",  "as",     "auto",  "break",  "case",  "char",   "class", "const", "def",    "del",
      "do",   "double", "elif",  "else",   "enum",  "float",  "for",   "from",  "global", "goto",
      "if",   "import", "in",    "int",    "is",    "lambda", "long",  "not",   "np",     "or",
      "pass", "q",      "rate",  "return", "short", "sympy",  "t",     "try",   "u",      "while",
      "with", "xi",     "yield", "sin",    "cos",   "exp",    "log",   "pow",   "sqrt"};
  return std::ranges::find(words, name) != words.end();
}

}  // namespace

std::string latex_name(const std::string& name) {
  if (name.ends_with('\'')) return "\\dot{" + latex_name(name.substr(0, name.size() - 1)) + '}';
  if (const size_t dot = name.find('.'); dot != std::string::npos)
    return latex_name(name.substr(dot + 1)) + "_{" + latex_name(name.substr(0, dot)) + '}';
  const size_t digits = name.find_last_not_of("0123456789") + 1;
  const std::string word = name.substr(0, digits), index = name.substr(digits);
  std::string out;
  if (is_greek(word)) out = '\\' + word;
  else if (word.size() == 1) out = word;
  else {
    out = "\\mathrm{";
    for (const char c : word) out += c == '_' || c == ' ' ? "\\ " : std::string(1, c);
    out += '}';
  }
  return index.empty() ? out : out + "_{" + index + '}';
}

std::string latex_rate(const std::string& name) {
  if (name.ends_with('\'')) return "\\ddot{" + latex_name(name.substr(0, name.size() - 1)) + '}';
  if (const size_t dot = name.find('.'); dot != std::string::npos)
    return "\\dot{" + latex_name(name.substr(dot + 1)) + "}_{" + latex_name(name.substr(0, dot)) +
           '}';
  return "\\dot{" + latex_name(name) + '}';
}

std::string identifier(const std::string& name) {
  std::string out;
  for (const char c : name) {
    if (c == '\'') out += "_rate";
    else out += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  }
  if (out.empty() || std::isdigit(static_cast<unsigned char>(out[0]))) out = '_' + out;
  return is_reserved(out) ? out + '_' : out;
}

Texts names_of(const Texts& inputs, Notation notation) {
  Texts out = {"t"};
  for (size_t i = 1; i < inputs.size(); ++i) {
    std::string name = notation == Notation::latex ? latex_name(inputs[i]) : identifier(inputs[i]);
    while (std::ranges::find(out, name) != out.end())
      name += notation == Notation::latex ? "'" : "_";
    out.push_back(std::move(name));
  }
  return out;
}

std::string free_prefix(const Texts& names) {
  for (const char* letter : {"k", "c", "p", "z", "w"}) {
    if (std::ranges::none_of(names, [&](const std::string& name) {
          return name.starts_with(letter) && name.size() > 1 &&
                 (std::isdigit(static_cast<unsigned char>(name[1])) != 0 || name[1] == '_');
        }))
      return letter;
  }
  return "value_";
}

bool occurs(const std::string& name, const std::string& in) {
  const auto part = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '\\';
  };
  for (size_t at = in.find(name); at != std::string::npos; at = in.find(name, at + 1)) {
    const size_t end = at + name.size();
    if ((at == 0 || !part(in[at - 1])) && (end == in.size() || !part(in[end]))) return true;
  }
  return false;
}

}  // namespace hamel
