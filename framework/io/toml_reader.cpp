#include <hamel/framework/io/toml_reader.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <sstream>
#include <string_view>
#include <system_error>

#include <hamel/framework/io/text_file.hpp>

namespace hamel {
namespace {

constexpr std::string_view kConverted = " as TOML";
constexpr int kMaxDepth = 30;  // of brackets, and of the dots of one key

// Walks through a text as far as brackets, dots, numbers, strings and comments are concerned.
class Scan {
 public:
  explicit Scan(const std::string& text) : text_(text) {}

  // The first place that is too deep, or has a number that no double holds; else the end.
  size_t find() {
    while (at_ < text_.size() && brackets_ <= kMaxDepth && dots_ <= kMaxDepth && number_.empty())
      step();
    return number_.empty() && brackets_ <= kMaxDepth && dots_ <= kMaxDepth ? text_.size() : at_;
  }
  // The number there, if it is one.
  const std::string& number() const { return number_; }

 private:
  void step() {
    const char c = text_[at_];
    if (c == '"' || c == '\'') return skip_string(c);
    if (c == '#') {
      at_ = std::min(text_.find('\n', at_), text_.size());
      return;
    }
    if (is_digit(c) && (at_ == 0 || !is_of_name(text_[at_ - 1]))) return skip_number();
    ++at_;
    if (c == '.') ++dots_;
    else if (c == '[' || c == '{') ++brackets_;
    else if (c == ']' || c == '}') brackets_ = std::max(0, brackets_ - 1);
    // Dots add up along one key; a float has one, a list of floats a comma after each.
    if (c == ',' || c == '=' || c == '\n' || c == '[' || c == ']') dots_ = 0;
  }
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  static bool is_of_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
  }
  // toml++ takes 1e-400 for 0.
  void skip_number() {
    const size_t end = std::min(text_.find_first_not_of("0123456789_.eE+-", at_), text_.size());
    std::string digits = text_.substr(at_, end - at_);
    std::erase(digits, '_');
    double value = 0;
    const auto [behind, why] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (why == std::errc::result_out_of_range)
      number_ = digits.substr(0, static_cast<size_t>(behind - digits.data()));
    else at_ += 1;
  }
  // "...", '...', or one of three quotes, which may end with two more.
  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool lines = text_.compare(at_, 3, three) == 0;
    at_ += lines ? 3 : 1;
    while (at_ < text_.size()) {
      if (lines ? text_.compare(at_, 3, three) == 0 : text_[at_] == quote || text_[at_] == '\n') {
        at_ += lines ? 3 : 1;
        for (int i = 0; lines && i < 2 && at_ < text_.size() && text_[at_] == quote; ++i) ++at_;
        return;
      }
      at_ += quote == '"' && text_[at_] == '\\' ? 2 : 1;
    }
    at_ = text_.size();
  }

  const std::string& text_;
  size_t at_ = 0;
  int brackets_ = 0, dots_ = 0;
  std::string number_;
};

// Causes of the commonest mistakes of TOML, behind the view that its parser has of them.
std::string_view hint(std::string_view mistake) {
  const auto has = [&](std::string_view words) {
    return mistake.find(words) != std::string_view::npos;
  };
  if (has("could not determine value type"))
    return "; words and formulas are written in quotes, \"lift\"";
  if (has("unescaped control characters")) return "; a text ends on its line, with a quote";
  if (has("expected a comment or whitespace, saw"))
    return "; a number has no unit, and a point before its decimals";
  return "";
}

}  // namespace

TomlReader::TomlReader(const std::string& origin)
    : origin_(origin), converted_(origin.ends_with(kConverted)) {
  if (converted_) origin_.resize(origin_.size() - kConverted.size());
}

std::string TomlReader::place(const toml::source_position& at) const {
  return converted_ ? origin_ : fmt::format("{}:{}:{}", origin_, at.line, at.column);
}

std::string converted_origin(const std::string& file) { return file + std::string(kConverted); }

toml::table TomlReader::parse(const std::string& text) const {
  const auto refuse = [&](size_t at, const std::string& why) {
    const auto begin = text.begin(), here = begin + static_cast<std::ptrdiff_t>(at);
    const auto line = static_cast<toml::source_index>(1 + std::count(begin, here, '\n'));
    throw ConfigError({converted_ ? fmt::format("{}:{}", origin_, why.substr(why.find(' ')))
                                  : fmt::format("{}:{}:{}", origin_, line, why)});
  };
  if (text.size() > kMaxText)
    refuse(0, fmt::format(" {} characters, more than {}", text.size(), kMaxText));
  Scan scan(text);
  if (const size_t at = scan.find(); at < text.size()) {
    if (scan.number().empty()) refuse(at, fmt::format(" nested more than {} deep", kMaxDepth));
    const size_t line = text.rfind('\n', at) + 1;  // (npos + 1 is 0)
    const auto column = std::count_if(text.begin() + static_cast<std::ptrdiff_t>(line),
                                      text.begin() + static_cast<std::ptrdiff_t>(at),
                                      [](unsigned char c) { return (c & 0xC0) != 0x80; });
    refuse(at,
           fmt::format("{}: the number {} is too large or too small", column + 1, scan.number()));
  }
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw ConfigError({fmt::format("{}: {}{}", place(error.source().begin), error.description(),
                                   hint(error.description()))});
  }
}

void TomlReader::wrong_value(const toml::node& node, const std::string& key,
                             const std::string& expected) {
  if (node.is_table()) return wrong(node, key, expected);
  std::ostringstream text;
  text << toml::toml_formatter(node);
  std::string got;  // on one line
  for (const char c : text.str())
    if (c != '\n' && (c != ' ' || !got.ends_with(' '))) got += c;
  mistakes.push_back(
      fmt::format("{}: {}: got {}, expected {}", place(node), key, shortened(got), expected));
}

std::string toml_string(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

}  // namespace hamel
