// Text of what hamel describe has found.
#pragma once

#include <nlohmann/json.hpp>

namespace hamel::tools {

/// A line for each member, with its key; lists of objects as indented lines. Nothing for what is
/// empty.
void print_description(const nlohmann::ordered_json& description);

}  // namespace hamel::tools
