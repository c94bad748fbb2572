// Program as a function in C.
#pragma once

#include <string>

#include <hamel/framework/graph/program.hpp>

namespace hamel::graph {

/// Lines of C99 before the functions of programs.
std::string c_preamble();

/// void name(const double *x, double *y): y = outputs of x, in the order of the program's names,
/// which are listed in a comment. Compiled with -ffp-contract=off (and without -ffast-math) it
/// gives the same bits as Code. Throws std::invalid_argument where name is no identifier.
std::string c_function(const Program& program, const std::string& name);

}  // namespace hamel::graph
