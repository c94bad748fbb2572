// HDF5 as a module, opened at the first use.
#include <hamel/framework/io/hdf5_format.hpp>
#include <hamel/framework/io/module.hpp>

namespace hamel::hdf5 {

const Format* format() {
  static const Format* const opened = [] {
    const Module module = open_module("hdf5");
    return module.entry == nullptr ? nullptr
                                   : reinterpret_cast<const Format* (*)()>(module.entry)();
  }();
  return opened;
}

}  // namespace hamel::hdf5
