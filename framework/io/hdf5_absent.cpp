// A build without HDF5.
#include <hamel/framework/io/hdf5_format.hpp>

namespace hamel::hdf5 {
const Format* format() { return nullptr; }
}  // namespace hamel::hdf5
