// Leftovers of xacro, the macro language in which many robots are written: ${formula} and
// $(command) in attributes, elements xacro:name. Not installed.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace hamel::mechanisms {

class UrdfMacros {
 public:
  /// An element begins. "" or why the text is refused: definitions and conditions; calls of macros
  /// without a definition are leftovers, which change no link that is written out.
  std::string begin(std::string_view element);
  /// An attribute's value, inside the elements `open`. Replaces macros in names by nothing, and
  /// numbers $(optenv NAME numbers) by these; "" or why the text is refused.
  std::string replace(const std::vector<std::string_view>& open, std::string_view element,
                      std::string_view attribute, std::string& value);

  /// Macros that were taken out, each once, and those replaced by their default.
  const std::vector<std::string>& replaced() const { return replaced_; }

 private:
  void note(const std::string& macro);

  std::set<std::string, std::less<>> properties_;  // with a value of their own
  std::string property_;                           // whose element is open
  std::vector<std::string> replaced_;
};

}  // namespace hamel::mechanisms
