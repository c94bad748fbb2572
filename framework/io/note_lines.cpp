#include <hamel/framework/io/note_lines.hpp>

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace hamel {
namespace {

constexpr size_t kColumns = 100;

bool begins_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }

size_t characters(std::string_view text) {
  return static_cast<size_t>(std::ranges::count_if(text, begins_character));
}

// The bytes of the first characters.
std::string_view first(std::string_view text, size_t count) {
  size_t end = 0;
  for (; end < text.size(); ++end)
    if (begins_character(text[end]) && count-- == 0) break;
  return text.substr(0, end);
}

// The bytes of the text up to its last clause; 0 where it has none.
size_t end_of_clause(std::string_view text) {
  size_t last = 0;
  for (const std::string_view mark : {"; ", ", ", " ("}) {
    const size_t place = text.rfind(mark);
    if (place != text.npos) last = std::max(last, place);
  }
  return last;
}

}  // namespace

std::string brief(const std::string& text, size_t width) {
  if (characters(text) <= width) return text;
  constexpr std::string_view rest = " …";
  // (The character behind the room tells whether a clause or a word ends with it.)
  const std::string_view room = first(text, width - characters(rest) + 1);
  size_t end = end_of_clause(room);
  if (characters(room.substr(0, end)) < width / 2) {
    end = room.rfind(' ');
    if (end == room.npos || end == 0) end = first(text, width - characters(rest)).size();
  }
  return fmt::format("{}{}", room.substr(0, end), rest);
}

std::string note_lines(const std::vector<std::string>& notes, size_t column, Notes length) {
  std::string out;
  bool cut = false;
  for (const std::string& note : notes) {
    const std::string text = length == Notes::brief ? brief(note, kColumns - column) : note;
    cut = cut || text != note;
    out += fmt::format("  {:<{}}{}\n", "note", column - 2, text);
  }
  if (cut)
    out += fmt::format("{:{}}(--verbose: notes in full; in C++ and Python: .notes)\n", "", column);
  return out;
}

}  // namespace hamel
