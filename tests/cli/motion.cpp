// The motion of a recorded run as a film, a picture and a page; the playground with a system in it.
#include <filesystem>

#include "program.hpp"

namespace {

using hamel::test::contents;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

using Words = std::vector<std::string>;

class Motion : public hamel::test::CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    const auto outcome = run({"run", "bicycle", "--until", "0.4", "--quiet", "-o", "run.h5"});
    if (outcome.err.find("HDF5") != std::string::npos) HAMEL_SKIP_WITHOUT("HDF5");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    if (page_of({"suslov"}).is_null()) HAMEL_SKIP_WITHOUT("page");
  }
  hamel::test::Outcome motion(const std::string& path, Words more = {},
                              const std::string& before = "") const {
    more.insert(more.begin(), {"report", "run.h5", "--motion", "-o", path});
    return run(more, before);
  }
  std::string refused(const std::string& path, const Words& more = {},
                      const std::string& before = "") const {
    const auto outcome = motion(path, more, before);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(file(path)));
    return outcome.err;
  }
  /// The bytes of the file; empty where there is no browser or no ffmpeg.
  std::string written(const std::string& path, const Words& more = {}) const {
    const auto outcome = motion(path, more);
    if (outcome.err.find("which is not installed") != std::string::npos) return "";
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return contents(file(path));
  }
};

// Big-endian numbers of a PNG's head.
std::pair<int, int> size_of_png(const std::string& png) {
  const auto number = [&](size_t at) {
    int out = 0;
    for (size_t i = at; i < at + 4; ++i) out = out * 256 + static_cast<unsigned char>(png.at(i));
    return out;
  };
  return {number(16), number(20)};
}

TEST_F(Motion, Mistakes) {
  EXPECT_THAT(refused("m.mov"), HasSubstr("unknown output format '.mov': expected one of .webm"));
  EXPECT_THAT(refused("m.png", {"--size", "big"}), HasSubstr("--size: got 'big', expected pixels"));
  EXPECT_THAT(refused("m.png", {"--size", "10x100000"}), HasSubstr("each 64 to 4096"));
  EXPECT_THAT(refused("m.png", {"--strobe", "1"}), HasSubstr("--strobe: got 1, expected a count"));
  EXPECT_THAT(refused("m.png", {"--speed", "2"}), HasSubstr("--speed: of .webm and .gif, not of"));
  EXPECT_THAT(refused("m.html", {"--at", "0.1"}), HasSubstr("--at: of .png, .svg and .pdf"));
  EXPECT_THAT(refused("m.webm", {"--size", "641x360"}), HasSubstr("expected even numbers"));
  EXPECT_THAT(refused("m.png", {}, "CHROMIUM=/nowhere "),
              AllOf(HasSubstr("apt-get install chromium"), HasSubstr("-o motion.html needs none")));
  EXPECT_THAT(refused("m.gif", {}, "FFMPEG=/nowhere "), HasSubstr("apt-get install ffmpeg"));
}

// A page needs neither browser nor ffmpeg.
TEST_F(Motion, APage) {
  const auto outcome = motion("m.html", {"--size", "640x360"}, "CHROMIUM=/no FFMPEG=/no ");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto data = hamel::test::page_data(contents(file("m.html")));
  EXPECT_EQ(data["picture"]["player"], true);
  EXPECT_EQ(data["picture"]["width"], 640);
  const auto& motion = data["sections"][0]["blocks"][0];
  EXPECT_EQ(motion["kind"], "animation");
  const auto wheels = [&] {
    int count = 0;
    for (const auto& body : motion["bodies"])
      for (const auto& shape : body["shapes"]) count += shape["shape"] == "wheel";
    return count;
  };
  EXPECT_EQ(wheels(), 2);
}

TEST_F(Motion, Pictures) {
  const std::string png = written("m.png", {"--size", "500x300", "--at", "0.2"});
  if (png.empty()) HAMEL_SKIP_WITHOUT("browser");
  ASSERT_THAT(png, StartsWith("\x89PNG"));
  EXPECT_EQ(size_of_png(png), std::pair(500, 300));
  const std::string svg = written("m.svg", {"--size", "500x300"});
  EXPECT_THAT(svg, AllOf(HasSubstr("width=\"500\" height=\"300\""), Not(HasSubstr("var("))));
  EXPECT_THAT(svg, HasSubstr("<rect width=\"100%\""));
  EXPECT_THAT(written("clear.svg", {"--transparent"}), Not(HasSubstr("<rect width=\"100%\"")));
  // Bodies at more times are more faces.
  EXPECT_GT(written("many.svg", {"--strobe", "4"}).size(), 2 * svg.size());
  EXPECT_THAT(motion("m.svg", {"--at", "3"}).err,
              HasSubstr("--at: got 3, expected a time of the run, 0 to 0.4"));
}

// 0.4 s at a tenth of the speed, 20 frames a second.
TEST_F(Motion, AFilm) {
  const std::string gif = written("m.gif", {"--size", "128x96", "--speed", "0.5"});
  if (gif.empty()) HAMEL_SKIP_WITHOUT("browser or no ffmpeg");
  EXPECT_THAT(gif, StartsWith("GIF89a"));
  size_t frames = 0;
  for (size_t at = 0; (at = gif.find(std::string("\x21\xf9\x04", 3), at)) != std::string::npos;
       ++at)
    ++frames;
  EXPECT_NEAR(static_cast<double>(frames), 0.4 / 0.5 * 20 + 1, 1);
  EXPECT_THAT(motion("m.gif", {"--speed", "1e-6"}).err,
              HasSubstr("frames, expected at most 20000"));
}

// A frame is painted once: software WebGL takes most of the time of a film.
TEST_F(Motion, AFrameIsPaintedOnce) {
  write("browser",
        "#!/bin/sh\n"
        "\"$(command -v chromium chromium-browser google-chrome | head -1)\" \"$@\" | tee '" +
            file("drawn") + "'\n");
  std::filesystem::permissions(file("browser"), std::filesystem::perms::owner_all);
  const auto outcome = motion("m.gif", {"--size", "128x96", "--speed", "0.5"},
                              "CHROMIUM='" + file("browser") + "' ");
  const std::string page = contents(file("drawn"));
  if (page.empty()) HAMEL_SKIP_WITHOUT("browser or no ffmpeg");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string mark = "data-drawings=\"";
  const size_t at = page.find(mark);
  ASSERT_NE(at, std::string::npos);
  const int frames = 17, others = 6;
  EXPECT_LE(std::stoi(page.substr(at + mark.size())), frames + others);
}

class Live : public hamel::test::CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    write("stub.html", "<html><head><!--LIVE--></head><body></body></html>");
  }
  hamel::test::Outcome live(Words words) const {
    words.insert(words.begin(), {"live", "--no-open"});
    return run(words, "HAMEL_PLAYGROUND=stub.html ");
  }
};

TEST_F(Live, TheTextIsInThePage) {
  write("cart.toml", "name = \"cart\"  # </script>\n");
  const auto outcome = live({"cart.toml", "-o", "cart.html"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(StartsWith("file:///"), HasSubstr("cart.html")));
  EXPECT_EQ(contents(file("cart.html")),
            "<html><head><script type=\"application/json\" id=\"live\">{\"text\":\"name = "
            "\\\"cart\\\"  # \\u003c/script>\\n\"}</script></head><body></body></html>");
  ASSERT_EQ(live({"bicycle", "-o", "b.html"}).status, 0);
  EXPECT_THAT(contents(file("b.html")), HasSubstr("{\"system\":\"bicycle\"}"));
}

// Sliders of the page; it reads no tables.
TEST_F(Live, OptionsOfARun) {
  const auto outcome = live({"segway", "-o", "s.html", "--until", "3", "--velocity", "0,1,0,0,0,0",
                             "--set", "gravity=9", "--input", "left_torque=2", "--no-exact"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(contents(file("s.html")),
              HasSubstr(R"({"inputs":{"left_torque":2.0},"options":{"no_exact":"true",)"
                        R"("until":"3","velocity":"0,1,0,0,0,0"},"parameters":{"gravity":[9.0]},)"
                        R"("system":"segway"})"));
  const auto refused = [&](Words words) {
    const auto wrong = live(std::move(words));
    EXPECT_EQ(wrong.status, 2) << wrong.err;
    return wrong.err;
  };
  EXPECT_THAT(refused({"segway", "--set", "masss=2"}), HasSubstr("masss"));
  EXPECT_THAT(refused({"segway", "--velocity", "1,2"}), HasSubstr("velocity"));
  EXPECT_THAT(refused({"segway", "--until", "soon"}), HasSubstr("--until"));
  EXPECT_THAT(refused({"segway", "--input", "left_torque=t.csv"}), HasSubstr("reads no tables"));
  write("wrong.toml", "name = \"x\"\nbody = [\n");  // the page shows what is wrong
  EXPECT_EQ(live({"wrong.toml", "-o", "w.html", "--until", "3"}).status, 0);
}

TEST_F(Live, Mistakes) {
  EXPECT_THAT(live({"bicicle"}).err, HasSubstr("did you mean 'bicycle'?"));
  EXPECT_THAT(live({"none.toml"}).err, HasSubstr("none.toml"));
  EXPECT_THAT(live({"bicycle", "--port", "70000"}).err, HasSubstr("--port: got 70000"));
  EXPECT_THAT(live({"bicycle", "-o", "b.txt"}).err, HasSubstr("expected a .html file"));
  const auto absent = run({"live", "bicycle", "--no-open"}, "HAMEL_PLAYGROUND=nowhere.html ");
  EXPECT_EQ(absent.status, 2);
  EXPECT_THAT(absent.err, HasSubstr("tools/setup --playground"));
}

}  // namespace
