// Notes in a printed report: a line each.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hamel {

/// How much of its notes a report prints: the beginning of each, on one line, or the whole text.
enum class Notes { brief, whole };

/// The beginning of a text of more than `width` characters (code points of UTF-8), which has at
/// most so many: to the end of a clause (";", ",", " (") in the second half of the width, or
/// else of a word, and " …". A shorter text as it is.
std::string brief(const std::string& text, size_t width);

/// A line "  note   TEXT" for each, TEXT in this column (from 0). Where brief lines of at most 100
/// columns leave something out, one more line states how to see all.
std::string note_lines(const std::vector<std::string>& notes, size_t column, Notes length);

}  // namespace hamel
