#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/row_file_format.hpp>

namespace hamel::hdf5 {
namespace {

constexpr hsize_t kChunkRows = 4096, kChunkBytes = 1 << 16;

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

// Type of a row of a set of named rows: its name, then the numbers.
Handle type_of_named(const NamedRows& named) {
  const std::size_t size = std::max<std::size_t>(named.longest, 1);
  Handle type(H5Tcreate(H5T_COMPOUND, size + named.columns.size() * sizeof(double)), H5Tclose,
              "H5Tcreate");
  check(H5Tinsert(type, named.name.c_str(), 0, text_type(size)), "H5Tinsert");
  for (std::size_t i = 0; i < named.columns.size(); ++i)
    check(H5Tinsert(type, named.columns[i].c_str(), size + i * sizeof(double), H5T_IEEE_F64LE),
          "H5Tinsert");
  return type;
}

void write_named(hid_t set, const NamedRows& named) {
  const std::size_t size = std::max<std::size_t>(named.longest, 1);
  std::string bytes;
  for (const NamedRows::Row& row : named.rows) {
    std::string name = row.name;
    name.resize(size, '\0');
    bytes += name;
    for (double value : row.values) {  // little endian, as in the file
      auto bits = std::bit_cast<std::uint64_t>(value);
      for (std::size_t i = 0; i < sizeof bits; ++i, bits >>= 8) bytes += static_cast<char>(bits);
    }
  }
  if (!named.rows.empty())
    append_to(set, type_of_named(named), 0, named.rows.size(), 1, bytes.data());
}

class Writer final : public RowWriter {
 public:
  Writer(const std::string& path, const std::vector<ColumnGroup>& groups, const Texts& texts,
         const NamedRows& named);
  void append(std::span<const double> rows) override;
  void mark(std::string_view bytes) override;
  void finish(const std::string& record, const NamedRows& named) override;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

struct Writer::Data {
  std::string path;
  std::vector<hsize_t> widths;
  std::unique_ptr<Handle> file;
  std::vector<std::unique_ptr<Handle>> sets;
  std::unique_ptr<Handle> marks, record, named;
  hsize_t width = 0, rows = 0, marked = 0;
  std::vector<double> column;
  bool given_up = false;
  std::uint64_t sum = kNoRows, texts = kNoRows;

  // After a failed write the library cannot close the file; it stays as it was last flushed.
  void abandon() {
    given_up = true;
    for (auto& set : sets) static_cast<void>(set.release());
    static_cast<void>(marks.release());
    static_cast<void>(record.release());
    static_cast<void>(named.release());
    static_cast<void>(file.release());
  }
  template <class F>
  void attempt(F&& write) {
    if (given_up) throw Unfinished(fmt::format("output: '{}' was given up", path));
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

Writer::Writer(const std::string& path, const std::vector<ColumnGroup>& groups, const Texts& texts,
               const NamedRows& named)
    : data_(std::make_unique<Data>()) {
  begin();
  Data& d = *data_;
  d.path = path;
  d.attempt([&] {
    const Handle properties(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "H5Pcreate");
    check(H5Pset_link_creation_order(properties, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED),
          "H5Pset_link_creation_order");
    // Names in the group's own header, which has a checksum: from a damaged heap of them the
    // library frees memory that it has not filled (H5G__dense_iterate of 1.10).
    check(H5Pset_link_phase_change(properties, 4096, 0), "H5Pset_link_phase_change");
    d.file = std::make_unique<Handle>(
        H5Fcreate(d.path.c_str(), H5F_ACC_TRUNC, properties, latest_format()), H5Fclose,
        "H5Fcreate");
    const hid_t file = *d.file;
    for (const auto& [name, value] : texts) {
      write_bytes(file, name, value);
      d.texts = checksum_of_text(name, value, d.texts);
    }
    write_number(file, kFinished, H5T_STD_U8LE, 0);
    write_number(file, kChecksum, H5T_STD_U64LE, d.sum);
    for (const ColumnGroup& group : groups) {
      const hsize_t width = group.columns.size();
      auto set =
          std::make_unique<Handle>(create(file, group.name, H5T_IEEE_F64LE, kChunkRows, width));
      write_fixed_text(*set, "unit", group.unit);
      write_fixed_text(*set, "meaning", group.meaning);
      write_fixed_text(*set, "frame", group.frame);
      write_fixed_text(*set, "columns", fmt::format("{}", fmt::join(group.columns, ",")));
      d.texts = checksum_of_columns(group, d.texts);
      d.sets.push_back(std::move(set));
      d.widths.push_back(width);
      d.width += width;
    }
    write_number(file, kTexts, H5T_STD_U64LE, d.texts);
    d.marks = std::make_unique<Handle>(create(file, kMarks, H5T_STD_U8LE, kChunkBytes, 1));
    d.record = std::make_unique<Handle>(create(file, kRecord, H5T_STD_U8LE, kChunkBytes, 1));
    if (!named.set.empty())
      d.named = std::make_unique<Handle>(create(file, named.set, type_of_named(named), 256, 1));
    check(H5Fstart_swmr_write(file), "H5Fstart_swmr_write");
  });
}

void Writer::append(std::span<const double> rows) {
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
  d.sum = checksum_of_rows(d.sum, rows);
}

void Writer::mark(std::string_view bytes) {
  Data& d = *data_;
  const MarkHead head = {d.rows, d.sum, bytes.size(), checksum(bytes)};
  std::string text(sizeof head, '\0');
  std::memcpy(text.data(), head.data(), sizeof head);
  text += bytes;
  d.attempt([&] {
    append_to(*d.marks, H5T_NATIVE_UINT8, d.marked, text.size(), 1, text.data());
    check(H5Dflush(*d.marks), "H5Dflush");
  });
  d.marked += text.size();
}

void Writer::finish(const std::string& record, const NamedRows& named) {
  Data& d = *data_;
  d.attempt([&] {
    append_to(*d.record, H5T_NATIVE_UINT8, 0, record.size(), 1, record.data());
    if (d.named != nullptr) write_named(*d.named, named);
    check(H5Fflush(*d.file, H5F_SCOPE_LOCAL), "H5Fflush");
    write_number(*d.file, kChecksum, H5T_STD_U64LE, d.sum);
    write_number(*d.file, kTexts, H5T_STD_U64LE, checksum_of_text(kRecord, record, d.texts));
    write_number(*d.file, kFinished, H5T_STD_U8LE, 1);
    check(H5Fflush(*d.file, H5F_SCOPE_LOCAL), "H5Fflush");
    d.sets.clear();
    d.marks.reset();
    d.record.reset();
    d.named.reset();
    d.file.reset();
  });
}

}  // namespace

std::unique_ptr<RowWriter> write_rows(const std::string& path,
                                      const std::vector<ColumnGroup>& groups, const Texts& texts,
                                      const NamedRows& named) {
  return std::make_unique<Writer>(path, groups, texts, named);
}

}  // namespace hamel::hdf5
