#include <hamel/framework/io/let_names.hpp>

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include <hamel/framework/io/expression.hpp>
#include <hamel/framework/io/formula_words.hpp>

namespace hamel {
namespace {

// Calls visit(begin, end, is a name) for the parts of a formula: its words, and what lies between
// them. A number is no name, nor is what follows its digits (2e3).
template <class Visit>
void each_part(const std::string& text, const Visit& visit) {
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = begin;
    const bool word = may_be_in_name(text[begin]);
    while (end < text.size() && may_be_in_name(text[end]) == word) ++end;
    visit(begin, end, word && std::isalpha(static_cast<unsigned char>(text[begin])) != 0);
    begin = end;
  }
}

}  // namespace

std::vector<std::string> LetNames::words(const std::string& text) {
  const std::vector<std::string> functions = Expression::functions();
  std::vector<std::string> out;
  each_part(text, [&](std::size_t begin, std::size_t end, bool name) {
    const std::string word = text.substr(begin, end - begin);
    if (name && word != "pi" && std::ranges::find(functions, word) == functions.end() &&
        std::ranges::find(out, word) == out.end())
      out.push_back(word);
  });
  return out;
}

LetNames::Expanded LetNames::expand(const std::string& text) const {
  Expanded out;
  std::vector<const std::string*> within;
  expand(text, nullptr, within, out);
  return out;
}

void LetNames::expand(const std::string& text, const At* at,
                      std::vector<const std::string*>& within, Expanded& out) const {
  const auto add = [&](const std::string& part, const At& place, bool moves) {
    for (std::size_t i = 0; i < part.size(); ++i) {
      out.origin.push_back(place.origin + (moves ? i : 0));
      out.let.push_back(place.let);
    }
    out.text += part;
  };
  each_part(text, [&](std::size_t begin, std::size_t end, bool name) {
    const std::string word = text.substr(begin, end - begin);
    const auto let = name ? texts_.find(word) : texts_.end();
    const At here = at != nullptr ? *at : At{begin, nullptr};
    if (let == texts_.end()) return add(word, here, at == nullptr);
    if (std::ranges::find(within, &let->first) != within.end()) {
      std::string chain;
      for (const std::string* each : within) chain += *each + " -> ";
      throw ExpressionError(fmt::format("'{0}' is made of itself: {1}{0}", word, chain),
                            here.origin);
    }
    const At inner{here.origin, &let->first};
    within.push_back(&let->first);
    add("(", inner, false);
    expand(let->second, &inner, within, out);
    add(")", inner, false);
    within.pop_back();
    if (out.text.size() > kMostCharacters)
      throw ExpressionError(
          fmt::format("more than {} characters, with the texts of its names", kMostCharacters),
          here.origin);
  });
}

}  // namespace hamel
