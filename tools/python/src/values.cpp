// Values that cross between Python and C++.
#include "bindings.hpp"

namespace hamel::python {
namespace {

[[noreturn]] void wrong(const std::string& name, const char* expected, nb::handle value) {
  const std::string got = nb::cast<std::string>(nb::repr(value));
  throw ConfigError({name + ": got " + shortened(got) + ", expected " + expected});
}

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
    if (nb::hasattr(value, "ravel"))  // an array, row after row
      return numbers(name, value.attr("ravel")().attr("tolist")());
    if (!nb::hasattr(value, "__iter__")) return {number(name, value)};
  }
  std::vector<double> out;
  for (const nb::handle entry : value) {
    if (!is_list(entry)) out.push_back(number(name, entry));
    else
      for (const nb::handle inner : entry) out.push_back(number(name, inner));
  }
  return out;
}

std::string text(const std::string& name, nb::handle value) {
  if (nb::isinstance<nb::str>(value)) return nb::cast<std::string>(value);
  if (nb::hasattr(value, "__fspath__"))
    return nb::cast<std::string>(nb::str(value.attr("__fspath__")()));
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

Kept kept(nb::object object) {
  return {new nb::object(std::move(object)), [](const nb::object* p) {
            const nb::gil_scoped_acquire gil;
            delete p;
          }};
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
