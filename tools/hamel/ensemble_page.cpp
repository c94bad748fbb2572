#include "ensemble_page.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "ensemble_members.hpp"

namespace hamel::tools {
namespace {

using Law = Variation::Law;

constexpr size_t kMostBins = 60, kMostCells = 100;  // in each direction of a heat map

std::string labelled(const EnsembleResult& result, const std::string& name) {
  const std::string& unit = result.table.column(name).unit;
  return with_unit(name, unit == "1" ? "" : unit);
}

// The columns that figures show: what is kept, and the class, as numbers.
struct Shown {
  std::string name, label, unit, note;
  std::vector<double> values;
};
std::vector<Shown> shown(const EnsembleResult& result) {
  std::vector<Shown> out;
  for (const std::string& name : result.kept)
    out.push_back({name, labelled(result, name), result.table.column(name).unit, "",
                   numbers_of(result, name)});
  if (result.config.classes.names.empty()) return out;
  const TableColumn& column = result.table.column("class");
  Shown& one = out.emplace_back(Shown{"class", "class", "", column.meaning.substr(10), {}});
  for (const long long c : std::get<std::vector<long long>>(column.values))
    one.values.push_back(c < 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(c));
  return out;
}

std::vector<const Variation*> lists_of(const EnsembleConfig& config) {
  std::vector<const Variation*> out;
  for (const Variation& v : config.vary)
    if (v.law == Law::values) out.push_back(&v);
  return out;
}

// Places of the cells along a list, so many of its values a cell: between the first and the last.
std::vector<Cell> ticks(const std::vector<double>& list, size_t together) {
  std::vector<Cell> out;
  for (size_t i = 0; i < list.size(); i += together)
    out.emplace_back((list[i] + list[std::min(i + together, list.size()) - 1]) / 2);
  return out;
}

// Note on cells of several members: so many of each combination, tall x wide combinations.
std::string cell_note(bool classes, size_t members, size_t tall, size_t wide) {
  if (members * tall * wide <= 1) return "";
  std::string out = fmt::format("A cell shows the {} of its {} members, a click the first of them.",
                                classes ? "most frequent class" : "mean", members * tall * wide);
  if (tall > 1 || wide > 1) out += fmt::format(" {} x {} combinations are one cell.", tall, wide);
  return out;
}

// A cell for each combination of two lists, or for some that are neighbours: the mean over its
// members that have a value, or their most frequent class.
void add_heatmap(Page& page, const EnsembleResult& result, const Shown& column,
                 const std::vector<const Variation*>& lists, const std::vector<bool>& failed) {
  const size_t all_rows = lists[0]->numbers.size(), all_columns = lists[1]->numbers.size();
  const size_t tall = (all_rows + kMostCells - 1) / kMostCells,
               wide = (all_columns + kMostCells - 1) / kMostCells;
  const size_t rows = (all_rows + tall - 1) / tall, columns = (all_columns + wide - 1) / wide;
  const bool classes = column.name == "class";
  HeatMap map;
  map.title = column.label;
  map.x = labelled(result, lists[1]->name);
  map.y = labelled(result, lists[0]->name);
  map.x_values = ticks(lists[1]->numbers, wide);
  map.y_values = ticks(lists[0]->numbers, tall);
  map.unit = column.unit == "1" ? "" : column.unit;
  if (!classes) map.note = column.note;
  if (classes) map.classes = result.config.classes.names;
  map.values.assign(rows, std::vector<double>(columns));
  map.members.assign(rows, std::vector<long>(columns, -1));
  const size_t kinds = std::max<size_t>(map.classes.size(), 1);
  std::vector<std::vector<std::vector<int>>> counts(
      rows, std::vector<std::vector<int>>(columns, std::vector<int>(kinds)));
  std::vector<std::vector<std::string>> marks(rows, std::vector<std::string>(columns));
  for (size_t k = 0; k < column.values.size(); ++k) {
    const size_t i = k / all_columns % all_rows / tall, j = k % all_columns / wide;
    if (failed[k]) marks[i][j] = "failed";
    if (map.members[i][j] < 0) map.members[i][j] = static_cast<long>(k);
    if (std::isnan(column.values[k])) continue;
    map.values[i][j] += column.values[k];
    ++counts[i][j][classes ? static_cast<size_t>(column.values[k]) : 0];
  }
  for (size_t i = 0; i < rows; ++i)
    for (size_t j = 0; j < columns; ++j) {
      const std::vector<int>& of = counts[i][j];
      const auto most = std::ranges::max_element(of);
      if (classes && *most > 0) map.values[i][j] = static_cast<double>(most - of.begin());
      else map.values[i][j] /= of[0];  // NaN of none
    }
  const std::string note =
      cell_note(classes, column.values.size() / (all_rows * all_columns), tall, wide);
  if (!note.empty()) map.note += (map.note.empty() ? "" : ". ") + note;
  if (!result.failures.empty()) map.marks = marks;
  page.heatmap(map);
}

// The member's colour, by number: its class, or -1 where it has none.
std::vector<long long> classes_of(const EnsembleResult& result) {
  if (result.config.classes.names.empty())
    return std::vector<long long>(static_cast<size_t>(result.members), 0);
  return std::get<std::vector<long long>>(result.table.column("class").values);
}

// Dots of a series for each class, those without a value left out; the last are those that failed.
std::vector<Series> coloured(const EnsembleResult& result, const std::vector<double>& x,
                             const std::vector<double>& y, const std::string& otherwise,
                             size_t stride) {
  std::vector<Series> out;
  const std::vector<std::string>& names = result.config.classes.names;
  for (const std::string& name : names.empty() ? std::vector{otherwise} : names)
    out.push_back({name, {}, {}});
  Series failed{"failed", {}, {}};
  const std::vector<long long> classes = classes_of(result);
  const std::vector<bool> is_failed = failed_members(result);
  for (size_t k = 0; k < x.size(); k += stride) {
    if (std::isnan(y[k])) continue;
    if (!is_failed[k] && classes[k] < 0) continue;
    Series& one = is_failed[k] ? failed : out[static_cast<size_t>(classes[k])];
    one.x.push_back(x[k]);
    one.y.push_back(y[k]);
    one.members.push_back(static_cast<long>(k));
  }
  if (!failed.x.empty()) out.push_back(std::move(failed));
  std::erase_if(out, [](const Series& one) { return one.x.empty(); });
  for (Series& one : out) one.dots = true;
  return out;
}

// Each stride-th member of a list as a point of a curve.
Series curve_of(const std::string& name, const std::vector<double>& x, const std::vector<double>& y,
                size_t stride) {
  Series out{name, {}, {}};
  for (size_t k = 0; k < x.size(); k += stride) {
    out.x.push_back(x[k]);
    out.y.push_back(y[k]);
    out.members.push_back(static_cast<long>(k));
  }
  return out;
}

// Dots, one a member, coloured by its class, or, along one list, a curve.
void add_dots(Page& page, const EnsembleResult& result, const Shown& column,
              const std::string& name, bool curve) {
  const std::vector<double>& x = numbers_of(result, name);
  const size_t stride = stride_of_dots(result);
  page.plot(fmt::format("{} over {}", column.name, name),
            {.x = labelled(result, name), .y = column.label},
            curve ? std::vector{curve_of(column.name, x, column.values, stride)}
                  : coloured(result, x, column.values, column.name, stride),
            sampled(stride));
}

// The members in the plane of two varied numbers, coloured by class and failure.
void add_classes(Page& page, const EnsembleResult& result, const std::string& x,
                 const std::string& y) {
  const size_t stride = stride_of_dots(result);
  page.plot(fmt::format("Members over {} and {}", x, y),
            {.x = labelled(result, x), .y = labelled(result, y)},
            coloured(result, numbers_of(result, x), numbers_of(result, y), "members", stride),
            sampled(stride));
}

void add_dependence(Page& page, const EnsembleResult& result) {
  const std::vector<Shown> columns = shown(result);
  const std::vector<const Variation*> lists = lists_of(result.config);
  const std::vector<bool> failed = failed_members(result);
  constexpr size_t most = 3;
  page.section("What is kept over what is varied");
  if (result.config.grid && lists.size() == 2) {
    for (const Shown& column : columns) add_heatmap(page, result, column, lists, failed);
    return;
  }
  std::vector<std::string> names;
  for (const TableColumn& column : result.table.columns)
    if (column.meaning.starts_with("varied") && names.size() < most) names.push_back(column.name);
  const bool curve = names.size() == 1 && result.config.vary.size() == 1 && lists.size() == 1;
  const bool classes = !result.config.classes.names.empty();
  if (names.size() > 1 && (classes || !result.failures.empty()))
    add_classes(page, result, names[0], names[1]);
  for (const Shown& column : columns) {
    if (column.name == "class" && names.size() > 1) continue;  // is the colour
    for (const std::string& name : names) add_dots(page, result, column, name, curve);
  }
}

// Stairs over the edges of the bins.
Series stairs(const std::string& name, const Histogram& h) {
  Series out{name, {}, {}};
  const double width = (h.until - h.from) / static_cast<double>(h.counts.size());
  for (size_t i = 0; i < h.counts.size(); ++i) {
    const double left = h.from + width * static_cast<double>(i);
    for (const double x : {left, left + width}) {
      out.x.push_back(x);
      out.y.push_back(static_cast<double>(h.counts[i]));
      out.low.push_back(0);
    }
  }
  return out;
}

// Histograms of the configuration; of random draws one of each quantity.
void add_histograms(Page& page, const EnsembleResult& result) {
  const bool random = std::ranges::any_of(result.config.vary,
                                          [](const Variation& v) { return v.law != Law::values; });
  if (!random && result.histograms.empty()) return;
  page.section("Distributions");
  for (const std::string& name : result.kept) {
    const Moments& m = result.moments.at(name);
    const auto asked = result.histograms.find(name);
    if (asked == result.histograms.end() && (!random || m.count < 2 || !(m.least < m.most)))
      continue;
    Histogram h;
    if (asked != result.histograms.end()) {
      h = asked->second;
    } else {
      const auto bins = std::min(
          kMostBins, static_cast<size_t>(std::ceil(std::sqrt(static_cast<double>(m.count)))));
      h = {m.least, m.most, std::vector<long>(bins), 0, 0};
      for (const double x : numbers_of(result, name)) {
        if (std::isnan(x)) continue;
        const double place = (x - h.from) / (h.until - h.from) * static_cast<double>(bins);
        ++h.counts[std::min(static_cast<size_t>(place), bins - 1)];
      }
    }
    std::string note;
    if (h.below + h.above > 0) note = fmt::format("{} members below, {} above.", h.below, h.above);
    page.plot("Members by " + name, {.x = labelled(result, name), .y = "members"},
              {stairs(name, h)}, note);
  }
}

void add_times(Page& page, const EnsembleResult& result) {
  if (result.statistics.size() < 2) return;
  page.section("Mean and deviation in time");
  for (size_t q = 0; q < result.statistics[0].quantities.size(); ++q) {
    const std::string& name = result.statistics[0].quantities[q].first;
    Series mean{"mean", {}, {}}, band{"one deviation", {}, {}};
    for (const StatisticsAt& at : result.statistics) {
      const Moments& m = at.quantities[q].second;
      if (m.count < 2) continue;
      mean.x.push_back(at.time);
      mean.y.push_back(m.mean);
      band.x.push_back(at.time);
      band.y.push_back(m.mean + m.deviation());
      band.low.push_back(m.mean - m.deviation());
    }
    page.plot(name, {.x = "t [s]", .y = name}, {band, mean});
  }
}

void add_kept(Page& page, const EnsembleResult& result) {
  std::vector<std::string> columns = {"kept", "members", "mean", "deviation", "least", "most"};
  for (const double part : result.config.quantiles)
    columns.push_back(fmt::format("{:g} %", 100 * part));
  std::vector<std::vector<Cell>> rows;
  for (const std::string& name : result.kept) {
    const Moments& m = result.moments.at(name);
    std::vector<Cell>& row = rows.emplace_back(
        std::vector<Cell>{Cell(labelled(result, name)), Cell(static_cast<double>(m.count)),
                          Cell(m.mean), Cell(m.deviation()), Cell(m.least), Cell(m.most)});
    if (m.count == 0) row.resize(2, Cell(""));
    row.resize(6, Cell(std::numeric_limits<double>::quiet_NaN()));
    if (const auto it = result.quantiles.find(name); it != result.quantiles.end())
      for (const double x : it->second) row.emplace_back(x);
  }
  page.table("Over the members", columns, rows);
  if (result.class_counts.empty()) return;
  rows.clear();
  for (size_t i = 0; i < result.class_counts.size(); ++i)
    rows.push_back(
        {Cell(result.config.classes.names[i]), Cell(static_cast<double>(result.class_counts[i])),
         Cell(static_cast<double>(result.class_counts[i]) / static_cast<double>(result.members))});
  page.table("Classes", {"class", "members", "share"}, rows);
}

}  // namespace

Page ensemble_page(const EnsembleResult& result, const std::map<long, Page>& motions) {
  const std::string file = result.config.origin;
  Page page(result.config.run.system, fmt::format("{} members of {}", result.members, file));
  page.section("Members");
  page.verdict(
      result.failures.empty() ? "ok" : "note",
      fmt::format("{} of {} members have values.",
                  result.members - static_cast<long>(result.failures.size()), result.members));
  add_members(page, result, motions);
  add_kept(page, result);
  if (!result.failures.empty()) {
    constexpr size_t most = 100;
    std::vector<std::vector<Cell>> rows;
    for (size_t i = 0; i < std::min(most, result.failures.size()); ++i)
      rows.push_back({Cell(static_cast<double>(result.failures[i].member)),
                      Cell(result.failures[i].time), Cell(result.failures[i].reason)});
    page.table("Failed members", {"member", "time [s]", "reason"}, rows,
               result.failures.size() > most ? "The first 100." : "");
  }
  add_dependence(page, result);
  add_scatter_matrix(page, result);
  add_histograms(page, result);
  add_times(page, result);
  return page;
}

}  // namespace hamel::tools
