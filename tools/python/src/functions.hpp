// Functions of Python that C++ calls, in any thread; who owns them; and the end of the interpreter.
//
// A callback may refer to the run that calls it. Such a circle is freed by Python's collector, to
// which every owner shows what it holds (tp_traverse, tp_clear of Simulation, Mechanism, Run and
// Result). So the owners hold the function, one count each (Functions); the closures in C++, which
// are copied with the system, hold a cell without a count, empty once the last owner is gone.
//
// Python ends while a thread of it may still run a system. The interpreter's lock is then not to be
// had any more: a thread that comes for it is ended where it stands. So before that (atexit) calls
// into Python throw, which ends the runs, and the end waits for those that are away from Python.
#pragma once

#include <atomic>
#include <memory>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>

namespace hamel::python {

namespace nb = nanobind;

/// In Python for a callback, from C++ without the lock. Throws Unfinished where Python ends.
class Entered {
 private:
  struct Check {
    Check();
  };
  Check check_;
  nb::gil_scoped_acquire lock_;
};

/// Away from Python for a long call: others may run. Throws Unfinished where Python ends.
class Away {
 public:
  Away();
  ~Away();
  Away(const Away&) = delete;
  Away& operator=(const Away&) = delete;

 private:
  PyThreadState* state_;
};

/// Does Python end?
bool python_ends();
/// Registers the wait for those that are away.
void bind_end();

/// A function of Python, as C++ has it; the lock is held where it is called.
class Function {
 public:
  template <class... Arguments>
  nb::object operator()(Arguments&&... arguments) const {
    return nb::borrow(object())(std::forward<Arguments>(arguments)...);
  }
  /// Throws where no owner is left.
  nb::handle object() const;

 private:
  friend class Functions;
  struct Cell {
    std::atomic<PyObject*> object = nullptr;
    long owners = 0;
  };
  explicit Function(std::shared_ptr<Cell> cell) : cell_(std::move(cell)) {}
  std::shared_ptr<Cell> cell_;
};

/// The functions of one owner. The lock is held wherever one is copied or goes.
class Functions {
 public:
  Functions() = default;
  Functions(const Functions& other) { add(other); }
  Functions(Functions&& other) noexcept : cells_(std::move(other.cells_)) { other.cells_.clear(); }
  Functions& operator=(Functions other) {
    cells_.swap(other.cells_);
    return *this;
  }
  ~Functions() { clear(); }

  bool empty() const { return cells_.empty(); }
  Function add(nb::handle object);
  void add(const Functions& others);
  bool any() const { return !cells_.empty(); }

  int show(visitproc visit, void* argument) const {
    for (const auto& cell : cells_) {
      PyObject* const object = cell->object;
      if (object == nullptr) continue;
      if (const int out = visit(object, argument); out != 0) return out;
    }
    return 0;
  }
  void clear();

 private:
  std::vector<std::shared_ptr<Function::Cell>> cells_;
};

/// tp_traverse and tp_clear of a bound class with a member `functions`.
template <class Owner>
struct Collected {
  static int traverse(PyObject* self, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(self));
    return nb::inst_ready(self) ? nb::inst_ptr<Owner>(self)->functions.show(visit, arg) : 0;
  }
  static int clear(PyObject* self) {
    if (nb::inst_ready(self)) nb::inst_ptr<Owner>(self)->functions.clear();
    return 0;
  }
  static inline PyType_Slot slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(traverse)},
                                       {Py_tp_clear, reinterpret_cast<void*>(clear)},
                                       {0, nullptr}};
};

}  // namespace hamel::python
