#include <algorithm>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/row_file.hpp>
#include <hamel/framework/io/row_file_format.hpp>

namespace hamel {

using namespace hdf5;

namespace {

std::string read_bytes(hid_t file, const char* name) {
  const Handle set(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose, "H5Dopen2"),
      space(H5Dget_space(set), H5Sclose, "H5Dget_space");
  std::string out(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)), '\0');
  if (!out.empty())
    check(H5Dread(set, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()), "H5Dread");
  return out;
}

}  // namespace

struct RowFileReader::Data {
  std::unique_ptr<Handle> file;
  std::vector<ColumnGroup> groups;
  std::vector<std::unique_ptr<Handle>> sets;
  std::size_t rows = 0;
};

RowFileReader::RowFileReader(const std::string& path) : data_(std::make_unique<Data>()) {
  begin();
  const auto refuse = [&](const std::string& why) {
    throw ConfigError({fmt::format("'{}': {}", path, why)});
  };
  std::error_code error;
  if (!std::filesystem::exists(path, error)) refuse("there is no such file");
  if (H5Fis_hdf5(path.c_str()) <= 0) refuse("it is no HDF5 file");
  try {
    hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, latest_format());
    if (file < 0) file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    data_->file = std::make_unique<Handle>(file, H5Fclose, "H5Fopen");
    if (H5Aexists(file, "finished") <= 0)
      throw ConfigError({"it holds no run (hamel run … -o x.h5)"});
    std::vector<std::string> names;
    const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
      static_cast<std::vector<std::string>*>(out)->emplace_back(name);
      return 0;
    };
    check(H5Literate(file, H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, collect, &names),
          "H5Literate");
    for (const std::string& name : names) {
      if (name == kMarks || name == kRecord) continue;
      auto set =
          std::make_unique<Handle>(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "H5Dopen2");
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
    if (data_->sets.empty()) throw ConfigError({"it holds no rows"});
  } catch (const ConfigError& e) {
    refuse(e.what());
  }
}

RowFileReader::~RowFileReader() = default;
RowFileReader::RowFileReader(RowFileReader&&) noexcept = default;

const std::vector<ColumnGroup>& RowFileReader::groups() const { return data_->groups; }
std::size_t RowFileReader::rows() const { return data_->rows; }

std::string RowFileReader::record() const { return read_bytes(*data_->file, kRecord); }
bool RowFileReader::finished() const {
  unsigned char out = 0;
  check(H5Aread(finished_flag(*data_->file), H5T_NATIVE_UCHAR, &out), "H5Aread");
  return out == 1;
}

std::string RowFileReader::text(const std::string& name) const {
  return H5Aexists(*data_->file, name.c_str()) > 0 ? read_text(*data_->file, name) : "";
}

void RowFileReader::read(std::size_t first, std::size_t count, std::vector<double>& out) const {
  std::size_t width = 0, at = 0;
  for (const ColumnGroup& group : data_->groups) width += group.columns.size();
  out.resize(count * width);
  std::vector<double> column;
  for (std::size_t i = 0; i < data_->sets.size(); ++i) {
    const std::size_t n = data_->groups[i].columns.size();
    const int rank = n > 1 ? 2 : 1;
    const hsize_t start[] = {first, 0}, block[] = {count, n};
    const Handle there(H5Dget_space(*data_->sets[i]), H5Sclose, "H5Dget_space"),
        here(H5Screate_simple(rank, block, nullptr), H5Sclose, "H5Screate_simple");
    check(H5Sselect_hyperslab(there, H5S_SELECT_SET, start, nullptr, block, nullptr), "H5Sselect");
    column.resize(count * n);
    check(H5Dread(*data_->sets[i], H5T_NATIVE_DOUBLE, here, there, H5P_DEFAULT, column.data()),
          "H5Dread");
    for (std::size_t r = 0; r < count; ++r)
      for (std::size_t j = 0; j < n; ++j) out[r * width + at + j] = column[r * n + j];
    at += n;
  }
}

std::vector<RowFileReader::Mark> RowFileReader::marks() const {
  std::vector<Mark> out;
  const std::string all = read_bytes(*data_->file, kMarks);
  MarkHead head{};
  for (std::size_t at = 0; at + sizeof head <= all.size(); at += sizeof head + head[1]) {
    std::memcpy(head.data(), all.data() + at, sizeof head);
    if (head[1] == 0 || head[1] > all.size() - at - sizeof head || head[0] > rows()) break;
    std::string bytes = all.substr(at + sizeof head, head[1]);
    if (checksum(bytes) != head[2]) break;
    out.push_back({head[0], std::move(bytes)});
  }
  return out;
}

}  // namespace hamel
