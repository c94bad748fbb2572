// A report page: sections of blocks, written as the data of the bundled HTML page (tools/report).
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "page_figures.hpp"

namespace hamel::tools {

/// The bundled page with its placeholder; empty when the program was built without node.
std::string_view report_page();

/// A fitted line, named in the legend: the text, or the slope where there is none.
struct Fit {
  double slope = 0;
  std::string text = "";
};

struct Series {
  std::string name;
  std::vector<double> x, y;
  bool dashed = false;
  bool markers = false;  // in a plot up to 48 points have them anyway
  bool dots = false;     // markers alone: the points are in no order that a line may follow
  std::optional<Fit> fit = {};
  std::map<std::string, std::string> tags = {};  // what the plot's filters choose by
  std::string key = "";  // series with one key have one colour on the whole page; empty: the name
  std::vector<double> low = {};    // none, or the lower edge of a band of which y is the upper one
  bool envelope = false;           // the band is that of a curve with too many turns to be drawn
  std::vector<long> members = {};  // none, or of the points: a click shows the member
};

/// A moment on the x axis, drawn as a line with this text.
struct Mark {
  double x = 0;
  std::string text;
};

/// A part of the x axis, shaded, with this text.
struct Band {
  double from = 0, to = 0;
  std::string text;
};

/// A selector over a plot: only series whose tag `name` has the chosen value (the first, at the
/// start) are shown; a series without that tag always is.
struct Filter {
  std::string name;
  std::vector<std::string> values;
};

/// Axis labels, logarithmic where it helps, and what is drawn beside the curves.
struct Axes {
  std::string x, y;
  bool log_x = false, log_y = false;
  std::string name = "";  // of the figure, for --figure; empty: its title
  double floor = 0;       // round-off: a line there, and a fixed axis while the curves stay near it
  std::vector<int> slopes = {};  // triangles of these slopes, on two logarithmic axes
  std::vector<Mark> marks = {};  // events
  std::vector<Band> bands = {};
};

/// The longest table of a page: a browser is slow on more, and a row takes up to 4 kB.
constexpr size_t kMostRows = 2000;

class Page {
 public:
  Page(std::string title, std::string subtitle);
  ~Page();
  Page(Page&&) noexcept;

  void section(const std::string& title);
  void text(const std::vector<std::string>& paragraphs);
  /// status: ok, failed or note.
  void verdict(const std::string& status, const std::string& text);
  /// The first kMostRows rows; the note counts the others. filter: a text box over the table, and a
  /// drop-down for columns of 2 to 12 different values.
  void table(const std::string& title, const std::vector<std::string>& columns,
             const std::vector<std::vector<Cell>>& rows, const std::string& note = "",
             bool filter = false);
  /// The JSON record of a run.
  void record(const std::string& json);
  void plot(const std::string& title, const Axes& axes, const std::vector<Series>& series,
            const std::string& note = "", const std::vector<Filter>& filters = {});
  void path(const std::string& title, const Axes& axes, const std::vector<Series>& series);
  void sphere(const std::string& title, const std::vector<SphereCurve>& curves,
              const std::string& note = "");
  void heatmap(const HeatMap& map);
  void scatter(const ScatterMatrix& matrix);
  void members(const Members& members);
  void animation(const Animation& animation);
  /// Throws ConfigError when the page is not in this program or the file cannot be written.
  void write(const std::string& path) const;

  /// The names of its figures, each once.
  std::vector<std::string> figures() const;
  /// A page that holds the SVG of this figure alone, so many pixels wide.
  std::string picture(const std::string& figure, double width) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// At most about `points` points: of each of equal windows those with the smallest and the largest
/// y, or only the largest (peaks, for errors on a logarithmic axis), the last window like the
/// others; else with both ends. NaN is never dropped.
Series thinned(std::string name, const std::vector<double>& x, const std::vector<double>& y,
               bool peaks, size_t points = 1200);

/// Thins values of either sign; of a curve that goes up and down more often than a figure can
/// show, a band from the least to the greatest value of each of equal windows.
Series drawable(std::string name, const std::vector<double>& x, const std::vector<double>& y);

/// From the least to the greatest value of all curves.
double range_of(std::span<const Series> series);

/// "omega [rad/s]"; the name alone where nothing is known of its unit.
std::string with_unit(const std::string& name, const std::string& unit);

/// |y|, for a logarithmic axis.
std::vector<double> magnitudes(std::vector<double> y);

}  // namespace hamel::tools
