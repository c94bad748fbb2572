// Names for parts of formulas, [let] in a file: each is replaced by its text, in parentheses.
// What occurs in a formula several times so is computed once all the same (Expression). Not
// installed.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace hamel {

class LetNames {
 public:
  /// A formula, and for each of its characters where it comes from.
  struct Expanded {
    std::string text;
    std::vector<std::size_t> origin;      // in the text that was given
    std::vector<const std::string*> let;  // whose text it stands in; null: the text that was given
  };

  bool empty() const { return texts_.empty(); }
  void set(const std::string& name, const std::string& text) { texts_[name] = text; }
  const std::map<std::string, std::string>& texts() const { return texts_; }
  /// Throws ExpressionError where a name is made of itself, or more than kMostCharacters come out.
  Expanded expand(const std::string& text) const;

  /// The words of a formula that are no function.
  static std::vector<std::string> words(const std::string& text);

 private:
  struct At {
    std::size_t origin;
    const std::string* let;
  };
  void expand(const std::string& text, const At* at, std::vector<const std::string*>& within,
              Expanded& out) const;
  std::map<std::string, std::string> texts_;
};

}  // namespace hamel
