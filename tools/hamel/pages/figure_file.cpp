#include "pages/figure_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/pages/page.hpp>

#include "pages/browser.hpp"

namespace hamel::tools {

using pages::page_mistakes;
namespace {

constexpr double kInch = 96;              // pixels of a style sheet
constexpr double kDotsPerInch = 300;      // of a PNG
constexpr double kLeast = 3, kMost = 60;  // cm

// The text between two others; "" where these are missing.
std::string between(const std::string& text, const std::string& before, const std::string& after) {
  const size_t from = text.find(before);
  if (from == std::string::npos) return "";
  const size_t begin = from + before.size(), end = text.find(after, begin);
  return end == std::string::npos ? "" : text.substr(begin, end - begin);
}

std::string percent_decoded(const std::string& text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    int byte = 0;
    const char* digits = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      out += static_cast<char>(byte);
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

// The text of the element `picture` that the page leaves.
std::string left_by(const std::string& page, const std::vector<std::string>& options) {
  const Scratch folder;
  write_file(folder.file("page.html"), page);
  return between(browse(folder, options), "<pre id=\"picture\">", "</pre>");
}

// Sizes of its element in place of pixels.
void in_centimetres(DrawnSvg& drawn) {
  const size_t head = drawn.svg.find('>');
  const std::string tag = drawn.svg.substr(0, head);
  std::string sized = tag;
  for (const auto& [name, size] : {std::pair("width", drawn.width), {"height", drawn.height}}) {
    const std::string word =
        fmt::format(" {}=\"{}\"", name, between(tag, fmt::format(" {}=\"", name), "\""));
    sized.replace(sized.find(word), word.size(),
                  fmt::format(" {}=\"{:.6g}cm\"", name, size / kInch * 2.54));
  }
  drawn.svg = sized + drawn.svg.substr(head);
}

}  // namespace

DrawnSvg drawn_svg(const std::string& page) {
  DrawnSvg out{percent_decoded(left_by(page, {"--dump-dom"}))};
  const std::string tag = out.svg.substr(0, out.svg.find('>'));
  const auto pixels = [&](const std::string& name) {
    const std::string text = between(tag, " " + name + "=\"", "\"");
    double value = std::numeric_limits<double>::quiet_NaN();
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
  };
  out.width = pixels("width");
  out.height = pixels("height");
  return tag.starts_with("<svg") && out.width > 0 && out.height > 0 ? out : DrawnSvg{};
}

std::string drawn_frames(const std::string& page) {
  return left_by(page, {"--dump-dom", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"});
}

std::string lack_of_browser(const std::string& option, const std::string& without) {
  if (!browser().empty()) return "";
  return fmt::format(
      "{} is drawn by the program chromium, which is not installed: apt-get install chromium, or "
      "set CHROMIUM to the path of Chromium or Chrome; {}",
      option, without);
}

std::string converted(const DrawnSvg& figure, const std::string& extension) {
  const Scratch folder;
  const std::string file = folder.file("figure" + extension);
  write_file(folder.file("page.html"),
             fmt::format("<!doctype html><meta charset=\"utf-8\"><style>@page {{ size: {}px {}px; "
                         "margin: 0 }} body {{ margin: 0 }} svg {{ display: block }}</style>{}",
                         figure.width, figure.height, figure.svg));
  if (extension == ".pdf") {
    browse(folder, {"--no-pdf-header-footer", "--print-to-pdf=" + file});
  } else {
    browse(folder,
           {"--screenshot=" + file,
            fmt::format("--force-device-scale-factor={}", kDotsPerInch / kInch),
            fmt::format("--window-size={},{}", std::ceil(figure.width), std::ceil(figure.height))});
  }
  std::string out = contents_of(file);
  if (out.empty()) throw Unfinished(fmt::format("{} wrote no {}", browser(), extension));
  return out;
}

double width_in_pixels(const std::string& text) {
  constexpr std::array<std::pair<std::string_view, double>, 5> units = {
      {{"cm", kInch / 2.54}, {"mm", kInch / 25.4}, {"in", kInch}, {"pt", kInch / 72}, {"px", 1}}};
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view unit(end, static_cast<size_t>(text.data() + text.size() - end));
  for (const auto& [name, pixels] : units) {
    const double width = value * pixels;
    const bool possible = width >= kLeast / 2.54 * kInch && width <= kMost / 2.54 * kInch;
    if (error == std::errc() && unit == name && possible) return width;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::string> figure_mistakes(const std::string& path, const std::string& width) {
  std::vector<std::string> mistakes = page_mistakes(path, {".pdf", ".svg", ".png"});
  if (std::isnan(width_in_pixels(width)))
    mistakes.push_back(fmt::format(
        "--width: got '{}', expected a number with its unit from {}cm to {}cm, as 8cm, 80mm, "
        "3in, 230pt or 300px",
        width, kLeast, kMost));
  const std::string lack = lack_of_browser(
      "--figure", "the page (-o page.html) needs none, and its buttons save each figure");
  if (!lack.empty()) mistakes.push_back(lack);
  return mistakes;
}

void write_figure(const Page& page, const std::string& figure, const std::string& path,
                  const std::string& width) {
  const std::vector<std::string> known = page.figures();
  if (std::find(known.begin(), known.end(), figure) == known.end())
    throw ConfigError({unknown_name("figure", figure, known)});
  DrawnSvg drawn = drawn_svg(page.picture(figure, {.width = width_in_pixels(width)}));
  if (drawn.svg.empty())
    throw ConfigError({fmt::format("report: the figure '{}' has nothing to draw", figure)});
  in_centimetres(drawn);
  const std::string extension = std::filesystem::path(path).extension();
  write_file(path, extension == ".svg" ? drawn.svg + "\n" : converted(drawn, extension));
}

}  // namespace hamel::tools
