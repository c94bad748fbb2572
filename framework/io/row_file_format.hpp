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

using MarkHead = std::array<std::uint64_t, 3>;  // rows, bytes, checksum

inline Handle latest_format() {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  return {access, H5Pclose, "H5Pcreate"};
}

// 0 or 1, the one attribute that changes: a text cannot while others read.
inline Handle finished_flag(hid_t file) {
  if (H5Aexists(file, "finished") > 0)
    return {H5Aopen(file, "finished", H5P_DEFAULT), H5Aclose, "H5Aopen"};
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "H5Screate");
  return {H5Acreate2(file, "finished", H5T_STD_U8LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
          "H5Acreate2"};
}

}  // namespace hamel::hdf5
