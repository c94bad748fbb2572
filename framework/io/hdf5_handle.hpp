// The C API of HDF5 with handles that close themselves, and calls that throw. Not installed.
#pragma once

#include <string>
#include <utility>

#include <fmt/format.h>
#include <hdf5.h>

#include <hamel/framework/io/errors.hpp>

namespace hamel::hdf5 {

class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const char* what) : id_(id), close_(close) {
    if (id < 0) throw ConfigError({fmt::format("hdf5: {} failed", what)});
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

inline void check(herr_t status, const char* what) {
  if (status < 0) throw ConfigError({fmt::format("hdf5: {} failed", what)});
}

// Before anything else: no printing, and nothing at the program's exit, where it would write to a full disk again.
inline void begin() {
  static const herr_t once = H5dont_atexit();
  static_cast<void>(once);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

// A variable-length UTF-8 string.
inline Handle text_type() {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return {type, H5Tclose, "H5Tcopy"};
}

inline void write_text(hid_t object, const std::string& name, const std::string& value) {
  const Handle type = text_type(), space(H5Screate(H5S_SCALAR), H5Sclose, "H5Screate");
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, "H5Acreate2");
  const char* text = value.c_str();
  check(H5Awrite(attribute, type, &text), "H5Awrite");
}

inline std::string read_text(hid_t attribute) {
  const Handle type = text_type();
  char* text = nullptr;
  check(H5Aread(attribute, type, &text), "H5Aread");
  std::string out = text == nullptr ? "" : text;
  H5free_memory(text);
  return out;
}

inline std::string read_text(hid_t object, const std::string& name) {
  return read_text(Handle(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "H5Aopen"));
}

}  // namespace hamel::hdf5
