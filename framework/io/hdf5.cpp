// Tables and files of rows in HDF5, where it is there.
#include <bit>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/hdf5_format.hpp>

namespace hamel {
namespace {

const hdf5::Format& format_for(const std::string& what) {
  const hdf5::Format* const format = hdf5::format();
  if (format == nullptr) throw ConfigError({fmt::format("{}: {}", what, hdf5_missing())});
  return *format;
}

}  // namespace

std::string hdf5_version() {
  const hdf5::Format* const format = hdf5::format();
  return format == nullptr ? "" : format->version();
}

std::string hdf5_missing() {
  if (hdf5::format() != nullptr) return "";
  const std::string reason = hdf5::reason();
  return reason.empty() ? "this build has no HDF5 (libhdf5-dev)" : "no HDF5: " + reason;
}

void Table::write_hdf5(const std::string& path,
                       const std::map<std::string, std::string>& texts) const {
  format_for(fmt::format("output: cannot write '{}'", path)).write_table(*this, path, texts);
}

Table read_hdf5(const std::string& path, std::map<std::string, std::string>* texts) {
  return format_for(fmt::format("'{}'", path)).read_table(path, texts);
}

// As FNV-1a, by numbers instead of bytes; turned, so that a sign counts as much as what is behind
// the point.
std::uint64_t checksum_of_rows(std::uint64_t before, std::span<const double> rows) {
  constexpr std::uint64_t prime = 1099511628211u;
  for (const double value : rows)
    before = std::rotl((before ^ std::bit_cast<std::uint64_t>(value)) * prime, 29);
  return before;
}

RowFileWriter::RowFileWriter(const std::string& path, const std::vector<ColumnGroup>& groups,
                             const std::map<std::string, std::string>& texts,
                             const NamedRows& named)
    : file_(format_for(fmt::format("'{}'", path)).write_rows(path, groups, texts, named)) {}
RowFileWriter::~RowFileWriter() = default;
void RowFileWriter::append(std::span<const double> rows) { file_->append(rows); }
void RowFileWriter::mark(std::string_view bytes) { file_->mark(bytes); }
void RowFileWriter::finish(const std::string& record, const NamedRows& named) {
  file_->finish(record, named);
}

RowFileReader::RowFileReader(const std::string& path)
    : file_(format_for(fmt::format("'{}'", path)).read_rows(path)) {}
RowFileReader::~RowFileReader() = default;
RowFileReader::RowFileReader(RowFileReader&&) noexcept = default;
const std::vector<ColumnGroup>& RowFileReader::groups() const { return file_->groups(); }
std::string RowFileReader::text(const std::string& name) const { return file_->text(name); }
bool RowFileReader::finished() const { return file_->finished(); }
std::string RowFileReader::record() const { return file_->record(); }
std::size_t RowFileReader::rows() const { return file_->rows(); }
std::optional<std::uint64_t> RowFileReader::checksum() const { return file_->checksum(); }
void RowFileReader::read(std::size_t first, std::size_t count, std::vector<double>& out) const {
  file_->read(first, count, out);
}
std::vector<RowFileReader::Mark> RowFileReader::marks() const { return file_->marks(); }

}  // namespace hamel
