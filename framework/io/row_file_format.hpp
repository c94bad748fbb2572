// Definitions that the writer and the reader of row files (row_file.hpp) share. Not installed.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include <hamel/framework/io/hdf5_format.hpp>
#include <hamel/framework/io/hdf5_handle.hpp>

namespace hamel::hdf5 {

constexpr const char *kMarks = "resume", *kRecord = "record";

// FNV-1a, of bytes behind others with the checksum `hash`.
inline std::uint64_t checksum(std::string_view bytes, std::uint64_t hash = 14695981039346656037u) {
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash;
}
// Checksum of a text with its name and its length.
inline std::uint64_t checksum_of_text(std::string_view name, std::string_view text,
                                      std::uint64_t hash) {
  const std::uint64_t sizes[] = {name.size(), text.size()};
  const std::string_view bytes(reinterpret_cast<const char*>(sizes), sizeof sizes);
  return checksum(text, checksum(name, checksum(bytes, hash)));
}
inline std::uint64_t checksum_of_columns(const ColumnGroup& group, std::uint64_t hash) {
  for (const std::string* text : {&group.unit, &group.meaning, &group.frame})
    hash = checksum_of_text(group.name, *text, hash);
  for (const std::string& column : group.columns) hash = checksum_of_text("", column, hash);
  return hash;
}

using MarkHead = std::array<std::uint64_t, 4>;  // rows, their checksum, bytes, theirs

inline Handle latest_format() {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  return {access, H5Pclose, "H5Pcreate"};
}

// The attributes, numbers that change: finished (0 or 1), the checksum of all rows, and that of all
// texts.
constexpr const char *kFinished = "finished", *kChecksum = "checksum",
                     *kTexts = "checksum_of_texts";
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

// A text as a data set of its bytes.
inline bool has_text(hid_t file, const std::string& name) {
  return H5Lexists(file, name.c_str(), H5P_DEFAULT) > 0;
}
inline std::string read_bytes(hid_t file, const std::string& name) {
  const Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "H5Dopen2"),
      space(H5Dget_space(set), H5Sclose, "H5Dget_space");
  std::string out(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)), '\0');
  if (!out.empty())
    check(H5Dread(set, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()), "H5Dread");
  return out;
}
inline void write_bytes(hid_t file, const std::string& name, std::string_view text) {
  const hsize_t size = text.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, "H5Screate_simple");
  const Handle set(
      H5Dcreate2(file, name.c_str(), H5T_STD_U8LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose, "H5Dcreate2");
  if (size > 0)
    check(H5Dwrite(set, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), "H5Dwrite");
}

}  // namespace hamel::hdf5
