// Text of a URDF file before its parser reads it. Not installed.
//
// TinyXML, by which urdfdom reads, takes a stack frame for each level of elements, and time that
// grows with the square of the number of attributes of one element. So the tags are read here
// first, in one pass, by a grammar that is a part of XML's and of TinyXML's:
//   comment <!-- -->, CDATA <![CDATA[ ]]>, <! >, <? >, end </name>,
//   start <name attribute="value" …> or />, values in " or '.
// What does not fit it, or exceeds the limits, is refused with its line; TinyXML then sees the same
// tags, as both end a quoted value at its quote and nowhere else.
//
// Macros of xacro are refused, but for those that change nothing here: properties and arguments
// that no number uses, calls of macros without a definition, and ${namespace} in names, which are
// taken out. Left out too are <material> elements and scales of meshes: urdfdom would report their
// mistakes, though nothing here uses them.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace hamel::mechanisms {

struct UrdfText {
  std::string text;                  // for the parser
  std::set<std::string> driven;      // joints of a <transmission>, or with a <command_interface>
  std::vector<std::string> cleaned;  // macros that were taken out of names, or replaced by defaults
};

/// Throws ConfigError with the path and the line.
UrdfText read_urdf_text(const std::string& text, const std::string& path);

}  // namespace hamel::mechanisms
