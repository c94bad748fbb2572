// HDF5 as it is linked.
#include <hamel/framework/io/hdf5_format.hpp>

namespace hamel::hdf5 {
namespace {

class Linked final : public Format {
 public:
  std::string version() const override { return library_version(); }
  void write_table(const Table& table, const std::string& path, const Texts& texts) const override {
    hdf5::write_table(table, path, texts);
  }
  Table read_table(const std::string& path, Texts* texts) const override {
    return hdf5::read_table(path, texts);
  }
  std::unique_ptr<RowWriter> write_rows(const std::string& path,
                                        const std::vector<ColumnGroup>& groups, const Texts& texts,
                                        const NamedRows& named) const override {
    return hdf5::write_rows(path, groups, texts, named);
  }
  std::unique_ptr<RowReader> read_rows(const std::string& path) const override {
    return hdf5::read_rows(path);
  }
};

}  // namespace

const Format* format() {
  static const Linked linked;
  return &linked;
}

std::string reason() { return ""; }

}  // namespace hamel::hdf5
