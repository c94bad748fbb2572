// Tables as HDF5 files, by the C API (1.10). Every handle is closed by the object that holds it,
// and a call that fails throws. The library's printing of its own error stack is switched off.
#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/table.hpp>

#ifdef HAMEL_HAS_HDF5

#include <hamel/framework/io/hdf5_handle.hpp>

namespace hamel {

using namespace hdf5;

namespace {

void write_column(hid_t file, const TableColumn& column) {
  const hsize_t size = column.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, "H5Screate_simple");
  const auto write = [&](hid_t stored, hid_t memory, const void* data) {
    const Handle set(
        H5Dcreate2(file, column.name.c_str(), stored, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose, "H5Dcreate2");
    if (size > 0) check(H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), "H5Dwrite");
    write_text(set, "unit", column.unit);
    write_text(set, "meaning", column.meaning);
  };
  if (const auto* numbers = std::get_if<std::vector<double>>(&column.values)) {
    write(H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, numbers->data());
  } else if (const auto* whole = std::get_if<std::vector<long long>>(&column.values)) {
    write(H5T_STD_I64LE, H5T_NATIVE_LLONG, whole->data());
  } else {
    std::vector<const char*> words;
    for (const auto& word : std::get<std::vector<std::string>>(column.values))
      words.push_back(word.c_str());
    const Handle type = text_type(H5T_VARIABLE);
    write(type, type, words.data());
  }
}

TableColumn read_column(hid_t file, const std::string& name) {
  const Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "H5Dopen2"),
      space(H5Dget_space(set), H5Sclose, "H5Dget_space"),
      type(H5Dget_type(set), H5Tclose, "H5Dget_type");
  const size_t size = static_cast<size_t>(H5Sget_simple_extent_npoints(space));
  TableColumn out{name, read_text(set, "unit"), read_text(set, "meaning"), {}};
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
    default: {
      std::vector<char*> words(size, nullptr);
      read(text_type(H5T_VARIABLE), words.data());
      std::vector<std::string> texts;
      for (char* word : words) {
        texts.emplace_back(word == nullptr ? "" : word);
        H5free_memory(word);
      }
      out.values = std::move(texts);
    }
  }
  return out;
}

}  // namespace

std::string hdf5_version() {
  unsigned major = 0, minor = 0, release = 0;
  begin();
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

void Table::write_hdf5(const std::string& path,
                       const std::map<std::string, std::string>& texts) const {
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
    for (const TableColumn& column : columns) write_column(file, column);
    check(H5Fflush(file, H5F_SCOPE_LOCAL), "H5Fflush");  // closing it would not tell
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

Table read_hdf5(const std::string& path, std::map<std::string, std::string>* texts) {
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

}  // namespace hamel

#else

namespace hamel {

std::string hdf5_version() { return ""; }

void Table::write_hdf5(const std::string& path, const std::map<std::string, std::string>&) const {
  throw ConfigError(
      {fmt::format("output: cannot write '{}': this build has no HDF5 (libhdf5-dev)", path)});
}

Table read_hdf5(const std::string& path, std::map<std::string, std::string>*) {
  throw ConfigError({fmt::format("'{}': this build has no HDF5 (libhdf5-dev)", path)});
}

}  // namespace hamel

#endif
