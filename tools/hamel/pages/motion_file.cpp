// Films are frames that the page draws, a PNG each, and ffmpeg puts together.
#include "pages/motion_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/figures/figures.hpp>
#include <hamel/framework/figures/run_figures.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/pages/page.hpp>
#include <hamel/systems/by_name.hpp>

#include "pages/browser.hpp"
#include "pages/figure_file.hpp"
#include "pages/programs.hpp"

namespace hamel::tools {

using pages::Figure;
using pages::Page;
using pages::page_mistakes;
using pages::PictureOptions;
namespace {

constexpr int kLeastSize = 64, kMostSize = 4096, kMostStrobe = 100, kMostFrames = 20000;
constexpr size_t kFramesAtOnce = 48;  // of one start of the browser
constexpr double kCssWidth = 800;     // larger files are sharper, with larger words
constexpr double kShortestFilm = 4, kLongestFilm = 25, kGoodFilm = 10;  // s, of a film

struct Size {
  int width, height;
};

std::string extension_of(const std::string& path) {
  return std::filesystem::path(path).extension();
}
bool is_film(const std::string& extension) { return extension == ".webm" || extension == ".gif"; }

std::optional<Size> size_of(const std::string& text) {
  Size out{};
  const char* const end = text.data() + text.size();
  const auto [x, first] = std::from_chars(text.data(), end, out.width);
  if (first != std::errc() || x == end || *x != 'x') return {};
  const auto [rest, second] = std::from_chars(x + 1, end, out.height);
  if (second != std::errc() || rest != end) return {};
  const auto possible = [](int n) { return n >= kLeastSize && n <= kMostSize; };
  return possible(out.width) && possible(out.height) ? std::optional(out) : std::nullopt;
}

Size size_for(const ReportOptions& options, const std::string& extension) {
  if (!options.size.empty()) return *size_of(options.size);
  return extension == ".gif" ? Size{640, 360} : Size{1280, 720};
}

std::string ffmpeg() { return find_program("FFMPEG", {"ffmpeg"}); }

// The bytes of a text in base64; none of its characters is checked: the browser wrote them.
std::string from_base64(std::string_view text) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<unsigned, 256> value{};
  for (unsigned i = 0; i < digits.size(); ++i) value[static_cast<unsigned char>(digits[i])] = i;
  std::string out;
  unsigned bits = 0, count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = (bits << 6) | value[static_cast<unsigned char>(c)];
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out += static_cast<char>((bits >> count) & 0xff);
  }
  return out;
}

// Frames as the files of PNG, in their order.
std::vector<std::string> frames_of(const Page& page, const PictureOptions& options) {
  constexpr std::string_view head = "data:image/png;base64,";
  const std::string text = drawn_frames(page.picture("motion", options));
  std::vector<std::string> out;
  for (size_t from = text.find(head); from != std::string::npos; from = text.find(head, from)) {
    from += head.size();
    const size_t end = std::min(text.find('\n', from), text.size());
    out.push_back(from_base64(std::string_view(text).substr(from, end - from)));
  }
  if (out.size() != options.at.size())
    throw Unfinished(fmt::format("{} drew {} of {} frames: it may lack WebGL", browser(),
                                 out.size(), options.at.size()));
  return out;
}

// Real time where the film then takes a pleasant time, else what makes it last ten seconds.
double speed_of(double duration) {
  return duration >= kShortestFilm && duration <= kLongestFilm ? 1 : duration / kGoodFilm;
}

void write_film(const Page& page, const std::vector<double>& times, PictureOptions picture,
                const ReportOptions& options, const std::string& path) {
  const bool gif = extension_of(path) == ".gif";
  const double rate = gif ? 20 : 25, start = times.front(), duration = times.back() - start,
               speed = options.speed.value_or(speed_of(duration));
  const double count = std::floor(duration / speed * rate * (1 + 1e-12)) + 1;
  if (!(count <= kMostFrames))
    throw ConfigError(
        {fmt::format("--speed: got {:.6g}: {:.6g} frames, expected at most {}: {:.6g} "
                     "or faster",
                     speed, count, kMostFrames, duration * rate / kMostFrames)});
  const Scratch folder;
  const auto frames = static_cast<size_t>(count);
  for (size_t i = 0; i < frames;) {
    picture.at.clear();
    for (size_t k = i; k < std::min(frames, i + kFramesAtOnce); ++k)
      picture.at.push_back(start + std::min(duration, static_cast<double>(k) * speed / rate));
    for (const std::string& png : frames_of(page, picture))
      write_file(folder.file(fmt::format("{:06}.png", i++)), png);
  }
  const std::string film = folder.file("film" + extension_of(path));
  std::vector<std::string> words = {
      ffmpeg(), "-nostdin", "-framerate", fmt::format("{}", rate), "-i", folder.file("%06d.png")};
  if (gif) {
    words.insert(words.end(), {"-filter_complex",
                               "split[a][b];[a]palettegen=stats_mode=diff[p];[b][p]paletteuse="
                               "dither=bayer:bayer_scale=4"});
  } else {
    words.insert(words.end(), {"-c:v", "libvpx-vp9", "-pix_fmt",
                               options.transparent ? "yuva420p" : "yuv420p", "-crf", "24", "-b:v",
                               "0", "-deadline", "good", "-cpu-used", "4", "-row-mt", "1"});
  }
  words.push_back(film);
  run_program(words, folder.file("out"), "put the film together", 60);
  write_file(path, contents_of(film));
}

void write_still(const Page& page, const std::vector<double>& times, PictureOptions picture,
                 const ReportOptions& options, const std::string& path) {
  const double start = times.front(), at = options.at.value_or(times.back());
  if (!(at >= start && at <= times.back()))
    throw ConfigError({fmt::format("--at: got {:.6g}, expected a time of the run, {:.6g} to {:.6g}",
                                   at, start, times.back())});
  picture.at = {at};
  const long count = options.strobe.value_or(1);
  for (long i = 0; i + 1 < count; ++i)
    picture.strobe.push_back(start + (at - start) * static_cast<double>(i) /
                                         static_cast<double>(count - 1));
  const std::string extension = extension_of(path);
  if (extension == ".png") {
    picture.frames = true;
    write_file(path, frames_of(page, picture).front());
    return;
  }
  const DrawnSvg drawn = drawn_svg(page.picture("motion", picture));
  if (drawn.svg.empty()) throw Unfinished(browser() + " did not draw the motion");
  write_file(path, extension == ".svg" ? drawn.svg + "\n" : converted(drawn, extension));
}

}  // namespace

std::vector<std::string> motion_mistakes(const ReportOptions& options, const std::string& path) {
  std::vector<std::string> mistakes =
      page_mistakes(path, {".webm", ".gif", ".png", ".svg", ".pdf", ".html"});
  const std::string extension = extension_of(path);
  const bool film = is_film(extension), page = extension == ".html";
  const auto only = [&](bool given, bool fits, const char* option, const char* formats) {
    if (given && !fits)
      mistakes.push_back(fmt::format("{}: of {}, not of '{}'", option, formats, path));
  };
  only(options.at.has_value(), !film && !page, "--at", ".png, .svg and .pdf");
  only(options.strobe.has_value(), !film && !page, "--strobe", ".png, .svg and .pdf");
  only(options.speed.has_value(), film, "--speed", ".webm and .gif");
  only(options.transparent, !page, "--transparent", "films and pictures");
  if (options.strobe && (*options.strobe < 2 || *options.strobe > kMostStrobe))
    mistakes.push_back(fmt::format("--strobe: got {}, expected a count from 2 to {}",
                                   *options.strobe, kMostStrobe));
  if (options.speed && !(*options.speed > 0 && std::isfinite(*options.speed)))
    mistakes.push_back(
        fmt::format("--speed: got {:.6g}, expected a number above 0", *options.speed));
  const std::optional<Size> size = size_of(options.size);
  if (!options.size.empty() && !size)
    mistakes.push_back(fmt::format("--size: got '{}', expected pixels as 1280x720, each {} to {}",
                                   options.size, kLeastSize, kMostSize));
  if (size && extension == ".webm" && (size->width % 2 != 0 || size->height % 2 != 0))
    mistakes.push_back(
        fmt::format("--size: got '{}', expected even numbers of pixels for .webm", options.size));
  if (options.files.size() > 1)
    mistakes.push_back(fmt::format("--motion: got {} runs, expected one", options.files.size()));
  const std::string without = "-o motion.html needs none, and plays the motion in any browser";
  if (!page) {
    if (const std::string lack = lack_of_browser("--motion", without); !lack.empty())
      mistakes.push_back(lack);
  }
  if (film && ffmpeg().empty())
    mistakes.push_back(fmt::format(
        "--motion: '{}' is put together by the program ffmpeg, which is not installed: apt-get "
        "install ffmpeg, or set FFMPEG to its path; -o motion.html needs none, pictures (.png, "
        ".svg, .pdf) no ffmpeg",
        path));
  return mistakes;
}

void write_motion(const Result& result, const ReportOptions& options, const std::string& path) {
  const std::vector<Figure> figures = figures::motion_of_run(registry(), result);
  const auto at = std::ranges::find(figures, "motion", &Figure::name);
  if (at == figures.end())
    throw ConfigError(
        {fmt::format("--motion: {} has no drawing, or the record no rows", result.system->name)});
  const std::vector<double>& times = std::get<figures::Animation>(at->drawing).times;
  Page page(fmt::format("{}: motion", result.system->name), "");
  page.section("Motion");
  page.add(*at);
  const std::string extension = extension_of(path);
  if (extension == ".html") {
    const bool fixed = !options.size.empty();
    const Size size = fixed ? *size_of(options.size) : Size{0, 0};
    write_file(path, page.picture("motion", {.width = static_cast<double>(size.width),
                                             .height = static_cast<double>(size.height),
                                             .player = true}));
    return;
  }
  const Size size = size_for(options, extension);
  PictureOptions picture{.transparent = options.transparent};
  picture.width = std::min<double>(size.width, kCssWidth);
  picture.sharper = size.width / picture.width;
  picture.height = size.height / picture.sharper;
  picture.frames = is_film(extension);
  if (picture.frames) write_film(page, times, picture, options, path);
  else write_still(page, times, picture, options, path);
}

}  // namespace hamel::tools
