// One figure of a recorded run in a file of its own.
#include <array>
#include <cstdlib>
#include <filesystem>

#include "program.hpp"

namespace {

using testing::HasSubstr;
using testing::StartsWith;

class Figures : public hamel::test::CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    const auto outcome = run({"run", "suslov", "--until", "2", "--quiet", "-o", "run.h5"});
    if (outcome.err.find("HDF5") != std::string::npos) HAMEL_SKIP_WITHOUT("HDF5");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    if (page_of({"suslov"}).is_null()) HAMEL_SKIP_WITHOUT("page");
  }
  /// The bytes of a file of this figure, 8 cm wide; skips where there is no browser.
  std::string drawn(const std::string& figure, const std::string& name) const {
    const auto outcome =
        run({"report", "run.h5", "--figure", figure, "-o", name, "--width", "8cm"});
    if (outcome.err.find("which is not installed") != std::string::npos) return "";
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return hamel::test::contents(file(name));
  }
};

// Obstacles are reported at once, with the names that there are, and nothing is written.
TEST_F(Figures, Mistakes) {
  const auto refused = [&](std::vector<std::string> more, const std::string& before = "") {
    more.insert(more.begin(), {"report", "run.h5"});
    const auto outcome = run(more, before);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    return outcome.err;
  };
  const std::string wrong = refused({"--figure", "error", "-o", "error.jpg", "--width", "8"});
  EXPECT_THAT(wrong, HasSubstr("unknown output format '.jpg': expected one of .pdf, .svg, .png"));
  EXPECT_THAT(wrong, HasSubstr("--width: got '8', expected a number with its unit"));
  EXPECT_THAT(refused({"--figure", "error", "--width", "3km"}), HasSubstr("got '3km'"));
  EXPECT_THAT(refused({"--width", "8cm"}), HasSubstr("--figure"));
  EXPECT_THAT(refused({"--figure", "error"}, "CHROMIUM=/nowhere "),
              HasSubstr("drawn by the program chromium, which is not installed"));
  EXPECT_THAT(files(), testing::UnorderedElementsAre("run.h5", "page.html"));
}

// The folder of its pieces is removed, and the browser does not go on alone.
TEST_F(Figures, AnInterruptLeavesNothing) {
  // The browser itself interrupts the program, which otherwise might not have started it yet.
  write("slow", "#!/bin/sh\nkill -INT $PPID\nexec sleep 60\n");
  std::filesystem::permissions(file("slow"), std::filesystem::perms::owner_all);
  const auto outcome = run({"report", "run.h5", "--figure", "error", "-o", "error.svg"},
                           "TMPDIR=. CHROMIUM=./slow ");
  EXPECT_THAT(outcome.err, HasSubstr("interrupted"));
  EXPECT_THAT(files(), testing::UnorderedElementsAre("run.h5", "page.html", "slow"));
}

TEST_F(Figures, NamesAreListed) {
  const auto outcome = run({"report", "run.h5", "--figure", "eror"});
  if (outcome.err.find("which is not installed") != std::string::npos)
    HAMEL_SKIP_WITHOUT("browser");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err,
            "hamel: unknown figure 'eror': expected one of motion, axes, angular-velocity, "
            "reactions, angular-momentum-in-the-body, error, energy-error, constraint, "
            "group-defect; did you mean 'error'?\n");
}

// As wide as asked for in each format: SVG in centimetres, PNG with 300 dots to the inch, PDF of
// one page in points.
TEST_F(Figures, AsWideAsAskedFor) {
  const std::string svg = drawn("error", "error.svg");
  if (svg.empty()) HAMEL_SKIP_WITHOUT("browser");
  EXPECT_THAT(svg, StartsWith("<svg width=\"8cm\""));
  EXPECT_THAT(svg, HasSubstr("configuration</text>"));
  EXPECT_THAT(svg, testing::Not(HasSubstr("var(")));
  const std::string png = drawn("error", "error.png");
  ASSERT_GT(png.size(), 24u);
  EXPECT_THAT(png, StartsWith("\x89PNG"));
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(png[i]); };
  EXPECT_NEAR((byte(18) << 8) + byte(19), 8 / 2.54 * 300, 4);  // whole pixels of the page
  const std::string pdf = drawn("error", "error.pdf");
  EXPECT_THAT(pdf, StartsWith("%PDF"));
  const size_t box = pdf.find("/MediaBox [0 0 ");
  ASSERT_NE(box, std::string::npos);
  EXPECT_NEAR(std::atof(pdf.c_str() + box + 15), 8 / 2.54 * 72, 0.5);
  EXPECT_THAT(drawn("motion", "motion.svg"), StartsWith("<svg"));
}

}  // namespace
