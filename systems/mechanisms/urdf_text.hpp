// Text of a URDF file before its parser reads it. Not installed.
//
// TinyXML, by which urdfdom reads, takes a stack frame for each level of elements, and time that
// grows with the square of the number of attributes of one element. So the tags are read here
// first, in one pass, by a grammar that is a part of XML's and of TinyXML's:
//   comment <!-- -->, CDATA <![CDATA[ ]]>, <! >, <? >, end </name>,
//   start <name attribute="value" …> or />, values in " or '.
// What does not fit it, or exceeds the limits, is refused with its line; TinyXML then sees the same
// tags, as both end a quoted value at its quote and nowhere else.
#pragma once

#include <string>

namespace hamel::mechanisms {

/// Throws ConfigError with the path and the line.
void check_urdf_text(const std::string& text, const std::string& path);

}  // namespace hamel::mechanisms
