// The entry of the module hamel_hdf5.so.
#include <hamel/framework/io/export.hpp>
#include <hamel/framework/io/hdf5_format.hpp>

extern "C" HAMEL_API const hamel::hdf5::Format* HAMEL_MODULE_ENTRY();
extern "C" const hamel::hdf5::Format* HAMEL_MODULE_ENTRY() { return hamel::hdf5::format(); }
