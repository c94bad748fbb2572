// Program: outputs of a recording as straight-line code.
//
// Instructions are in the order in which they were recorded, which every form of the program
// follows: interpreter, machine code, exported C, of one body or of several in lanes (code.hpp).
// All give the same bits; all that are not numbers count as one.
//
// Sines and cosines are expanded. With q = rint(2 x / pi) and r = x - q pi/2 in three parts of
// pi/2, of which the first two products are exact (Cody and Waite 1980), sin r and cos r are the
// polynomials of fdlibm (Sun Microsystems 1993), on |r| <= pi/4; q mod 4 selects. Beyond
// kLargestAngle they are those of the C library. Error: 1.5 units in the last place up to 1000 rad
// and 2.5 up to kLargestAngle where the value exceeds 1e-3, 4e-19 where it does not.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/graph/number.hpp>
#include <hamel/framework/graph/operation.hpp>

namespace hamel::graph {

/// Operands are numbers of values, -1 where there is none.
struct Instruction {
  Op op;
  int a = -1, b = -1, c = -1;
};

/// Immutable; threads share it. Values are numbered: inputs, constants, results of the
/// instructions.
class Program {
 public:
  using Outputs = std::vector<std::pair<std::string, Number>>;  // name, value

  /// Program of these outputs over the inputs of a recording, in their order.
  Program(const Recording& recording, const Outputs& outputs);

  /// Names, in the order of the arguments and of the results.
  const std::vector<std::string>& inputs() const { return inputs_; }
  const std::vector<std::string>& outputs() const { return outputs_; }
  /// Index of an output. Throws std::out_of_range.
  size_t output(const std::string& name) const;

  const std::vector<double>& constants() const { return constants_; }
  const std::vector<Instruction>& instructions() const { return instructions_; }
  /// Values of the outputs.
  const std::vector<int>& results() const { return results_; }
  /// Value of the first constant, and of the first instruction.
  int first_constant() const { return static_cast<int>(inputs_.size()); }
  int first_result() const { return first_constant() + static_cast<int>(constants_.size()); }
  int value_count() const { return first_result() + static_cast<int>(instructions_.size()); }

 private:
  void number_values(const Recording& recording, const std::vector<Number>& outputs);

  std::vector<std::string> inputs_, outputs_;
  std::vector<double> constants_;
  std::vector<Instruction> instructions_;
  std::vector<int> results_;
};

}  // namespace hamel::graph
