// Modules: parts of the library that are opened when they are named, each a shared library
// hamel_<name>.so, because of what it links (Ceres: 25 libraries and a thread for each core). Linux
// and what is like it; not installed.
//
// A module is looked for in few folders, relative to the program or shared library that this code
// is part of: a tree that was moved finds its own, and no other.
#pragma once

#include <string>

namespace hamel {

/// The file of the module; "" where there is none.
std::string module_path(const std::string& name);

struct Module {
  void* entry = nullptr;  // the function hamel_<name>_<version>; null where the module is not open
  std::string reason;     // why not
};
/// Opens the module for the rest of the process.
Module open_module(const std::string& name);

}  // namespace hamel
