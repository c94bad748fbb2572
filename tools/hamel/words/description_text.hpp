// Text of what hamel describe has found.
#pragma once

#include <nlohmann/json.hpp>

#include <hamel/framework/io/note_lines.hpp>

namespace hamel::tools {

/// A line for each member, with its key; lists of objects as indented lines, notes a line each.
/// Nothing for what is empty.
void print_description(const nlohmann::ordered_json& description, Notes length);

}  // namespace hamel::tools
