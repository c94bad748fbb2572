// A table with named columns, each with its unit and meaning: written as CSV and as HDF5.
//
// In the CSV a number that is not finite is an empty field. In the HDF5 file each column is a data
// set with its name, numbers as 64-bit floats (NaN where there is none) or integers, texts as
// UTF-8 strings; `unit` and `meaning` are its attributes, further texts attributes of the file.
#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include <hamel/framework/io/export.hpp>

namespace hamel {

struct HAMEL_API TableColumn {
  using Values =
      std::variant<std::vector<double>, std::vector<long long>, std::vector<std::string>>;
  std::string name, unit, meaning;
  Values values;

  size_t size() const;
  /// Entry as text: shortest round trip, empty where a number is not finite.
  std::string text(size_t row) const;
};

struct HAMEL_API Table {
  std::vector<TableColumn> columns;
  /// Further names that column() reads, and their columns'. Not in files.
  std::map<std::string, std::string> other_names = {};

  size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
  /// The column; ConfigError naming the nearest when there is none.
  const TableColumn& column(const std::string& name) const;
  std::string csv() const;
  /// The file appears whole or not at all. ConfigError when it cannot be written, or without HDF5
  /// in the build.
  void write_hdf5(const std::string& path, const std::map<std::string, std::string>& texts) const;
};

/// A text as a field of a CSV, quoted where it must be (RFC 4180).
HAMEL_API std::string csv_field(const std::string& text);

/// Whether this build can write HDF5, and the version it uses ("" without).
HAMEL_API std::string hdf5_version();
/// Why there is none; "" where there is.
std::string hdf5_missing();

/// Reads back what write_hdf5 wrote (texts: the attributes of the file).
HAMEL_API Table read_hdf5(const std::string& path,
                          std::map<std::string, std::string>* texts = nullptr);

}  // namespace hamel
