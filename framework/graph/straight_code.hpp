// Instructions to emit: polynomials of angles as they are, and the largest of these angles. Not
// installed.
#pragma once

#include <utility>
#include <vector>

#include <hamel/framework/graph/program.hpp>

namespace hamel::graph {

struct StraightCode {
  std::vector<std::pair<int, Instruction>> instructions;  // value, its instruction
  std::vector<int> results;                               // values
  int values = 0;                                         // their number
  int largest_angle = -1;                                 // value; -1: no angles
};

/// Instructions of a program in its order. The choice between a polynomial and the C library is the
/// polynomial; the value largest_angle is the largest |x| of all angles x, or no number, by which
/// the caller sees whether that choice is right.
StraightCode straighten(const Program& program);

}  // namespace hamel::graph
