// Notes in a report: a line each that ends with a clause or a word, never within a character, and
// the whole text on request.
#include <hamel/framework/io/note_lines.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using namespace hamel;

/// Bytes that are no continuation of a character.
size_t characters(const std::string& text) {
  size_t out = 0;
  for (const char c : text) out += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  return out;
}

TEST(Notes, ATextThatFitsIsWhole) {
  EXPECT_EQ(brief("a step turns by 3 rad", 21), "a step turns by 3 rad");
  EXPECT_EQ(brief("", 10), "");
  EXPECT_EQ(brief("ω ≤ π·2", 7), "ω ≤ π·2");  // 7 characters, 12 bytes
}

TEST(Notes, EndWithTheLastClauseThatFits) {
  EXPECT_EQ(brief("loads of statics: a, b, c and more", 24), "loads of statics: a …");
  EXPECT_EQ(brief("loads of statics: all of the others", 26), "loads of statics: all of …");
  EXPECT_EQ(brief("work is done; moving constraints do it", 24), "work is done …");
  EXPECT_EQ(brief("energy is lost (by an impact)", 24), "energy is lost …");
  EXPECT_EQ(brief("a: wheel of the cart is implied", 24), "a: wheel of the cart …");  // a word
}

TEST(Notes, AreCutAtNoPlaceWithinACharacter) {
  const std::string text = "τ: μ̄₀ ≠ Eᵀμ, ξξξξξξξξξξξξξξξξ (ω′ ≥ 0); φ(g) = 0 ’…’ ααααα";
  for (size_t width = 4; width < 70; ++width) {
    const std::string cut = brief(text, width);
    EXPECT_LE(characters(cut), width) << cut;
    if (cut == text) continue;
    ASSERT_TRUE(cut.ends_with(" …")) << cut;
    const std::string head = cut.substr(0, cut.size() - 4);
    EXPECT_TRUE(text.starts_with(head)) << cut;
    EXPECT_NE(static_cast<unsigned char>(text[head.size()]) & 0xC0, 0x80) << cut;
  }
}

TEST(Notes, OfAReportStateHowToSeeAll) {
  const std::string text(120, 'x'), some = "one short";
  EXPECT_EQ(note_lines({}, 13, Notes::brief), "");
  EXPECT_EQ(note_lines({some}, 13, Notes::brief), "  note       one short\n");
  EXPECT_EQ(note_lines({some, text}, 13, Notes::brief),
            "  note       one short\n  note       " + std::string(85, 'x') +
                " …\n             (--verbose: notes in full; in C++ and Python: .notes)\n");
  EXPECT_EQ(note_lines({text}, 13, Notes::whole), "  note       " + text + "\n");
}

}  // namespace
