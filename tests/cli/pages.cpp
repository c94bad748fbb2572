// What the pages of runs, comparisons, sweeps and studies say, as the program writes them.
#include "program.hpp"

namespace {

using hamel::test::figure_of;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class Pages : public hamel::test::CommandLine {
 protected:
  /// status and text of the verdict of a run; empty without the page.
  std::pair<std::string, std::string> verdict(const std::vector<std::string>& arguments) const {
    const json page = page_of(arguments);
    if (page.is_null()) return {};
    const json& block = page["sections"][0]["blocks"][0];
    EXPECT_EQ(block["kind"], "verdict");
    return {block["status"], block["text"]};
  }
};

// OK means right: what is wrong or not known is a note that says so.
TEST_F(Pages, OkMeansRight) {
  if (page_of({"suslov"}).is_null()) GTEST_SKIP() << "built without the page";
  EXPECT_EQ(verdict({"suslov"}).first, "ok");
  EXPECT_EQ(verdict({"rattleback", "--check"}).first, "ok");
  const auto lost = verdict({"chaplygin_sleigh", "--scheme", "unadapted", "--step", "0.05"});
  EXPECT_EQ(lost.first, "note");
  EXPECT_THAT(lost.second, HasSubstr("off by at most **3.7e+01**"));
  EXPECT_THAT(lost.second, HasSubstr("leave the constraint"));
  const auto unknown = verdict({"falling_disk"});
  EXPECT_EQ(unknown.first, "note");
  EXPECT_THAT(unknown.second, HasSubstr("error is not known"));
  // Its estimate is small: it converges, to another motion.
  EXPECT_EQ(verdict({"chaplygin_sleigh", "--scheme", "unadapted", "--check", "--no-exact"}).first,
            "note");
}

}  // namespace
