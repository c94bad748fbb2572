// Kernels compiled for mechanisms.
#pragma once

#include <hamel/framework/run/names/registry.hpp>

namespace hamel {

/// Behind the schemes, on which they fall back.
void add_mechanism_kernels(Registry& registry);

}  // namespace hamel
