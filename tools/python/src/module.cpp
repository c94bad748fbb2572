#include "bindings.hpp"

#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/version.hpp>

namespace {

namespace nb = nanobind;

// hamel.ConfigError with its mistakes.
void bind_errors(nb::module_& m) {
  static nb::object config_error = nb::steal(PyErr_NewExceptionWithDoc(
      "hamel.ConfigError",
      "Every mistake of a configuration, one a line; raised before anything runs. mistakes: the "
      "lines.",
      PyExc_ValueError, nullptr));
  static nb::object unfinished = nb::steal(PyErr_NewExceptionWithDoc(
      "hamel.Unfinished", "A file that could not be completed; what was written is in FILE.part.",
      PyExc_RuntimeError, nullptr));
  m.attr("ConfigError") = config_error;
  m.attr("Unfinished") = unfinished;
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const hamel::ConfigError& error) {
      const nb::object raised = config_error(error.what());
      raised.attr("mistakes") = nb::cast(error.mistakes());
      PyErr_SetObject(config_error.ptr(), raised.ptr());
    } catch (const hamel::Unfinished& error) {
      PyErr_SetString(unfinished.ptr(), error.what());
    }
  });
}

}  // namespace

NB_MODULE(_hamel, m) {
  // Locks of threads (PyGILState) are those of the main interpreter alone.
  if (PyInterpreterState_Get() != PyInterpreterState_Main())
    throw nb::import_error("hamel: expected the main interpreter, got a subinterpreter");
  nb::set_leak_warnings(false);  // what a run holds at the end of Python is not freed
  m.doc() = "hamel by name; import hamel.";
  hamel::python::bind_end();
  bind_errors(m);
  hamel::python::bind_names(m);
  hamel::python::bind_config(m);
  hamel::python::bind_run(m);
  hamel::python::bind_result(m);
  hamel::python::bind_mechanism(m);
  hamel::python::bind_simulation(m);
  hamel::python::bind_steady(m);
  hamel::python::bind_study(m);
  hamel::python::bind_ensemble(m);
  hamel::python::bind_equations(m);
  hamel::python::bind_plan(m);
  hamel::python::bind_fit(m);
  hamel::python::bind_section(m);
  m.attr("__version__") = std::string(hamel::version());
}
