// File of a single figure of a page: PDF, SVG or PNG.
#pragma once

#include <string>
#include <vector>

#include "pages/page.hpp"

namespace hamel::tools {

/// "8cm", also mm, in, pt, px -> pixels of the page, 96 to the inch; NaN where it is no width.
double width_in_pixels(const std::string& text);

/// Mistakes of the file of a figure, before anything is read.
std::vector<std::string> figure_mistakes(const std::string& path, const std::string& width);

/// Draws the figure of that name, so wide, and writes it in the format of the path's extension.
/// ConfigError for a name that the page does not have.
void write_figure(const Page& page, const std::string& figure, const std::string& path,
                  const std::string& width);

}  // namespace hamel::tools
