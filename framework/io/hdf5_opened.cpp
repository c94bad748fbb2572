// HDF5 as a module, opened at the first use.
#include <hamel/framework/io/hdf5_format.hpp>
#include <hamel/framework/io/module.hpp>

namespace hamel::hdf5 {
namespace {

const Module& module() {
  static const Module opened = open_module("hdf5");
  return opened;
}

}  // namespace

const Format* format() {
  static const Format* const opened =
      module().entry == nullptr ? nullptr : reinterpret_cast<const Format* (*)()>(module().entry)();
  return opened;
}

std::string reason() { return module_path("hdf5").empty() ? "" : module().reason; }

}  // namespace hamel::hdf5
