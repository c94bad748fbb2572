// Interpreter of a program, of one body or of bodies in lanes. Not installed.
//
// Instructions are reordered into runs of one operation, so that a choice by operation is made once
// a run; each result is that of the program. Lanes of 8 are two or four registers of a machine.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <hamel/framework/graph/program.hpp>

namespace hamel::graph {

/// Immutable; threads share it.
class Interpreter {
 public:
  explicit Interpreter(const Program& program);

  /// Doubles of work space for width bodies, 1, 4 or 8.
  static size_t work_size(const Program& program, int width) {
    return static_cast<size_t>(program.value_count()) * static_cast<size_t>(width);
  }
  /// y = outputs of x: value i of lane j at [i width + j].
  void run(int width, const double* x, double* y, double* work) const;

  struct Run {
    Op op;
    size_t begin, end;  // of operands
    size_t to;          // value of its first result; the others follow
  };
  struct Plan {  // of values numbered anew: inputs, constants, results in the order of the runs
    std::vector<double> constants;
    size_t inputs = 0;
    std::vector<Run> runs;
    std::vector<std::array<unsigned, 3>> operands;
    std::vector<unsigned> results;
  };

 private:
  Plan plan_;
};

}  // namespace hamel::graph
