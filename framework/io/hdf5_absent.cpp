// A build without HDF5.
#include <hamel/framework/io/hdf5_format.hpp>

namespace hamel::hdf5 {
const Format* format() { return nullptr; }
std::string reason() { return ""; }
}  // namespace hamel::hdf5
