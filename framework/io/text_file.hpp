// Files that a user wrote, read as a whole.
#pragma once

#include <string>

namespace hamel {

/// The most that a file of a user, or a text in its place, may hold.
constexpr size_t kMaxText = 4'000'000;  // characters

/// The text of a file. ConfigError "what: cannot read 'path': ..." when it is not there, larger
/// than kMaxText, or no regular file: a pipe may keep a program waiting for ever.
std::string read_text_file(const std::string& what, const std::string& path);

}  // namespace hamel
