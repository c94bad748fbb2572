// Text of what hamel describe has found: lines with their keys.
#include "words/description_text.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "words/screen.hpp"

namespace hamel::tools {
namespace {

// A member of an entry of a list, as the line of the entry shows it.
std::string member_text(const std::string& name, const nlohmann::ordered_json& member) {
  std::string text = member.is_string() ? member.get<std::string>() : member.dump();
  if (member.is_null()) text = "not set";
  if (name == "name" || name == "group") return fmt::format("{:<14}", text);
  if (name == "default") return fmt::format(" = {:<12}", text);
  if (name == "unit") return fmt::format(" [{}]", text);
  if (name == "range") return text.empty() ? "" : fmt::format("  {};", text);
  if (name == "domain") return fmt::format("; domain {}", text);
  if (name == "symmetric") return text == "true" ? "; symmetric" : "; not symmetric";
  return fmt::format("  {}", text);
}

// Lines of a list of objects: one for each, indented.
void print_entries(const std::string& key, const nlohmann::ordered_json& entries) {
  say("  {}\n", key);
  for (const nlohmann::ordered_json& entry : entries) {
    std::string line;
    for (const auto& [name, member] : entry.items()) line += member_text(name, member);
    say("    {}\n", line);
  }
}

// Lines of an object: one for each member, the key before the first.
void print_members(const std::string& key, const nlohmann::ordered_json& object) {
  for (const auto& [name, member] : object.items())
    say("  {:<12} {} {}\n", name == object.begin().key() ? key : "", name, member.dump());
}

void print_value(const std::string& key, const nlohmann::ordered_json& value) {
  if (value.is_object()) return print_members(key, value);
  if (value.is_array() && value.empty()) return;
  if (value.is_array() && value.front().is_object()) return print_entries(key, value);
  const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (!text.empty()) say("  {:<12} {}\n", key, text);
}

}  // namespace

void print_description(const nlohmann::ordered_json& description, Notes length) {
  for (const auto& [key, value] : description.items()) {
    if (key != "notes") print_value(key, value);
    else say("{}", note_lines(value.get<std::vector<std::string>>(), 15, length));
  }
}

}  // namespace hamel::tools
