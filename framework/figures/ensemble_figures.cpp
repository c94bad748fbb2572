// The figures of an ensemble: what is kept over what is varied, distributions, statistics in time.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/figures/curves.hpp>
#include <hamel/framework/figures/ensemble_dots.hpp>
#include <hamel/framework/figures/figures.hpp>

namespace hamel::figures {
namespace {

using Law = Variation::Law;

constexpr size_t kMostBins = 60, kMostCells = 100;  // in each direction of a heat map

Axis axis_of(const EnsembleResult& result, const std::string& name) {
  return {.label = name, .unit = unit_of(result, name)};
}

// The columns that figures show: what is kept, and the class, as numbers.
struct Shown {
  Axis axis;  // its label is the name
  std::string note;
  std::vector<double> values;
};
std::vector<Shown> shown(const EnsembleResult& result) {
  std::vector<Shown> out;
  for (const std::string& name : result.kept)
    out.push_back({axis_of(result, name), "", numbers_of(result, name)});
  if (result.config.classes.names.empty()) return out;
  Shown& one = out.emplace_back(
      Shown{{.label = "class"}, result.table.column("class").meaning.substr(10), {}});
  for (const long long c : classes_of(result))
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
void add_heatmap(std::vector<Figure>& out, const EnsembleResult& result, const Shown& column,
                 const std::vector<const Variation*>& lists, const std::vector<bool>& failed) {
  const size_t all_rows = lists[0]->numbers.size(), all_columns = lists[1]->numbers.size();
  const size_t tall = (all_rows + kMostCells - 1) / kMostCells,
               wide = (all_columns + kMostCells - 1) / kMostCells;
  const size_t rows = (all_rows + tall - 1) / tall, columns = (all_columns + wide - 1) / wide;
  const bool classes = column.axis.label == "class";
  HeatMap map{.x = axis_of(result, lists[1]->name), .y = axis_of(result, lists[0]->name)};
  map.x_values = ticks(lists[1]->numbers, wide);
  map.y_values = ticks(lists[0]->numbers, tall);
  map.unit = column.axis.unit;
  std::string note = classes ? "" : column.note;
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
  const std::string of_cells =
      cell_note(classes, column.values.size() / (all_rows * all_columns), tall, wide);
  if (!of_cells.empty()) note += (note.empty() ? "" : ". ") + of_cells;
  if (!result.failures.empty()) map.marks = marks;
  out.push_back({.title = with_unit(column.axis.label, column.axis.unit),
                 .drawing = std::move(map),
                 .note = std::move(note),
                 .name = column.axis.label});
}

// Dots, a curve for each class, those without a value left out; the last are those that failed.
std::vector<Curve> coloured(const EnsembleResult& result, const std::vector<double>& x,
                            const std::vector<double>& y, const std::string& otherwise,
                            size_t stride) {
  std::vector<Curve> out;
  const std::vector<std::string>& names = result.config.classes.names;
  for (const std::string& name : names.empty() ? std::vector{otherwise} : names)
    out.push_back({.name = name});
  Curve failed{.name = "failed"};
  const std::vector<long long> classes = classes_of(result);
  const std::vector<bool> is_failed = failed_members(result);
  for (size_t k = 0; k < x.size(); k += stride) {
    if (std::isnan(y[k])) continue;
    if (!is_failed[k] && classes[k] < 0) continue;
    Curve& one = is_failed[k] ? failed : out[static_cast<size_t>(classes[k])];
    one.x.push_back(x[k]);
    one.y.push_back(y[k]);
    one.members.push_back(static_cast<long>(k));
  }
  if (!failed.x.empty()) out.push_back(std::move(failed));
  std::erase_if(out, [](const Curve& one) { return one.x.empty(); });
  for (Curve& one : out) one.dots = true;
  return out;
}

// Each stride-th member of a list as a point of a curve.
Curve curve_of(const std::string& name, const std::vector<double>& x, const std::vector<double>& y,
               size_t stride) {
  Curve out{.name = name};
  for (size_t k = 0; k < x.size(); k += stride) {
    out.x.push_back(x[k]);
    out.y.push_back(y[k]);
    out.members.push_back(static_cast<long>(k));
  }
  return out;
}

// Dots, one a member, coloured by its class, or, along one list, a curve.
void add_dots(std::vector<Figure>& out, const EnsembleResult& result, const Shown& column,
              const std::string& name, bool curve, bool alone) {
  const std::vector<double>& x = numbers_of(result, name);
  const size_t stride = stride_of_dots(result);
  const std::string& kept = column.axis.label;
  out.push_back(
      {.title = fmt::format("{} over {}", kept, name),
       .drawing = Plot{.x = axis_of(result, name),
                       .y = column.axis,
                       .curves = curve ? std::vector{curve_of(kept, x, column.values, stride)}
                                       : coloured(result, x, column.values, kept, stride)},
       .note = sampled(stride),
       .name = alone ? kept : ""});
}

// The members in the plane of two varied numbers, coloured by class and failure.
void add_classes(std::vector<Figure>& out, const EnsembleResult& result, const std::string& x,
                 const std::string& y) {
  const size_t stride = stride_of_dots(result);
  out.push_back({.title = fmt::format("Members over {} and {}", x, y),
                 .drawing = Plot{.x = axis_of(result, x),
                                 .y = axis_of(result, y),
                                 .curves = coloured(result, numbers_of(result, x),
                                                    numbers_of(result, y), "members", stride)},
                 .note = sampled(stride)});
}

void add_dependence(std::vector<Figure>& out, const EnsembleResult& result) {
  const std::vector<Shown> columns = shown(result);
  const std::vector<const Variation*> lists = lists_of(result.config);
  const std::vector<bool> failed = failed_members(result);
  constexpr size_t most = 3;
  if (result.config.grid && lists.size() == 2) {
    for (const Shown& column : columns) add_heatmap(out, result, column, lists, failed);
    return;
  }
  std::vector<std::string> names;
  for (const TableColumn& column : result.table.columns)
    if (column.meaning.starts_with("varied") && names.size() < most) names.push_back(column.name);
  const bool curve = names.size() == 1 && result.config.vary.size() == 1 && lists.size() == 1;
  const bool classes = !result.config.classes.names.empty();
  if (names.size() > 1 && (classes || !result.failures.empty()))
    add_classes(out, result, names[0], names[1]);
  for (const Shown& column : columns) {
    if (column.axis.label == "class" && names.size() > 1) continue;  // is the colour
    for (const std::string& name : names)
      add_dots(out, result, column, name, curve, names.size() == 1);
  }
}

// Stairs over the edges of the bins.
Curve stairs(const std::string& name, const Histogram& h) {
  Curve out{.name = name};
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
void add_histograms(std::vector<Figure>& out, const EnsembleResult& result) {
  const bool random = std::ranges::any_of(result.config.vary,
                                          [](const Variation& v) { return v.law != Law::values; });
  if (!random && result.histograms.empty()) return;
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
    out.push_back(
        {.title = "Members by " + name,
         .drawing = Plot{.x = axis_of(result, name), .y = {"members"}, .curves = {stairs(name, h)}},
         .note = std::move(note),
         .name = name});
  }
}

void add_times(std::vector<Figure>& out, const EnsembleResult& result) {
  if (result.statistics.size() < 2) return;
  for (size_t q = 0; q < result.statistics[0].quantities.size(); ++q) {
    const std::string& name = result.statistics[0].quantities[q].first;
    Curve mean{.name = "mean"}, band{.name = "one deviation"};
    for (const StatisticsAt& at : result.statistics) {
      const Moments& m = at.quantities[q].second;
      if (m.count < 2) continue;
      mean.x.push_back(at.time);
      mean.y.push_back(m.mean);
      band.x.push_back(at.time);
      band.y.push_back(m.mean + m.deviation());
      band.low.push_back(m.mean - m.deviation());
    }
    out.push_back(
        {.title = name, .drawing = Plot{.x = {"t", "s"}, .y = {name}, .curves = {band, mean}}});
  }
}

}  // namespace

std::vector<Figure> of_ensemble(const EnsembleResult& result) {
  std::vector<Figure> out;
  add_dependence(out, result);
  put_in_section("What is kept over what is varied", out);
  add_scatter_matrix(out, result);
  add_histograms(out, result);
  put_in_section("Distributions", out);
  add_times(out, result);
  put_in_section("Mean and deviation in time", out);
  name_apart(out);
  return out;
}

}  // namespace hamel::figures
