// Characters of the names in a formula.
#pragma once

#include <cctype>

namespace hamel {

/// May a name of a quantity hold this character? steer.angle, pitch'
inline bool may_be_in_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '\'';
}

}  // namespace hamel
