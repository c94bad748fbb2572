// The version of the library and the commit it was built from, for records and `hamel --version`.
#pragma once

#include <string>
#include <string_view>

namespace hamel {

/// "0.1.0".
std::string_view version();

/// The commit, 12 hexadecimal digits, with "-dirty" when the tree had changes and then, when these
/// are of the sources, "-" with a hash of them; "unknown" outside a clone.
std::string_view git_hash();

/// "GCC 12.2.0".
std::string_view compiler();

/// The build type and what the user added: "Release -O3 -DNDEBUG; kernels -O3".
std::string_view build_flags();

/// All of these: two builds with one name compute the same bits.
std::string build_name();

}  // namespace hamel
