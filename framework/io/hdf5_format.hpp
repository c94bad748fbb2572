// Functions of HDF5 for the library: tables (table.hpp) and files of rows (row_file.hpp), as one
// interface, since HDF5 may be linked, a module that is opened (module.hpp), or absent. Not
// installed.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hamel/framework/io/row_file.hpp>
#include <hamel/framework/io/table.hpp>

namespace hamel::hdf5 {

using Texts = std::map<std::string, std::string>;

/// The functions of RowFileWriter.
class RowWriter {
 public:
  virtual ~RowWriter() = default;
  virtual void append(std::span<const double> rows) = 0;
  virtual void mark(std::string_view bytes) = 0;
  virtual void finish(const std::string& record, const NamedRows& named) = 0;
};

/// The functions of RowFileReader.
class RowReader {
 public:
  virtual ~RowReader() = default;
  virtual const std::vector<ColumnGroup>& groups() const = 0;
  virtual std::string text(const std::string& name) const = 0;
  virtual bool finished() const = 0;
  virtual std::string record() const = 0;
  virtual std::size_t rows() const = 0;
  virtual std::optional<std::uint64_t> checksum() const = 0;
  virtual void read(std::size_t first, std::size_t count, std::vector<double>& out) const = 0;
  virtual std::vector<RowFileReader::Mark> marks() const = 0;
};

class Format {
 public:
  virtual ~Format() = default;
  virtual std::string version() const = 0;
  virtual void write_table(const Table& table, const std::string& path,
                           const Texts& texts) const = 0;
  virtual Table read_table(const std::string& path, Texts* texts) const = 0;
  virtual std::unique_ptr<RowWriter> write_rows(const std::string& path,
                                                const std::vector<ColumnGroup>& groups,
                                                const Texts& texts,
                                                const NamedRows& named) const = 0;
  virtual std::unique_ptr<RowReader> read_rows(const std::string& path) const = 0;
};

/// Null without HDF5. Defined in hdf5_linked.cpp, hdf5_opened.cpp or hdf5_absent.cpp, one of which
/// is linked.
const Format* format();
/// Why a module that is there cannot be opened; "" otherwise.
std::string reason();

// The parts of the linked one.
std::string library_version();
void write_table(const Table& table, const std::string& path, const Texts& texts);
Table read_table(const std::string& path, Texts* texts);
std::unique_ptr<RowWriter> write_rows(const std::string& path,
                                      const std::vector<ColumnGroup>& groups, const Texts& texts,
                                      const NamedRows& named);
std::unique_ptr<RowReader> read_rows(const std::string& path);

}  // namespace hamel::hdf5
