#include <hamel/framework/io/visible.hpp>

#include <array>

#include <fmt/format.h>

namespace hamel {
namespace {

struct Lead {
  unsigned char first, last;  // of the first byte
  unsigned char least, most;  // of the second; further ones are 80 to bf
  std::size_t length;
};
// Well-formed byte sequences: Unicode 15, table 3-7.
constexpr std::array<Lead, 9> kLeads = {{{0x00, 0x7f, 0, 0, 1},
                                         {0xc2, 0xdf, 0x80, 0xbf, 2},
                                         {0xe0, 0xe0, 0xa0, 0xbf, 3},
                                         {0xe1, 0xec, 0x80, 0xbf, 3},
                                         {0xed, 0xed, 0x80, 0x9f, 3},
                                         {0xee, 0xef, 0x80, 0xbf, 3},
                                         {0xf0, 0xf0, 0x90, 0xbf, 4},
                                         {0xf1, 0xf3, 0x80, 0xbf, 4},
                                         {0xf4, 0xf4, 0x80, 0x8f, 4}}};

// How many bytes of the text's first character are UTF-8; 0 where it is none.
std::size_t length_of_utf8(std::string_view text) {
  if (text.empty()) return 0;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  for (const Lead& lead : kLeads) {
    if (byte(0) < lead.first || byte(0) > lead.last) continue;
    if (text.size() < lead.length) return 0;
    for (std::size_t i = 1; i < lead.length; ++i) {
      const unsigned char least = i == 1 ? lead.least : 0x80, most = i == 1 ? lead.most : 0xbf;
      if (byte(i) < least || byte(i) > most) return 0;
    }
    return lead.length;
  }
  return 0;
}

}  // namespace

bool is_utf8(std::string_view text) {
  while (const std::size_t length = length_of_utf8(text)) text.remove_prefix(length);
  return text.empty();
}

std::string visible(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = length_of_utf8(text);
    const auto first = static_cast<unsigned char>(text[0]);
    const bool c0 =
        length == 1 && (first < 0x20 || first == 0x7f) && first != '\n' && first != '\t';
    const bool c1 = length == 2 && first == 0xc2 && static_cast<unsigned char>(text[1]) < 0xa0;
    if (length == 0) out += fmt::format("\\x{:02x}", first);
    else if (c0) out += fmt::format("\\u{:04x}", first);
    else if (c1) out += fmt::format("\\u{:04x}", static_cast<unsigned char>(text[1]));
    else out += text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return out;
}

}  // namespace hamel
