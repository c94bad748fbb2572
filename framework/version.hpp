// The version of the library and the commit it was built from, for records and `hamel --version`.
#pragma once

#include <string_view>

namespace hamel {

/// "0.1.0".
std::string_view version();

/// The commit, 12 hexadecimal digits, with "-dirty" when the tree had changes; "unknown" outside a
/// clone.
std::string_view git_hash();

}  // namespace hamel
