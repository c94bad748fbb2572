#include "functions.hpp"

#include <chrono>
#include <thread>

#include <hamel/framework/io/output_file.hpp>

namespace hamel::python {
namespace {

std::atomic<bool> ends = false;
std::atomic<long> away = 0;

// Before the interpreter ends, with its lock: those that are away come back. One that is in a
// callback of Python may take long, or not end.
void wait_for_those_away() {
  ends = true;
  constexpr auto kMost = std::chrono::seconds(10);
  const auto until = std::chrono::steady_clock::now() + kMost;
  const nb::gil_scoped_release free;
  while (away > 0 && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

void require_python() {
  if (ends) throw Unfinished("Python ends, and the run with it");
}

// Releases the lock unless Python ends.
PyThreadState* leave() {
  require_python();
  ++away;
  return PyEval_SaveThread();
}

}  // namespace

bool python_ends() { return ends; }

void bind_end() {
  nb::module_::import_("atexit").attr("register")(nb::cpp_function(&wait_for_those_away));
}

Entered::Check::Check() { require_python(); }

Away::Away() : state_(leave()) {}
Away::~Away() {
  PyEval_RestoreThread(state_);
  --away;
}

nb::handle Function::object() const {
  PyObject* const out = cell_->object;
  if (out == nullptr)
    throw std::runtime_error("this function of Python is gone, with all its owners");
  return out;
}

Function Functions::add(nb::handle object) {
  auto cell = std::make_shared<Function::Cell>();
  cell->object = object.inc_ref().ptr();
  cell->owners = 1;
  cells_.push_back(cell);
  return Function(std::move(cell));
}

void Functions::add(const Functions& others) {
  for (const auto& cell : others.cells_) {
    PyObject* const object = cell->object;
    if (object == nullptr) continue;
    Py_INCREF(object);
    ++cell->owners;
    cells_.push_back(cell);
  }
}

void Functions::clear() {
  const auto cells = std::move(cells_);
  cells_.clear();
  for (const auto& cell : cells) {
    PyObject* const object = cell->object;
    if (--cell->owners == 0) cell->object = nullptr;
    Py_XDECREF(object);
  }
}

}  // namespace hamel::python
