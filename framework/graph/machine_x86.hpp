// Machine code of a program, for x86-64 with AVX. Not installed.
//
// Leaf code: it calls nothing. A function of the C library ends a segment of the code; it is called
// for each lane between two segments. Angles beyond kLargestAngle are found by the code and left to
// the interpreter.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <hamel/framework/graph/executable_memory.hpp>
#include <hamel/framework/graph/program.hpp>

namespace hamel::graph {

/// Reason why this machine cannot run the code; empty where it can.
std::string machine_code_refusal();

/// Address of lanes, in doubles behind its base.
struct LaneAddress {
  enum class Base { arguments, work, table } base;
  size_t offset;
};

/// Call of a function of the C library for each lane.
struct LibraryCall {
  Op op;
  LaneAddress a, b;
  size_t to;  // in the work space
};

/// Code that ends with calls.
struct Segment {
  size_t begin;  // in bytes
  std::vector<LibraryCall> calls;
};

/// Instructions of a program for `lanes` bodies (1 or 4) whose values lie `stride` doubles apart.
struct EmittedCode {
  std::vector<std::uint8_t> bytes;
  std::vector<Segment> segments;
  std::vector<double> table;  // constants, each repeated for each lane, behind masks
  size_t slots = 0;           // of lanes, in the work space; the first holds the largest angle
  bool has_angles = false;
};
EmittedCode emit(const Program& program, int lanes, int stride);

/// Immutable; threads share it.
class MachineCode {
 public:
  /// Code for width bodies, 1, 4 or 8; null where the machine or the system refuses it.
  static std::unique_ptr<const MachineCode> make(const Program& program, int width);

  /// Doubles of work space.
  size_t work_size() const { return code_.slots * lanes_; }
  bool has_angles() const { return code_.has_angles; }
  /// y = outputs of x, as Interpreter::run. False where an angle lies beyond kLargestAngle: y is
  /// then invalid.
  bool run(const double* x, double* y, double* work) const;

 private:
  MachineCode(EmittedCode code, int width);
  using Function = void (*)(const double* x, double* y, double* work, const double* table);
  bool run_lanes(const double* x, double* y, double* work) const;
  Function at(std::size_t byte) const;

  EmittedCode code_;
  ExecutableMemory memory_;
  size_t width_, lanes_;
  Function whole_ = nullptr;  // of all bodies, where it calls nothing
};

}  // namespace hamel::graph
