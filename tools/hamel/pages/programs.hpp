// Programs that are found at run time: where they are, and running them.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

namespace hamel::tools {

/// The path of a program: that of the environment variable, else the first of the names that is in
/// PATH; empty where there is none.
std::string find_program(const char* variable, std::initializer_list<const char*> names);

/// Runs a program, its output in the file `out`, its errors dropped, and waits for it. Throws
/// Unfinished where it cannot be started, fails, or takes longer than so many minutes, and when
/// this program is interrupted. purpose: "draw the figure".
void run_program(const std::vector<std::string>& words, const std::string& out,
                 const std::string& purpose, int minutes = 2);

}  // namespace hamel::tools
