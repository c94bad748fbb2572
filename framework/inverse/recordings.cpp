#include <hamel/framework/inverse/recordings.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/text_file.hpp>

namespace hamel {
namespace {

std::vector<std::string> cells_of_line(const std::string& line) {
  std::vector<std::string> out;
  std::string cell;
  bool quoted = false;
  const auto close = [&] {
    while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\r')) cell.pop_back();
    cell.erase(0, std::min(cell.find_first_not_of(' '), cell.size()));
    out.push_back(std::exchange(cell, ""));
  };
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    else if (c == ',' && !quoted) close();
    else cell += c;
  }
  close();
  return out;
}

class RecordingReader {
 public:
  explicit RecordingReader(const std::string& name) { out_.name = name; }
  Recording read(const std::string& text) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
      ++number_;
      if (line.empty() || line == "\r" || line.front() == '#') continue;
      const std::vector<std::string> cells = cells_of_line(line);
      if (head_.empty()) head(cells);
      else row(cells);
    }
    if (head_.empty()) refuse("expected a header with t and names of quantities");
    if (out_.t.empty()) refuse("there is no row");
    return std::move(out_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw ConfigError({fmt::format("{}:{}: {}", out_.name, number_, what)});
  }
  void head(const std::vector<std::string>& cells) {
    head_ = cells;
    const auto t = std::ranges::find(head_, "t");
    if (t == head_.end()) refuse("expected a column t, the time in s");
    time_ = static_cast<size_t>(t - head_.begin());
    for (size_t i = 0; i < head_.size(); ++i) {
      if (head_[i].empty()) refuse(fmt::format("column {}: expected a name", i + 1));
      if (std::ranges::count(head_, head_[i]) > 1)
        refuse(fmt::format("column {}: {} is there twice", i + 1, head_[i]));
      if (i != time_) out_.columns.push_back(head_[i]);
    }
    out_.values.resize(out_.columns.size());
  }
  double number(size_t i, const std::string& cell) const {
    if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
    double out = 0;
    const char* const last = cell.data() + cell.size();
    const auto [end, error] = std::from_chars(cell.data(), last, out);
    if (error != std::errc() || end != last || !std::isfinite(out))
      refuse(fmt::format("column {} ({}): got '{}', expected a finite number or an empty cell",
                         i + 1, head_[i], shortened(cell)));
    return out;
  }
  void row(const std::vector<std::string>& cells) {
    if (cells.size() != head_.size())
      refuse(fmt::format("got {} cells, expected {}", cells.size(), head_.size()));
    size_t column = 0;
    for (size_t i = 0; i < cells.size(); ++i) {
      const double value = number(i, cells[i]);
      if (i != time_) {
        out_.values[column++].push_back(value);
        continue;
      }
      if (std::isnan(value)) refuse(fmt::format("column {} (t): expected a time", i + 1));
      if (!out_.t.empty() && !(value > out_.t.back()))
        refuse(fmt::format("column {} (t): got {}, expected more than {} of the row before", i + 1,
                           value, out_.t.back()));
      out_.t.push_back(value);
    }
    out_.lines.push_back(number_);
  }

  Recording out_;
  std::vector<std::string> head_;
  size_t time_ = 0;
  long number_ = 0;
};

}  // namespace

Recording parse_recording(const std::string& text, const std::string& name) {
  return RecordingReader(name).read(text);
}

Recording read_recording(const std::string& path) {
  return parse_recording(read_text_file("recording", path), path);
}

}  // namespace hamel
