#include <algorithm>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/row_file_format.hpp>

namespace hamel::hdf5 {
namespace {

bool is_bytes(hid_t set) {
  const Handle type(H5Dget_type(set), H5Tclose, "H5Dget_type");
  return H5Tget_class(type) == H5T_INTEGER;
}

// Named rows, for other readers.
bool is_named(hid_t set) {
  const Handle type(H5Dget_type(set), H5Tclose, "H5Dget_type");
  return H5Tget_class(type) == H5T_COMPOUND;
}

void read_column(hid_t set, hsize_t first, hsize_t count, hsize_t width, double* out) {
  const int rank = width > 1 ? 2 : 1;
  const hsize_t start[] = {first, 0}, block[] = {count, width};
  const Handle there(H5Dget_space(set), H5Sclose, "H5Dget_space"),
      here(H5Screate_simple(rank, block, nullptr), H5Sclose, "H5Screate_simple");
  check(H5Sget_simple_extent_ndims(there) == rank ? 0 : -1, "its rank");
  check(H5Sselect_hyperslab(there, H5S_SELECT_SET, start, nullptr, block, nullptr), "H5Sselect");
  check(H5Dread(set, H5T_NATIVE_DOUBLE, here, there, H5P_DEFAULT, out), "H5Dread");
}

constexpr std::size_t kPiece = 4096;  // rows that are read at once

class Reader final : public RowReader {
 public:
  explicit Reader(const std::string& path);
  const std::vector<ColumnGroup>& groups() const override;
  std::string text(const std::string& name) const override;
  bool finished() const override;
  std::string record() const override;
  std::size_t rows() const override;
  std::optional<std::uint64_t> checksum() const override;
  void read(std::size_t first, std::size_t count, std::vector<double>& out) const override;
  std::vector<RowFileReader::Mark> marks() const override;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

struct Reader::Data {
  std::string path;
  std::unique_ptr<Handle> file;
  std::vector<ColumnGroup> groups;
  std::vector<std::unique_ptr<Handle>> sets;
  std::vector<std::string> texts;  // their names, in the order of creation
  std::size_t rows = 0;

  template <class F>
  auto attempt(F&& read) const {
    try {
      return read();
    } catch (const ConfigError& error) {
      throw ConfigError({fmt::format("'{}': it is damaged ({})", path, error.what())});
    }
  }

  // True of files of before there was a checksum.
  bool texts_are_those_written() const {
    return attempt([&] {
      if (H5Aexists(*file, kTexts) <= 0) return true;
      std::uint64_t sum = kNoRows;
      for (const std::string& name : texts)
        sum = checksum_of_text(name, read_bytes(*file, name), sum);
      for (const ColumnGroup& group : groups) sum = checksum_of_columns(group, sum);
      if (read_number(*file, kFinished) == 1)
        sum = checksum_of_text(kRecord, read_bytes(*file, kRecord), sum);
      return read_number(*file, kTexts) == sum;
    });
  }
};

Reader::Reader(const std::string& path) : data_(std::make_unique<Data>()) {
  begin();
  data_->path = path;
  const auto refuse = [&](const std::string& why) {
    throw ConfigError({fmt::format("'{}': {}", path, why)});
  };
  std::error_code error;
  if (!std::filesystem::exists(path, error)) refuse("there is no such file");
  if (H5Fis_hdf5(path.c_str()) <= 0) refuse("it is no HDF5 file");
  data_->attempt([&] {
    const Handle access = latest_format();
    // Metadata that another process writes may be reread until it is whole; damage stays, at every
    // level of the file.
    if (!locked(path)) check(H5Pset_metadata_read_attempts(access, 1), "H5Pset_metadata");
    hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access);
    if (file < 0) file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    data_->file = std::make_unique<Handle>(file, H5Fclose, "H5Fopen");
    std::vector<std::string> names;
    const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
      static_cast<std::vector<std::string>*>(out)->emplace_back(name);
      return 0;
    };
    check(H5Literate(file, H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, collect, &names),
          "H5Literate");
    for (const std::string& name : names) {
      auto set =
          std::make_unique<Handle>(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "H5Dopen2");
      if (is_bytes(*set)) {
        if (name != kMarks && name != kRecord) data_->texts.push_back(name);
        continue;
      }
      if (is_named(*set)) continue;
      ColumnGroup group{
          name, read_text(*set, "unit"), read_text(*set, "meaning"), read_text(*set, "frame"), {}};
      const std::string columns = read_text(*set, "columns");
      for (std::size_t at = 0; at <= columns.size();) {
        const std::size_t comma = std::min(columns.find(',', at), columns.size());
        group.columns.push_back(columns.substr(at, comma - at));
        at = comma + 1;
      }
      const Handle space(H5Dget_space(*set), H5Sclose, "H5Dget_space");
      const auto points = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
      const std::size_t rows = points / group.columns.size();
      data_->rows = data_->sets.empty() ? rows : std::min(data_->rows, rows);
      data_->groups.push_back(std::move(group));
      data_->sets.push_back(std::move(set));
    }
  });
  if (H5Aexists(*data_->file, kFinished) <= 0) refuse("it holds no run (hamel run … -o x.h5)");
  if (data_->sets.empty()) refuse("it holds no rows");
  if (!data_->texts_are_those_written()) refuse("it is damaged: its texts are not those written");
}

const std::vector<ColumnGroup>& Reader::groups() const { return data_->groups; }
std::size_t Reader::rows() const { return data_->rows; }

bool Reader::finished() const {
  return data_->attempt([&] { return read_number(*data_->file, kFinished) == 1; });
}
std::string Reader::record() const {
  return data_->attempt([&] { return read_bytes(*data_->file, kRecord); });
}
std::optional<std::uint64_t> Reader::checksum() const {
  if (H5Aexists(*data_->file, kChecksum) <= 0) return {};
  return data_->attempt([&] { return read_number(*data_->file, kChecksum); });
}

std::string Reader::text(const std::string& name) const {
  return data_->attempt([&]() -> std::string {
    if (has_text(*data_->file, name)) return read_bytes(*data_->file, name);
    if (H5Aexists(*data_->file, name.c_str()) > 0) return read_text(*data_->file, name);
    return "";
  });
}

void Reader::read(std::size_t first, std::size_t count, std::vector<double>& out) const {
  std::size_t width = 0, at = 0;
  for (const ColumnGroup& group : data_->groups) width += group.columns.size();
  out.resize(count * width);
  std::vector<double> column;
  for (std::size_t i = 0; i < data_->sets.size(); ++i) {
    const std::size_t n = data_->groups[i].columns.size();
    column.resize(count * n);
    data_->attempt([&] { read_column(*data_->sets[i], first, count, n, column.data()); });
    for (std::size_t r = 0; r < count; ++r)
      for (std::size_t j = 0; j < n; ++j) out[r * width + at + j] = column[r * n + j];
    at += n;
  }
}

std::vector<RowFileReader::Mark> Reader::marks() const {
  std::vector<RowFileReader::Mark> out;
  const std::string all = data_->attempt([&] { return read_bytes(*data_->file, kMarks); });
  MarkHead head{};
  std::uint64_t sum = kNoRows;
  std::vector<double> piece;
  for (std::size_t at = 0, row = 0; at + sizeof head <= all.size(); at += sizeof head + head[2]) {
    std::memcpy(head.data(), all.data() + at, sizeof head);
    const auto [marked, sum_there, size, sum_of_bytes] = head;
    if (size == 0 || size > all.size() - at - sizeof head || marked > rows()) break;
    std::string bytes = all.substr(at + sizeof head, size);
    if (hdf5::checksum(bytes) != sum_of_bytes) break;
    try {
      for (; row < marked; row += kPiece) {
        read(row, std::min(kPiece, marked - row), piece);
        sum = checksum_of_rows(sum, piece);
      }
    } catch (const ConfigError&) {
      break;
    }
    row = marked;
    if (sum != sum_there) break;
    out.push_back({marked, std::move(bytes)});
  }
  return out;
}

}  // namespace

std::unique_ptr<RowReader> read_rows(const std::string& path) {
  return std::make_unique<Reader>(path);
}

}  // namespace hamel::hdf5
