// Places of a file's keys, for the mistakes that are found after it was read, and what a journal
// cannot have. Not installed.
#pragma once

#include <map>
#include <string>

namespace hamel {

/// The mistake behind the place, "file:line:column", of the longest part of the key that has one:
/// exclude[0].s, or exclude[0]. A key without any, as of a program, adds nothing.
std::string placed(const std::map<std::string, std::string>& where, std::string key,
                   const std::string& mistake);

/// Mistake of a folder for work with a system of the program: a journal, which has its name alone,
/// would be resumed with another one of that name.
std::string no_journal(const std::string& folder, const std::string& system);

}  // namespace hamel
