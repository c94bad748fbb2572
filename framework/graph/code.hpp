// Code: a program ready to call, for 1, 4 or 8 bodies at once.
//
// Machine code where the machine and the system allow it (x86-64 with AVX under Linux), else an
// interpreter: the caller sees no difference but in time. Results have the same bits in every form,
// where all that are not numbers count as one. With the environment variable HAMEL_NO_MACHINE_CODE
// the process has none.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include <hamel/framework/graph/program.hpp>

namespace hamel::graph {

/// May a program become machine code?
enum class Machine { allowed, refused };

/// Immutable; threads share it, each with work space of its own. Copies share their insides.
class Code {
 public:
  /// Code of a program for width bodies. Throws std::invalid_argument unless width is 1, 4 or 8.
  explicit Code(std::shared_ptr<const Program> program, int width = 1,
                Machine machine = Machine::allowed);
  ~Code();
  Code(const Code&);
  Code(Code&&) noexcept;
  Code& operator=(const Code&);
  Code& operator=(Code&&) noexcept;

  const Program& program() const;
  int width() const;
  bool is_machine_code() const;
  /// Doubles of the work space.
  size_t work_size() const;

  /// y = outputs at the inputs x. Input i of body j is x[i width + j], output k is y[k width + j].
  /// x, y and work are disjoint; alignment as that of double. The content of work is neither read
  /// nor kept.
  void operator()(const double* x, double* y, double* work) const;

 private:
  struct Insides;
  std::shared_ptr<const Insides> insides_;
};

/// Reason why programs of this process are interpreted; empty where they are machine code.
std::string machine_code_refused();

}  // namespace hamel::graph
