// Text of files and of users, for a screen.
#pragma once

#include <string>
#include <string_view>

namespace hamel {

/// Control characters but line feed and tab as "\u001b", by which a terminal is not driven (in JSON
/// it is the same text); bytes that are no UTF-8 as "\xe9".
std::string visible(std::string_view text);

/// Is all of it UTF-8 (RFC 3629)?
bool is_utf8(std::string_view text);

}  // namespace hamel
