#pragma once

#include <cmath>
#include <optional>

namespace hamel {

/// The number as a `long`, or nothing where it has a fraction or is beyond 2^53, where doubles no
/// longer tell neighbours apart. (A conversion of 1e300 is undefined behaviour.)
inline std::optional<long> whole_number(double x) {
  constexpr double most = 9007199254740992.0;
  if (!(std::abs(x) <= most) || x != std::floor(x)) return std::nullopt;
  return static_cast<long>(x);
}

}  // namespace hamel
