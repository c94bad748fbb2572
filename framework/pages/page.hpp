// A report page: sections of blocks, written as the data of the bundled HTML page (tools/report).
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <hamel/framework/figures/figure.hpp>

namespace hamel::pages {

/// The bundled page with its placeholder; empty when hamel was built without node.
std::string_view report_page();

/// Mistakes of the file of a page or of a figure, before anything runs.
std::vector<std::string> page_mistakes(const std::string& path,
                                       const std::vector<std::string>& formats = {".html"});

using figures::Cell;
using figures::Figure;

class Page;

/// How one figure is drawn alone; all but the width are of a motion.
struct PictureOptions {
  double width = 0;                 // CSS pixels; 0, of a player: as wide as its window
  double height = 0;                // 0: that of the page
  double sharper = 0;               // pixels of the file per CSS pixel
  std::vector<double> at = {};      // times that are shown
  std::vector<double> strobe = {};  // times before them, at which bodies are shown too
  bool frames = false;              // a PNG for each time, else SVG
  bool transparent = false;
  bool player = false;  // the page itself: the motion with its buttons
};

/// The members of an ensemble: what a click on one of them shows.
struct Members {
  struct Column {
    std::string name, unit;
    bool varied = false;  // else kept
    std::vector<double> values;
    std::vector<std::string> names = {};  // of the values 0, 1, ...
  };
  std::vector<std::string> paragraphs;
  std::string command;           // of a member, {} in place of its index
  long count = 0;                // of all members
  std::vector<long> index = {};  // of those with values here; none: all
  std::vector<Column> columns;
  std::map<long, std::string> failures = {};  // reasons
  std::map<long, const Page*> motions = {};   // the blocks of its first section
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
  void add(const Figure& figure);
  /// Adds those of one section of a result, in their order.
  void add(const std::vector<Figure>& figures, const std::string& section);
  /// Adds them below a heading with its name; nothing where it has none.
  void add_section(const std::vector<Figure>& figures, const std::string& title);
  void members(const Members& members);
  /// Throws ConfigError when the page is not in this build or the file cannot be written.
  void write(const std::string& path) const;

  /// The names of its figures, each once.
  std::vector<std::string> figures() const;
  /// A page that holds this figure alone: its SVG, its frames, or its player.
  std::string picture(const std::string& figure, const PictureOptions& options) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace hamel::pages
