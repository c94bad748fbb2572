// What the writer and the reader of row files (row_file.hpp) share. Not installed.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include <hamel/framework/io/hdf5_handle.hpp>

namespace hamel::hdf5 {

constexpr const char *kMarks = "resume", *kRecord = "record";

// FNV-1a.
inline std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash;
}

using MarkHead = std::array<std::uint64_t, 4>;  // rows, their checksum, bytes, theirs

inline Handle latest_format() {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  return {access, H5Pclose, "H5Pcreate"};
}

// finished (0 or 1) and checksum, the attributes that change: a text cannot while others read.
constexpr const char *kFinished = "finished", *kChecksum = "checksum";
inline void write_number(hid_t file, const char* name, hid_t type, std::uint64_t value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "H5Screate");
  const Handle attribute(H5Aexists(file, name) > 0
                             ? H5Aopen(file, name, H5P_DEFAULT)
                             : H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, "H5Aopen");
  check(H5Awrite(attribute, H5T_NATIVE_UINT64, &value), "H5Awrite");
}
inline std::uint64_t read_number(hid_t file, const char* name) {
  const Handle attribute(H5Aopen(file, name, H5P_DEFAULT), H5Aclose, "H5Aopen");
  std::uint64_t out = 0;
  check(H5Aread(attribute, H5T_NATIVE_UINT64, &out), "H5Aread");
  return out;
}

}  // namespace hamel::hdf5
