// A report page: sections of blocks, written as the data of the bundled HTML page (tools/report).
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace hamel::tools {

/// The bundled page with its placeholder; empty when the program was built without node.
std::string_view report_page();

struct Series {
  std::string name;
  std::vector<double> x, y;
  bool dashed = false;
};

/// Axis labels; logarithmic where it helps.
struct Axes {
  std::string x, y;
  bool log_x = false, log_y = false;
};

struct SphereCurve {
  std::string name;
  std::vector<std::vector<double>> points;  // of three entries
};

/// A table cell: a word, or a number that the page formats.
struct Cell {
  Cell(std::string word) : text(std::move(word)) {}
  Cell(const char* word) : text(word) {}
  Cell(double value) : number(value), is_number(true) {}
  std::string text;
  double number = 0;
  bool is_number = false;
};

class Page {
 public:
  Page(std::string title, std::string subtitle);
  ~Page();
  Page(Page&&) noexcept;

  void section(const std::string& title);
  void text(const std::vector<std::string>& paragraphs);
  /// status: ok, failed or note.
  void verdict(const std::string& status, const std::string& text);
  void table(const std::string& title, const std::vector<std::string>& columns,
             const std::vector<std::vector<Cell>>& rows, const std::string& note = "");
  /// The JSON record of a run.
  void record(const std::string& json);
  void plot(const std::string& title, const Axes& axes, const std::vector<Series>& series,
            const std::string& note = "");
  void path(const std::string& title, const Axes& axes, const std::vector<Series>& series);
  void sphere(const std::string& title, const std::vector<SphereCurve>& curves,
              const std::string& note = "");
  /// Throws ConfigError when the page is not in this program or the file cannot be written.
  void write(const std::string& path) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// At most about `points` points: of each bucket those with the smallest and the largest y, or only
/// the largest (peaks, for errors on a logarithmic axis). NaN is never dropped.
Series thinned(std::string name, const std::vector<double>& x, const std::vector<double>& y,
               bool peaks, size_t points = 1200);

/// |y|, for a logarithmic axis.
std::vector<double> magnitudes(std::vector<double> y);

}  // namespace hamel::tools
