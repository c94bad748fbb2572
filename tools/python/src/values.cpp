// Values that cross between Python and C++.
#include "bindings.hpp"

namespace hamel::python {
namespace {

[[noreturn]] void wrong(const std::string& name, const char* expected, nb::handle value) {
  const nb::object printed = nb::repr(value);  // with surrogates escaped
  const nb::object bytes =
      nb::steal(PyUnicode_AsEncodedString(printed.ptr(), "utf-8", "backslashreplace"));
  if (!bytes.is_valid()) nb::raise_python_error();
  const std::string got(PyBytes_AS_STRING(bytes.ptr()), size_t(PyBytes_GET_SIZE(bytes.ptr())));
  throw ConfigError({name + ": got " + shortened(got) + ", expected " + expected});
}

constexpr size_t kMostNumbers = 100'000'000;

bool is_list(nb::handle value) {
  return nb::isinstance<nb::list>(value) || nb::isinstance<nb::tuple>(value);
}

}  // namespace

double number(const std::string& name, nb::handle value) {
  double out = 0;
  if (nb::try_cast(value, out)) return out;
  if (PyNumber_Check(value.ptr()) != 0 && PyObject_HasAttrString(value.ptr(), "__float__") != 0) {
    out = PyFloat_AsDouble(value.ptr());  // a scalar of NumPy
    if (PyErr_Occurred() == nullptr) return out;
    PyErr_Clear();
  }
  wrong(name, "a number", value);
}

std::vector<double> numbers(const std::string& name, nb::handle value) {
  if (PyFloat_Check(value.ptr()) || PyLong_Check(value.ptr())) return {number(name, value)};
  if (nb::isinstance<nb::str>(value)) wrong(name, "numbers", value);
  if (!is_list(value)) {
    if (nb::hasattr(value, "ravel")) {  // an array, row after row
      const nb::object list = value.attr("ravel")().attr("tolist")();
      if (!is_list(list)) wrong(name, "numbers", value);
      return numbers(name, list);
    }
    if (!nb::hasattr(value, "__iter__")) return {number(name, value)};
  }
  std::vector<double> out;
  for (const nb::handle entry : value) {
    if (!is_list(entry)) out.push_back(number(name, entry));
    else
      for (const nb::handle inner : entry) out.push_back(number(name, inner));
    if (out.size() > kMostNumbers) wrong(name, "at most 100,000,000 numbers", value);
  }
  return out;
}

SystemText system_text(const std::string& key, nb::handle system) {
  if (nb::isinstance<SystemText>(system)) return nb::cast<const SystemText&>(system);
  const std::string given = text(key, system);
  return given.find('\n') == std::string::npos ? SystemText{"", given}
                                               : SystemText{given, "system.toml"};
}

Start start_of(const std::string& name, nb::handle value) {
  Start out;
  for (const auto& [key, entry] : dict(name, value)) {
    const auto part = key_of(key);
    if (part == "configuration") out.configuration = numbers(part, entry);
    else if (part == "velocity") out.velocity = numbers(part, entry);
    else if (part == "momentum") out.momentum = numbers(part, entry);
    else
      throw ConfigError(
          {unknown_name("key of a start", part, {"configuration", "velocity", "momentum"})});
  }
  return out;
}

std::string utf8(const std::string& name, nb::handle text) {
  Py_ssize_t size = 0;
  const char* const bytes = PyUnicode_AsUTF8AndSize(text.ptr(), &size);
  if (bytes != nullptr) return {bytes, static_cast<size_t>(size)};
  PyErr_Clear();
  wrong(name, "a text without lone surrogates", text);
}

std::string text(const std::string& name, nb::handle value) {
  if (nb::isinstance<nb::str>(value)) return utf8(name, value);
  if (nb::hasattr(value, "__fspath__")) return utf8(name, nb::str(value.attr("__fspath__")()));
  wrong(name, "a text", value);
}

nb::dict dict(const std::string& name, nb::handle value) {
  if (nb::isinstance<nb::dict>(value)) return nb::borrow<nb::dict>(value);
  wrong(name, "a dict of names and values", value);
}

std::vector<std::string> texts(const std::string& name, nb::handle value) {
  if (nb::isinstance<nb::str>(value) || nb::hasattr(value, "__fspath__"))
    return {text(name, value)};
  if (!nb::hasattr(value, "__iter__")) wrong(name, "texts", value);
  std::vector<std::string> out;
  for (const nb::handle entry : value) out.push_back(text(name, entry));
  return out;
}

nb::object array(std::vector<double> values) {
  auto* own = new std::vector<double>(std::move(values));
  const nb::capsule owner(own,
                          [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  return nb::cast(Array(own->data(), {own->size()}, owner));
}

nb::object matrix(std::vector<double> values, size_t columns) {
  auto* own = new std::vector<double>(std::move(values));
  const nb::capsule owner(own,
                          [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  return nb::cast(Array(own->data(), {columns == 0 ? 0 : own->size() / columns, columns}, owner));
}

nb::object complex_array(const std::vector<std::complex<double>>& values) {
  using Numbers = std::vector<std::complex<double>>;
  auto* own = new Numbers(values);
  const nb::capsule owner(own, [](void* p) noexcept { delete static_cast<Numbers*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, std::complex<double>>(own->data(), {own->size()}, owner));
}

nb::object helper(const char* module, const char* name) {
  return nb::module_::import_((std::string("hamel.") + module).c_str()).attr(name);
}

InputSignal signal_of(const std::string& name, nb::handle value) {
  if (nb::isinstance<nb::str>(value) || nb::hasattr(value, "__fspath__"))
    return input_signal(text(name, value));
  InputTable table;
  if (nb::try_cast(value, table)) return table;
  if (nb::isinstance<nb::tuple>(value) && nb::len(value) == 2)
    return InputTable{numbers(name, value[nb::int_(0)]), numbers(name, value[nb::int_(1)])};
  return number(name, value);
}

}  // namespace hamel::python
