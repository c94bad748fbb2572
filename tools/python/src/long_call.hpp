// A long call of the library: in a thread of its own, while Python waits for it and for Ctrl-C.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <future>
#include <thread>

#include "bindings.hpp"

namespace hamel::python {

/// progress=True is a bar of tqdm.
inline nb::object progress_of(const nb::object& progress) {
  if (!nb::isinstance<nb::bool_>(progress)) return progress;
  return nb::cast<bool>(progress) ? helper("_progress", "bar")() : nb::none();
}

/// call(stop, report) with the interpreter free. Ctrl-C, exceptions of the progress and the end of
/// Python set stop; the exceptions are raised when the call has returned.
template <class Call>
auto long_call(const nb::object& progress, const Call& call) {
  std::atomic<bool> stop = false;
  std::exception_ptr raised;
  std::function<void(double)> report;
  if (progress.is_valid() && !progress.is_none()) {
    report = [&](double fraction) {
      if (python_ends()) stop = true;
      if (stop) return;
      const nb::gil_scoped_acquire gil;
      try {
        progress(fraction);
      } catch (...) {
        raised = std::current_exception();
        stop = true;
      }
    };
  }
  std::future<decltype(call(stop, report))> done;
  {
    const Away free;
    done = std::async(std::launch::async, [&] { return call(stop, report); });
    while (done.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
      if (python_ends()) stop = true;
      if (stop) continue;
      const nb::gil_scoped_acquire gil;
      if (PyErr_CheckSignals() != 0) {
        raised = std::make_exception_ptr(nb::python_error());
        stop = true;
      }
    }
  }
  auto result = done.get();
  if (raised) std::rethrow_exception(raised);
  return result;
}

/// A column of a table: numbers as an array.
inline nb::object column_of(const Table& table, const std::string& name) {
  return std::visit(
      [](const auto& values) {
        using Values = std::decay_t<decltype(values)>;
        if constexpr (std::is_same_v<Values, std::vector<double>>) return nb::cast(array(values));
        else return nb::cast(values);
      },
      table.column(name).values);
}
inline std::vector<std::string> columns_of(const Table& table) {
  std::vector<std::string> out;
  for (const TableColumn& column : table.columns) out.push_back(column.name);
  return out;
}
inline std::map<std::string, std::string> units_of(const Table& table) {
  std::map<std::string, std::string> out;
  for (const TableColumn& column : table.columns) out[column.name] = column.unit;
  return out;
}

}  // namespace hamel::python
