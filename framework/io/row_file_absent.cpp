// Row files in a build without HDF5.
#include <cstdlib>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/row_file.hpp>

namespace hamel {

struct RowFileWriter::Data {};
struct RowFileReader::Data {};

namespace {
[[noreturn]] void no_hdf5(const std::string& path) {
  throw ConfigError({fmt::format("'{}': this build has no HDF5 (libhdf5-dev)", path)});
}
}  // namespace

std::uint64_t checksum_of_rows(std::uint64_t before, std::span<const double>) { return before; }
RowFileWriter::RowFileWriter(std::string path, const std::vector<ColumnGroup>&,
                             const std::map<std::string, std::string>&, const NamedRows&) {
  no_hdf5(path);
}
RowFileWriter::~RowFileWriter() = default;
void RowFileWriter::append(std::span<const double>) {}
void RowFileWriter::mark(std::string_view) {}
void RowFileWriter::finish(const std::string&, const NamedRows&) {}
RowFileReader::RowFileReader(const std::string& path) { no_hdf5(path); }
RowFileReader::~RowFileReader() = default;
RowFileReader::RowFileReader(RowFileReader&&) noexcept = default;
const std::vector<ColumnGroup>& RowFileReader::groups() const { std::abort(); }
std::optional<std::uint64_t> RowFileReader::checksum() const { return {}; }
std::string RowFileReader::text(const std::string&) const { return ""; }
std::string RowFileReader::record() const { return ""; }
bool RowFileReader::finished() const { return false; }
std::size_t RowFileReader::rows() const { return 0; }
void RowFileReader::read(std::size_t, std::size_t, std::vector<double>&) const {}
std::vector<RowFileReader::Mark> RowFileReader::marks() const { return {}; }

}  // namespace hamel
