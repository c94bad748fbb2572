#include <hamel/framework/io/row_file.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>

#ifdef HAMEL_HAS_HDF5

#include <hamel/framework/io/hdf5_handle.hpp>

namespace hamel {

using namespace hdf5;

namespace {

constexpr hsize_t kChunkRows = 4096, kChunkBytes = 1 << 16;
constexpr const char *kMarks = "resume", *kRecord = "record";

// FNV-1a.
std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash;
}

using MarkHead = std::array<std::uint64_t, 3>;  // rows, bytes, checksum

Handle latest_format() {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  return {access, H5Pclose, "H5Pcreate"};
}

// 0 or 1, the one attribute that changes: a text cannot while others read.
Handle finished_flag(hid_t file) {
  if (H5Aexists(file, "finished") > 0)
    return {H5Aopen(file, "finished", H5P_DEFAULT), H5Aclose, "H5Aopen"};
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "H5Screate");
  return {H5Acreate2(file, "finished", H5T_STD_U8LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
          "H5Acreate2"};
}
void write_finished(hid_t file, unsigned char value) {
  check(H5Awrite(finished_flag(file), H5T_NATIVE_UCHAR, &value), "H5Awrite");
}

std::string read_bytes(hid_t file, const char* name) {
  const Handle set(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose, "H5Dopen2"),
      space(H5Dget_space(set), H5Sclose, "H5Dget_space");
  std::string out(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)), '\0');
  if (!out.empty())
    check(H5Dread(set, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()), "H5Dread");
  return out;
}

Handle create(hid_t file, const std::string& name, hid_t type, hsize_t chunk, hsize_t width) {
  const int rank = width > 1 ? 2 : 1;
  const hsize_t now[] = {0, width}, most[] = {H5S_UNLIMITED, width}, chunks[] = {chunk, width};
  const Handle space(H5Screate_simple(rank, now, most), H5Sclose, "H5Screate_simple"),
      properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "H5Pcreate");
  check(H5Pset_chunk(properties, rank, chunks), "H5Pset_chunk");
  return {H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT),
          H5Dclose, "H5Dcreate2"};
}

void append_to(hid_t set, hid_t type, hsize_t at, hsize_t count, hsize_t width, const void* data) {
  const int rank = width > 1 ? 2 : 1;
  const hsize_t size[] = {at + count, width}, start[] = {at, 0}, block[] = {count, width};
  check(H5Dset_extent(set, size), "H5Dset_extent");
  const Handle there(H5Dget_space(set), H5Sclose, "H5Dget_space"),
      here(H5Screate_simple(rank, block, nullptr), H5Sclose, "H5Screate_simple");
  check(H5Sselect_hyperslab(there, H5S_SELECT_SET, start, nullptr, block, nullptr), "H5Sselect");
  check(H5Dwrite(set, type, here, there, H5P_DEFAULT, data), "H5Dwrite");
}

}  // namespace

struct RowFileWriter::Data {
  std::string path;
  std::vector<hsize_t> widths;
  std::unique_ptr<Handle> file;
  std::vector<std::unique_ptr<Handle>> sets;
  std::unique_ptr<Handle> marks, record;
  hsize_t width = 0, rows = 0, marked = 0;
  std::vector<double> column;

  // After a failed write the library cannot close the file; it stays as it was last flushed.
  void abandon() {
    for (auto& set : sets) static_cast<void>(set.release());
    static_cast<void>(marks.release());
    static_cast<void>(record.release());
    static_cast<void>(file.release());
  }
  template <class F>
  void attempt(F&& write) {
    if (file == nullptr) throw Unfinished(fmt::format("output: '{}' was given up", path));
    try {
      errno = 0;
      write();
    } catch (const ConfigError& error) {
      const std::string reason = errno != 0 ? std::strerror(errno) : error.what();
      abandon();
      throw Unfinished(fmt::format("output: cannot write '{}': {}", path, reason));
    }
  }
};

RowFileWriter::RowFileWriter(std::string path, const std::vector<ColumnGroup>& groups,
                             const std::map<std::string, std::string>& texts)
    : data_(std::make_unique<Data>()) {
  begin();
  data_->path = std::move(path);
  try {
    const Handle properties(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "H5Pcreate");
    check(H5Pset_link_creation_order(properties, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED),
          "H5Pset_link_creation_order");
    data_->file = std::make_unique<Handle>(
        H5Fcreate(data_->path.c_str(), H5F_ACC_TRUNC, properties, latest_format()), H5Fclose,
        "H5Fcreate");
    const hid_t file = *data_->file;
    for (const auto& [name, value] : texts) write_text(file, name, value);
    write_finished(file, 0);
    for (const ColumnGroup& group : groups) {
      const hsize_t width = group.columns.size();
      auto set =
          std::make_unique<Handle>(create(file, group.name, H5T_IEEE_F64LE, kChunkRows, width));
      write_text(*set, "unit", group.unit);
      write_text(*set, "meaning", group.meaning);
      write_text(*set, "frame", group.frame);
      write_text(*set, "columns", fmt::format("{}", fmt::join(group.columns, ",")));
      data_->sets.push_back(std::move(set));
      data_->widths.push_back(width);
      data_->width += width;
    }
    data_->marks = std::make_unique<Handle>(create(file, kMarks, H5T_STD_U8LE, kChunkBytes, 1));
    data_->record = std::make_unique<Handle>(create(file, kRecord, H5T_STD_U8LE, kChunkBytes, 1));
    check(H5Fstart_swmr_write(file), "H5Fstart_swmr_write");
  } catch (const ConfigError& error) {
    throw ConfigError({fmt::format("output: cannot write '{}' ({})", data_->path, error.what())});
  }
}

RowFileWriter::~RowFileWriter() = default;

void RowFileWriter::append(std::span<const double> rows) {
  Data& d = *data_;
  const hsize_t count = rows.size() / d.width;
  if (count == 0) return;
  d.attempt([&] {
    hsize_t first = 0;
    for (std::size_t i = 0; i < d.sets.size(); ++i) {
      const hsize_t width = d.widths[i];
      d.column.resize(count * width);
      double* to = d.column.data();
      for (hsize_t r = 0; r < count; ++r) {
        const double* from = rows.data() + r * d.width + first;
        for (hsize_t j = 0; j < width; ++j) *to++ = from[j];
      }
      append_to(*d.sets[i], H5T_NATIVE_DOUBLE, d.rows, count, width, d.column.data());
      first += width;
    }
    check(H5Fflush(*d.file, H5F_SCOPE_LOCAL), "H5Fflush");
  });
  d.rows += count;
}

void RowFileWriter::mark(std::string_view bytes) {
  Data& d = *data_;
  const MarkHead head = {d.rows, bytes.size(), checksum(bytes)};
  std::string text(sizeof head, '\0');
  std::memcpy(text.data(), head.data(), sizeof head);
  text += bytes;
  d.attempt([&] {
    append_to(*d.marks, H5T_NATIVE_UINT8, d.marked, text.size(), 1, text.data());
    check(H5Dflush(*d.marks), "H5Dflush");
  });
  d.marked += text.size();
}

void RowFileWriter::finish(const std::string& record) {
  Data& d = *data_;
  d.attempt([&] {
    append_to(*d.record, H5T_NATIVE_UINT8, 0, record.size(), 1, record.data());
    check(H5Fflush(*d.file, H5F_SCOPE_LOCAL), "H5Fflush");
    write_finished(*d.file, 1);
    check(H5Fflush(*d.file, H5F_SCOPE_LOCAL), "H5Fflush");
    d.sets.clear();
    d.marks.reset();
    d.record.reset();
    d.file.reset();
  });
}

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

#else

namespace hamel {

struct RowFileWriter::Data {};
struct RowFileReader::Data {};

namespace {
[[noreturn]] void no_hdf5(const std::string& path) {
  throw ConfigError({fmt::format("'{}': this build has no HDF5 (libhdf5-dev)", path)});
}
}  // namespace

RowFileWriter::RowFileWriter(std::string path, const std::vector<ColumnGroup>&,
                             const std::map<std::string, std::string>&) {
  no_hdf5(path);
}
RowFileWriter::~RowFileWriter() = default;
void RowFileWriter::append(std::span<const double>) {}
void RowFileWriter::mark(std::string_view) {}
void RowFileWriter::finish(const std::string&) {}
RowFileReader::RowFileReader(const std::string& path) { no_hdf5(path); }
RowFileReader::~RowFileReader() = default;
RowFileReader::RowFileReader(RowFileReader&&) noexcept = default;
const std::vector<ColumnGroup>& RowFileReader::groups() const { std::abort(); }
std::string RowFileReader::text(const std::string&) const { return ""; }
std::string RowFileReader::record() const { return ""; }
bool RowFileReader::finished() const { return false; }
std::size_t RowFileReader::rows() const { return 0; }
void RowFileReader::read(std::size_t, std::size_t, std::vector<double>&) const {}
std::vector<RowFileReader::Mark> RowFileReader::marks() const { return {}; }

}  // namespace hamel

#endif
