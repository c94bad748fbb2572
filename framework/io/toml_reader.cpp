#include <hamel/framework/io/toml_reader.hpp>

#include <algorithm>

#include <hamel/framework/io/text_file.hpp>

namespace hamel {
namespace {

constexpr int kMaxDepth = 30;  // of brackets, and of the dots of one key

// Walks through a text as far as brackets, dots, strings and comments are concerned.
class Depth {
 public:
  explicit Depth(const std::string& text) : text_(text) {}

  // The first place that is too deep, else the end.
  size_t find() {
    while (at_ < text_.size() && brackets_ <= kMaxDepth && dots_ <= kMaxDepth) step();
    return brackets_ > kMaxDepth || dots_ > kMaxDepth ? at_ : text_.size();
  }

 private:
  void step() {
    const char c = text_[at_];
    if (c == '"' || c == '\'') return skip_string(c);
    if (c == '#') {
      at_ = std::min(text_.find('\n', at_), text_.size());
      return;
    }
    ++at_;
    if (c == '.') ++dots_;
    else if (c == '[' || c == '{') ++brackets_;
    else if (c == ']' || c == '}') brackets_ = std::max(0, brackets_ - 1);
    // Dots add up along one key; a float has one, a list of floats a comma after each.
    if (c == ',' || c == '=' || c == '\n' || c == '[' || c == ']') dots_ = 0;
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
};

}  // namespace

toml::table TomlReader::parse(const std::string& text) const {
  const auto refuse = [&](size_t at, const std::string& why) {
    const auto begin = text.begin(), here = begin + static_cast<std::ptrdiff_t>(at);
    const auto line = static_cast<toml::source_index>(1 + std::count(begin, here, '\n'));
    throw ConfigError({fmt::format("{}:{}: {}", origin_, line, why)});
  };
  if (text.size() > kMaxText)
    refuse(0, fmt::format("{} characters, more than {}", text.size(), kMaxText));
  if (const size_t at = Depth(text).find(); at < text.size())
    refuse(at, fmt::format("nested more than {} deep", kMaxDepth));
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw ConfigError({fmt::format("{}: {}", place(error.source().begin), error.description())});
  }
}

std::string toml_string(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

}  // namespace hamel
