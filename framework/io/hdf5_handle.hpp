// The C API of HDF5 with handles that close themselves, and calls that throw. Not installed.
#pragma once

#include <algorithm>
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

// Before anything else: no printing, and nothing at the program's exit, where it would write to a
// full disk again.
inline void begin() {
  static const herr_t once = H5dont_atexit();
  static_cast<void>(once);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

// A UTF-8 string of so many bytes, or of H5T_VARIABLE: the latter lie in heaps without checksums.
inline Handle text_type(std::size_t size) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, size);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return {type, H5Tclose, "H5Tcopy"};
}

inline void write_text(hid_t object, const std::string& name, hid_t type, const void* text) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "H5Screate");
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, "H5Acreate2");
  check(H5Awrite(attribute, type, text), "H5Awrite");
}
// Attributes: of any length, and of a fixed one, in the object's header, which has a checksum.
inline void write_text(hid_t object, const std::string& name, const std::string& value) {
  const char* text = value.c_str();
  write_text(object, name, text_type(H5T_VARIABLE), &text);
}
inline void write_fixed_text(hid_t object, const std::string& name, const std::string& value) {
  write_text(object, name, text_type(std::max<std::size_t>(value.size(), 1)), value.c_str());
}

// Reads a text of either kind.
inline std::string read_text(hid_t object, const std::string& name) {
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "H5Aopen"),
      stored(H5Aget_type(attribute), H5Tclose, "H5Aget_type");
  if (H5Tis_variable_str(stored) > 0) {
    char* text = nullptr;
    check(H5Aread(attribute, text_type(H5T_VARIABLE), &text), "H5Aread");
    std::string out = text == nullptr ? "" : text;
    H5free_memory(text);
    return out;
  }
  std::string out(H5Tget_size(stored), '\0');
  check(H5Aread(attribute, text_type(out.size()), out.data()), "H5Aread");
  out.erase(out.find_last_not_of('\0') + 1);
  return out;
}

}  // namespace hamel::hdf5
