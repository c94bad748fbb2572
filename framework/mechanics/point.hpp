// A point or a direction in space. Standard-library types only.
#pragma once

#include <array>

namespace hamel {

using Point = std::array<double, 3>;

}  // namespace hamel
