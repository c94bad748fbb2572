// File of a single figure of a page: PDF, SVG or PNG.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/pages/page.hpp>

namespace hamel::tools {

using pages::Page;

/// "8cm", also mm, in, pt, px -> pixels of the page, 96 to the inch; NaN where it is no width.
double width_in_pixels(const std::string& text);

/// An SVG and its size, in pixels.
struct DrawnSvg {
  std::string svg;
  double width = 0, height = 0;
};

/// The SVG of a page that holds one picture (Page::picture), as it is; empty where it has none.
DrawnSvg drawn_svg(const std::string& page);

/// A page that holds one picture as its frames: lines, data URLs of PNG.
std::string drawn_frames(const std::string& page);

/// The SVG as .pdf or .png, made by the browser.
std::string converted(const DrawnSvg& figure, const std::string& extension);

/// Mistake of a file that is drawn by a browser where there is none; empty else.
std::string lack_of_browser(const std::string& option, const std::string& without);

/// Mistakes of the file of a figure, before anything is read.
std::vector<std::string> figure_mistakes(const std::string& path, const std::string& width);

/// Draws the figure of that name, so wide, and writes it in the format of the path's extension.
/// ConfigError for a name that the page does not have.
void write_figure(const Page& page, const std::string& figure, const std::string& path,
                  const std::string& width);

}  // namespace hamel::tools
