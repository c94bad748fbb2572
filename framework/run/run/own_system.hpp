// A system of a program's own, as a builder holds it: how to make it, and the kernels compiled for
// its types.
#pragma once

#include <functional>

#include <hamel/framework/run/names/registry.hpp>

namespace hamel {

struct OwnSystem {
  using Maker = std::function<SystemModel(const Parameters&)>;
  Maker make;
  /// Compiled in place of the registered ones for this scheme and retraction, without and with
  /// inputs; may be empty.
  KernelFactory kernel = {}, driven = {};
  SchemeInfo scheme = {};
  RetractionInfo retraction = {};
};

}  // namespace hamel
