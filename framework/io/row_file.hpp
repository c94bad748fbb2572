// Rows of numbers in an HDF5 file that is written as they come and can be read at any time, also
// after the writer was killed (single writer, multiple readers: H5F_START_SWMR_WRITE).
//
// Each group of columns is a data set, rows x columns (rows alone where it is one number), with
// unit, meaning, frame and columns as attributes; texts are data sets of bytes. The file's
// attribute `finished` is 0 until it is closed, and the text `record` empty. The data set `resume`
// holds marks, pieces of bytes that belong to the rows before them. Each mark, and in the end the
// attribute `checksum`, has the checksum of all rows before it: HDF5 reads what is missing at the
// end of a file as zeros, of which its own fletcher32 is zero. The attribute `checksum_of_texts`
// has that of all texts, the columns' too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hamel {
namespace hdf5 {
class RowWriter;
class RowReader;
}  // namespace hdf5

/// Columns of a row that belong together: a number, or the entries of a vector.
struct ColumnGroup {
  std::string name, unit, meaning, frame;
  std::vector<std::string> columns;
  /// Further names that are read, and the indices of their columns. Not in the file.
  std::vector<std::pair<std::string, std::size_t>> other_names = {};
};

/// A small number of rows with names: written whole with the end of a file, as one data set of a
/// compound type, the name and these columns.
struct NamedRows {
  std::string set;  // "" for none
  std::string name;
  std::size_t longest = 0;  // bytes of a name
  std::vector<std::string> columns;
  struct Row {
    std::string name;
    std::vector<double> values;
  };
  std::vector<Row> rows = {};
};

/// The checksum of rows that come after others with the checksum `before`; of none it is kNoRows.
constexpr std::uint64_t kNoRows = 14695981039346656037u;
std::uint64_t checksum_of_rows(std::uint64_t before, std::span<const double> rows);

class RowFileWriter {
 public:
  /// Unfinished where the file cannot be created, ConfigError without HDF5 in the build.
  RowFileWriter(const std::string& path, const std::vector<ColumnGroup>& groups,
                const std::map<std::string, std::string>& texts, const NamedRows& named = {});
  /// Leaves the file as it is, unfinished.
  ~RowFileWriter();
  /// Whole rows, one after the other. Unfinished on failure, here and below.
  void append(std::span<const double> rows);
  /// Adds bytes that belong to the rows so far: readers see them when they see these rows.
  void mark(std::string_view bytes);
  /// Closes the file, with the text of its record and the named rows.
  void finish(const std::string& record, const NamedRows& named = {});

 private:
  std::unique_ptr<hdf5::RowWriter> file_;
};

class RowFileReader {
 public:
  /// ConfigError where it is no such file, or damaged, its texts among it; so below.
  explicit RowFileReader(const std::string& path);
  ~RowFileReader();
  RowFileReader(RowFileReader&&) noexcept;

  const std::vector<ColumnGroup>& groups() const;
  /// "" where there is none of that name.
  std::string text(const std::string& name) const;
  bool finished() const;
  std::string record() const;
  std::size_t rows() const;
  /// The checksum of all rows of a finished file; none in files older than checksums.
  std::optional<std::uint64_t> checksum() const;
  /// Whole rows, one after the other.
  void read(std::size_t first, std::size_t count, std::vector<double>& out) const;
  struct Mark {
    std::size_t rows;
    std::string bytes;
  };
  /// The marks that are whole with all rows before them, in their order. Reads these rows.
  std::vector<Mark> marks() const;

 private:
  std::unique_ptr<hdf5::RowReader> file_;
};

}  // namespace hamel
