#include <hamel/systems/mechanisms/urdf/urdf_text.hpp>

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/visible.hpp>
#include <hamel/systems/mechanisms/urdf/urdf_macros.hpp>

namespace hamel::mechanisms {
namespace {

constexpr size_t kMostLinks = 5000;
constexpr size_t kMostDepth = 64;       // of elements
constexpr size_t kMostAttributes = 64;  // of one element

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool begins_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80;
}
bool in_name(char c) {
  return begins_name(c) || (c >= '0' && c <= '9') || c == '-' || c == '.' || c == ':';
}

class Scanner {
 public:
  Scanner(const std::string& text, const std::string& path) : text_(text), path_(path) {}

  UrdfText run() {
    if (const size_t zero = text_.find('\0'); zero != std::string_view::npos)
      refuse(zero, "a zero byte, expected text");
    for (at_ = text_.find('<'); at_ != std::string_view::npos; at_ = text_.find('<', at_)) tag();
    if (!open_.empty())
      refuse(text_.size(), fmt::format("<{}> is not closed", shortened(std::string(open_.back()))));
    check_root();
    out_.text += text_.substr(copied_);
    out_.cleaned = macros_.replaced();
    return std::move(out_);
  }

 private:
  [[noreturn]] void refuse(size_t at, const std::string& why) const {
    const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<long>(at), '\n');
    throw ConfigError({fmt::format("{}:{}: not a robot as URDF has it: {}", path_, line, why)});
  }
  void check_root() const {
    if (root_.empty() || root_ == "robot") return;  // without an element: urdfdom's mistake
    std::string what = fmt::format("its first element is <{}>", shortened(std::string(root_)));
    if (root_ == "sdf") what = "it is SDF, of Gazebo";
    if (root_ == "mujoco") what = "it is MJCF, of MuJoCo";
    refuse(root_at_, what + ", expected <robot>; other formats are not read, export it as URDF");
  }
  bool ahead(std::string_view word) const { return text_.substr(at_, word.size()) == word; }
  char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void skip_spaces() {
    while (is_space(here())) ++at_;
  }
  // Behind the end of what begins here with so many characters.
  void skip_behind(std::string_view end, size_t beginning, const char* what) {
    const size_t found = text_.find(end, at_ + beginning);
    if (found == std::string_view::npos) refuse(at_, fmt::format("{} without its {}", what, end));
    at_ = found + end.size();
  }
  std::string_view name() {
    const size_t begin = at_;
    if (!begins_name(here())) refuse(at_, "expected a name behind '<', or &lt; for the character");
    while (in_name(here())) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  void tag() {
    if (ahead("<!--")) return skip_behind("-->", 4, "a comment");
    if (ahead("<![CDATA[")) return skip_behind("]]>", 9, "CDATA");
    if (ahead("<!") || ahead("<?")) return skip_behind(">", 2, "a declaration");
    if (ahead("</")) return end_tag();
    start_tag();
  }

  void end_tag() {
    const size_t begin = at_;
    at_ += 2;
    const std::string_view closed = name();
    skip_spaces();
    if (here() != '>') refuse(begin, "an end tag without its >");
    if (open_.empty() || open_.back() != closed)
      refuse(begin, fmt::format("</{}>, expected {}", shortened(std::string(closed)),
                                open_.empty() ? "no end tag"
                                              : "</" + shortened(std::string(open_.back())) + ">"));
    open_.pop_back();
    if (open_.size() == material_depth_) replace(material_at_, at_ + 1, "");
  }

  // A part of the text as the parser sees it; behind the parts that were replaced before.
  void replace(size_t begin, size_t end, std::string_view by) {
    out_.text += text_.substr(copied_, begin - copied_);
    out_.text += by;
    copied_ = end;
    material_depth_ = kMostDepth + 1;
  }
  bool in_material() const { return open_.size() > material_depth_; }

  void start_tag() {
    const size_t begin = at_++;
    const std::string_view element = name();
    if (element == "link" && ++links_ > kMostLinks)
      refuse(begin, fmt::format("more than {} links", kMostLinks));
    if (root_.empty()) {
      root_ = element;
      root_at_ = begin;
    }
    if (const std::string why = macros_.begin(element); !why.empty()) refuse(begin, why);
    if (element == "command_interface" && !open_.empty() && open_.back() == "joint")
      out_.driven.insert(joint_);
    for (size_t count = 0;; ++count) {
      skip_spaces();
      if (here() == '>') break;
      if (ahead("/>")) {
        if (element == "material" && !in_material()) replace(begin, at_ + 2, "");
        return;
      }
      if (count == kMostAttributes)
        refuse(begin, fmt::format("<{}> has more than {} attributes",
                                  shortened(std::string(element)), kMostAttributes));
      attribute(begin, element);
    }
    if (element == "material" && !in_material()) {
      material_at_ = begin;
      material_depth_ = open_.size();
    }
    open_.push_back(element);
    if (open_.size() > kMostDepth)
      refuse(begin, fmt::format("elements nested more than {} deep", kMostDepth));
  }

  void attribute(size_t begin, std::string_view element) {
    if (!begins_name(here()))
      refuse(begin, fmt::format("<{}>: expected name=\"value\", > or />",
                                shortened(std::string(element))));
    const std::string_view attribute = name();
    skip_spaces();
    const bool assigned = here() == '=';
    if (assigned) ++at_;
    skip_spaces();
    const char quote = here();
    if (!assigned || (quote != '"' && quote != '\''))
      refuse(begin,
             fmt::format("<{} {}>: expected a value in quotes", shortened(std::string(element)),
                         shortened(std::string(attribute))));
    const size_t first = at_ + 1;
    skip_behind(std::string_view(&quote, 1), 1, "a value");
    take(begin, element, attribute, first);
  }

  // The value from `first` to the quote before at_, its macros replaced.
  void take(size_t begin, std::string_view element, std::string_view attribute, size_t first) {
    const std::string_view given = text_.substr(first, at_ - 1 - first);
    if (in_material() || element == "material") return;
    std::string value(element == "mesh" && attribute == "scale" ? "1 1 1" : given);
    if (const std::string why = macros_.replace(open_, element, attribute, value); !why.empty())
      refuse(begin, why);
    if (value != given) replace(first, at_ - 1, value);
    if (element != "joint" || attribute != "name") return;
    joint_ = value;
    if (std::ranges::find(open_, "transmission") != open_.end()) out_.driven.insert(value);
  }

  std::string_view text_;
  const std::string& path_;
  size_t at_ = 0, links_ = 0, copied_ = 0, root_at_ = 0;
  size_t material_at_ = 0, material_depth_ = kMostDepth + 1;  // of the outermost that is open
  std::vector<std::string_view> open_;
  std::string_view root_;
  std::string joint_;  // the last name of one
  UrdfMacros macros_;
  UrdfText out_;
};

}  // namespace

UrdfText read_urdf_text(const std::string& text, const std::string& path) {
  size_t begin = 0;
  for (int line = 1; begin < text.size(); ++line) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    if (!is_utf8(std::string_view(text).substr(begin, end - begin)))
      throw ConfigError({fmt::format("{}:{}: is no UTF-8", path, line)});
    begin = end + 1;
  }
  return Scanner(text, path).run();
}

}  // namespace hamel::mechanisms
