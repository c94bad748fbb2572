#include <hamel/systems/mechanisms/urdf/urdf_macros.hpp>

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>

namespace hamel::mechanisms {
namespace {

constexpr std::string_view kXacro = "xacro:";
constexpr std::string_view kDefault = "$(optenv ";
constexpr const char* kExpand = "macros are expanded by `xacro robot.urdf.xacro -o robot.urdf`";
// Elements of a file that xacro expands; others are calls of macros that such a file defines.
constexpr std::array<std::string_view, 7> kWords = {"include", "macro",        "if",     "unless",
                                                    "call",    "insert_block", "element"};
// Attributes that name a link or a joint, and those with numbers and words that a mechanism has.
constexpr std::array<std::string_view, 3> kNames = {"name", "link", "joint"};
constexpr std::array<std::string_view, 24> kNumbers = {
    "xyz",     "rpy",      "value",      "ixx",    "ixy",   "ixz",   "iyy",        "iyz",
    "izz",     "radius",   "length",     "size",   "lower", "upper", "effort",     "velocity",
    "damping", "friction", "multiplier", "offset", "type",  "scale", "k_position", "k_velocity"};
constexpr std::array<std::string_view, 4> kOthers = {"gazebo", "transmission", "ros2_control",
                                                     "sensor"};

template <size_t N>
bool among(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

// The first ${…} or $(…), empty where there is none.
std::string_view first_macro(std::string_view value) {
  for (size_t at = value.find('$'); at != std::string_view::npos; at = value.find('$', at + 1)) {
    const char open = at + 1 < value.size() ? value[at + 1] : '\0';
    if (open != '{' && open != '(') continue;
    const size_t end = value.find(open == '{' ? '}' : ')', at);
    return value.substr(at, end == std::string_view::npos ? end : end + 1 - at);
  }
  return {};
}

}  // namespace

std::string UrdfMacros::begin(std::string_view element) {
  property_.clear();
  if (!element.starts_with(kXacro) || element == "xacro:property" || element == "xacro:arg")
    return "";
  const std::string tag = fmt::format("<{}>", shortened(std::string(element)));
  if (among(kWords, element.substr(kXacro.size())))
    return fmt::format("{} is of a macro file: {}", tag, kExpand);
  note(tag);
  return "";
}

void UrdfMacros::note(const std::string& macro) {
  if (std::ranges::find(replaced_, macro) == replaced_.end()) replaced_.push_back(macro);
}

std::string UrdfMacros::replace(const std::vector<std::string_view>& open, std::string_view element,
                                std::string_view attribute, std::string& value) {
  const bool macro = !first_macro(value).empty();
  if (element.starts_with(kXacro)) {
    if (attribute == "name") property_ = value;
    if (attribute == "value" && !macro) properties_.insert(property_);
    return "";
  }
  const auto other = [](std::string_view name) { return among(kOthers, name); };
  if (!macro || other(element) || std::ranges::any_of(open, other)) return "";
  const auto refused = [&](std::string_view what) {
    return fmt::format("<{} {}>: '{}' is a macro: {}", shortened(std::string(element)), attribute,
                       shortened(std::string(what)), kExpand);
  };
  if (among(kNumbers, attribute)) {
    const std::string macro_there(first_macro(value));
    if (!macro_there.starts_with(kDefault) || value != macro_there) return refused(macro_there);
    const size_t name = macro_there.find_first_not_of(' ', kDefault.size());
    const size_t begin = std::min(macro_there.find(' ', name), macro_there.size() - 1);
    value = macro_there.substr(begin, macro_there.size() - 1 - begin);
    note(macro_there);
    return "";
  }
  if (!among(kNames, attribute)) return "";  // colours, files
  for (std::string_view found = first_macro(value); !found.empty(); found = first_macro(value)) {
    const bool whole = found.ends_with('}') || found.ends_with(')');
    const bool word = std::ranges::all_of(found.substr(2, found.size() - 3), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             c == '_' || c == ' ';
    });
    if (!whole || !word || properties_.contains(found.substr(2, found.size() - 3)))
      return refused(found);
    const std::string text(found);
    note(text);
    value.erase(value.find(text), text.size());
  }
  return "";
}

}  // namespace hamel::mechanisms
