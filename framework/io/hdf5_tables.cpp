// Tables as HDF5 files, by the C API (1.10). Every handle is closed by the object that holds it,
// and a call that fails throws. The library's printing of its own error stack is switched off.
#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/hdf5_format.hpp>
#include <hamel/framework/io/hdf5_handle.hpp>
#include <hamel/framework/io/output_file.hpp>

namespace hamel::hdf5 {
namespace {

// HDF5 takes a / for a group: a data set of such a name has the sign of a division instead, and its
// own name as an attribute.
constexpr char kDivision[] = "\u2215";

// Texts up to this many bytes are stored one after the other: HDF5 takes 90 bytes of memory and 30
// of the file for each one of a length of its own.
constexpr size_t kFixed = 64;

std::string link_of(const std::string& name) {
  std::string out;
  for (const char letter : name) letter == '/' ? out += kDivision : out += letter;
  return out;
}

void write_column(hid_t file, const TableColumn& column) {
  const hsize_t size = column.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, "H5Screate_simple");
  // Without the time of writing: a table has the same bytes whenever it is written.
  const Handle timeless(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "H5Pcreate");
  check(H5Pset_obj_track_times(timeless, false), "H5Pset_obj_track_times");
  const Handle utf8(H5Pcreate(H5P_LINK_CREATE), H5Pclose, "H5Pcreate");
  check(H5Pset_char_encoding(utf8, H5T_CSET_UTF8), "H5Pset_char_encoding");
  const std::string link = link_of(column.name);
  const auto write = [&](hid_t stored, hid_t memory, const void* data) {
    const Handle set(H5Dcreate2(file, link.c_str(), stored, space, utf8, timeless, H5P_DEFAULT),
                     H5Dclose, "H5Dcreate2");
    if (link != column.name) write_text(set, "name", column.name);
    if (size > 0) check(H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), "H5Dwrite");
    write_text(set, "unit", column.unit);
    write_text(set, "meaning", column.meaning);
  };
  if (const auto* numbers = std::get_if<std::vector<double>>(&column.values)) {
    write(H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, numbers->data());
  } else if (const auto* whole = std::get_if<std::vector<long long>>(&column.values)) {
    write(H5T_STD_I64LE, H5T_NATIVE_LLONG, whole->data());
  } else {
    const auto& texts = std::get<std::vector<std::string>>(column.values);
    size_t longest = 1;
    for (const std::string& text : texts) longest = std::max(longest, text.size());
    if (longest <= kFixed) {
      std::string all;
      for (const std::string& text : texts) (all += text).append(longest - text.size(), '\0');
      const Handle type = text_type(longest);
      return write(type, type, all.data());
    }
    std::vector<const char*> words;
    for (const std::string& text : texts) words.push_back(text.c_str());
    const Handle type = text_type(H5T_VARIABLE);
    write(type, type, words.data());
  }
}

std::vector<std::string> read_texts(hid_t set, hid_t stored, size_t size) {
  std::vector<std::string> out;
  const bool variable = H5Tis_variable_str(stored) > 0;
  const size_t length = variable ? 0 : H5Tget_size(stored);
  const Handle type = text_type(variable ? H5T_VARIABLE : length);
  std::vector<char*> words(variable ? size : 0, nullptr);
  std::string all(size * length, '\0');
  void* to = variable ? static_cast<void*>(words.data()) : all.data();
  if (size > 0) check(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to), "H5Dread");
  for (char* word : words) {
    out.emplace_back(word == nullptr ? "" : word);
    H5free_memory(word);
  }
  for (size_t at = 0; at < all.size(); at += length) {
    out.push_back(all.substr(at, length));
    out.back().erase(out.back().find_last_not_of('\0') + 1);
  }
  return out;
}

TableColumn read_column(hid_t file, const std::string& name) {
  const Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "H5Dopen2"),
      space(H5Dget_space(set), H5Sclose, "H5Dget_space"),
      type(H5Dget_type(set), H5Tclose, "H5Dget_type");
  const size_t size = static_cast<size_t>(H5Sget_simple_extent_npoints(space));
  const bool renamed = H5Aexists(set, "name") > 0;
  TableColumn out{renamed ? read_text(set, "name") : name,
                  read_text(set, "unit"),
                  read_text(set, "meaning"),
                  {}};
  const auto read = [&](hid_t memory, void* data) {
    if (size > 0) check(H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), "H5Dread");
  };
  switch (H5Tget_class(type)) {
    case H5T_FLOAT:
      read(H5T_NATIVE_DOUBLE,
           (out.values = std::vector<double>(size), std::get<0>(out.values).data()));
      break;
    case H5T_INTEGER:
      read(H5T_NATIVE_LLONG,
           (out.values = std::vector<long long>(size), std::get<1>(out.values).data()));
      break;
    default: out.values = read_texts(set, type, size);
  }
  return out;
}

}  // namespace

std::string library_version() {
  unsigned major = 0, minor = 0, release = 0;
  begin();
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

void write_table(const Table& table, const std::string& path, const Texts& texts) {
  begin();
  const std::string part = part_of(path);
  errno = 0;
  try {
    // The order of creation is kept, so that the columns come back as they were written.
    const Handle properties(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "H5Pcreate");
    check(H5Pset_link_creation_order(properties, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED),
          "H5Pset_link_creation_order");
    const Handle file(H5Fcreate(part.c_str(), H5F_ACC_TRUNC, properties, H5P_DEFAULT), H5Fclose,
                      "H5Fcreate");
    for (const auto& [name, value] : texts) write_text(file, name, value);
    for (const TableColumn& column : table.columns) write_column(file, column);
    check(H5Fflush(file, H5F_SCOPE_LOCAL), "H5Fflush");  // closing it would not report
  } catch (const ConfigError& error) {
    const std::string reason = errno != 0 ? std::strerror(errno) : error.what();
    std::remove(part.c_str());
    throw Unfinished(fmt::format("output: cannot write '{}': {}", path, reason));
  }
  if (std::rename(part.c_str(), path.c_str()) != 0) {
    std::remove(part.c_str());
    throw Unfinished(fmt::format("output: cannot write '{}'", path));
  }
}

Table read_table(const std::string& path, Texts* texts) {
  begin();
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "H5Fopen");
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  check(H5Literate(file, H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, collect, &names), "H5Literate");
  Table out;
  for (const std::string& name : names) out.columns.push_back(read_column(file, name));
  if (texts != nullptr) {
    std::vector<std::string> keys;
    const auto keep = [](hid_t, const char* name, const H5A_info_t*, void* to) -> herr_t {
      static_cast<std::vector<std::string>*>(to)->emplace_back(name);
      return 0;
    };
    check(H5Aiterate2(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, keep, &keys), "H5Aiterate2");
    for (const std::string& key : keys) (*texts)[key] = read_text(file, key);
  }
  return out;
}

}  // namespace hamel::hdf5
