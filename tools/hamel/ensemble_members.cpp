#include "ensemble_members.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace hamel::tools {
namespace {

constexpr size_t kMostDots = 4000;      // of a figure, of evenly chosen members
constexpr size_t kMostValues = 10'000;  // members with their values on the page
constexpr size_t kMostColumns = 6;      // of a scatter matrix
constexpr size_t kMostMotions = 6;      // on a page, where the file names members
constexpr size_t kMostClasses = 4;      // of which one member moves, where it names none

using Numbers = std::vector<double>;
using Indices = std::vector<long long>;

std::string unit_of(const TableColumn& column) { return column.unit == "1" ? "" : column.unit; }

Numbers chosen(const Numbers& all, const std::vector<long>& index) {
  Numbers out;
  for (const long k : index) out.push_back(all[static_cast<size_t>(k)]);
  return out;
}

std::vector<long> every(size_t count, size_t stride) {
  std::vector<long> out;
  for (size_t k = 0; k < count; k += stride) out.push_back(static_cast<long>(k));
  return out;
}

// The word as a shell reads it.
std::string quoted(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("_./+-,:@%").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::ranges::all_of(word, plain)) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

// Pearson's coefficient over the members that have both values; NaN where one of them is constant.
double correlation(const Numbers& x, const Numbers& y) {
  double count = 0, mean_x = 0, mean_y = 0;
  const auto each = [&](const auto& visit) {
    for (size_t k = 0; k < x.size(); ++k)
      if (!std::isnan(x[k]) && !std::isnan(y[k])) visit(x[k], y[k]);
  };
  each([&](double a, double b) { ++count, mean_x += a, mean_y += b; });
  mean_x /= count;
  mean_y /= count;
  double xx = 0, yy = 0, xy = 0;
  each([&](double a, double b) {
    xx += (a - mean_x) * (a - mean_x);
    yy += (b - mean_y) * (b - mean_y);
    xy += (a - mean_x) * (b - mean_y);
  });
  return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : std::numeric_limits<double>::quiet_NaN();
}

// 21 -> "21st".
std::string ordinal(size_t n) {
  const char* end = n % 100 / 10 == 1 ? "th"
                    : n % 10 == 1     ? "st"
                    : n % 10 == 2     ? "nd"
                    : n % 10 == 3     ? "rd"
                                      : "th";
  return fmt::format("{}{}", n, end);
}

}  // namespace

const std::vector<double>& numbers_of(const EnsembleResult& result, const std::string& name) {
  return std::get<Numbers>(result.table.column(name).values);
}

std::vector<bool> failed_members(const EnsembleResult& result) {
  std::vector<bool> out(static_cast<size_t>(result.members));
  for (const MemberFailure& failure : result.failures)
    out[static_cast<size_t>(failure.member)] = true;
  return out;
}

size_t stride_of_dots(const EnsembleResult& result) {
  size_t out = (static_cast<size_t>(result.members) + kMostDots - 1) / kMostDots;
  const auto meets = [&](const Variation& v) {
    return v.law == Variation::Law::values && std::gcd(out, v.numbers.size()) > 1;
  };
  while (out > 1 && result.config.grid && std::ranges::any_of(result.config.vary, meets)) ++out;
  return out;
}

std::string sampled(size_t stride) {
  return stride > 1 ? fmt::format("Each {} member.", ordinal(stride)) : "";
}

std::vector<long> members_in_motion(const EnsembleResult& result) {
  std::vector<long> out = result.config.trajectories;
  if (!result.config.feedback.inputs.empty()) return {};
  if (!out.empty()) {
    out.resize(std::min(out.size(), kMostMotions));
    return out;
  }
  const std::vector<bool> failed = failed_members(result);
  const size_t classes = std::min(result.config.classes.names.size(), kMostClasses);
  const Indices* class_of =
      classes > 0 ? &std::get<Indices>(result.table.column("class").values) : nullptr;
  for (size_t c = 0; c < std::max<size_t>(classes, 1); ++c)
    for (size_t k = 0; k < failed.size(); ++k) {
      if (failed[k] || (class_of != nullptr && (*class_of)[k] != static_cast<long long>(c)))
        continue;
      out.push_back(static_cast<long>(k));
      break;
    }
  return out;
}

void add_members(Page& page, const EnsembleResult& result, const std::map<long, Page>& motions) {
  const size_t count = static_cast<size_t>(result.members);
  const size_t stride = count <= kMostValues ? 1 : stride_of_dots(result);
  std::vector<long> index = every(count, stride);
  for (const auto& [member, motion] : motions) {
    const auto at = std::ranges::lower_bound(index, member);
    if (at == index.end() || *at != member) index.insert(at, member);
  }
  Members out;
  out.count = result.members;
  if (stride > 1) out.index = index;
  out.command =
      fmt::format("hamel ensemble {} --member {{}} -o FOLDER", quoted(result.config.origin));
  out.paragraphs = {
      "A click on a member in a figure, or Enter where the arrow keys have found it, shows its "
      "values and its command line, which writes its values, its configuration and a page with "
      "its motion. Row k of ensemble.csv and of each data set of ensemble.h5 is member k, from 0."};
  if (stride > 1)
    out.paragraphs.push_back(
        fmt::format("This page has the values of {} of the {} members: each {}.", index.size(),
                    count, ordinal(stride)));
  for (const TableColumn& column : result.table.columns) {
    const bool varied = column.meaning.starts_with("varied");
    if (!varied && std::ranges::find(result.kept, column.name) == result.kept.end()) continue;
    out.columns.push_back(
        {column.name, unit_of(column), varied, chosen(std::get<Numbers>(column.values), index)});
  }
  if (!result.config.classes.names.empty()) {
    Members::Column& one = out.columns.emplace_back(
        Members::Column{"class", "", false, {}, result.config.classes.names});
    for (const long k : index) {
      const long long c =
          std::get<Indices>(result.table.column("class").values)[static_cast<size_t>(k)];
      one.values.push_back(c < 0 ? std::numeric_limits<double>::quiet_NaN()
                                 : static_cast<double>(c));
    }
  }
  for (const MemberFailure& failure : result.failures)
    if (std::ranges::binary_search(index, failure.member))
      out.failures[failure.member] = failure.reason;
  for (const auto& [member, motion] : motions) out.motions[member] = &motion;
  page.members(out);
}

void add_scatter_matrix(Page& page, const EnsembleResult& result) {
  std::vector<std::string> names, more, constant;
  for (const std::string& name : result.kept) {
    const Moments& m = result.moments.at(name);
    const bool varies = m.count > 1 && m.least < m.most;
    (!varies ? constant : names.size() < kMostColumns ? names : more).push_back(name);
  }
  if (names.size() < 2) return;
  const size_t count = static_cast<size_t>(result.members), stride = stride_of_dots(result);
  ScatterMatrix out;
  out.title = "What is kept, in pairs";
  const bool classes = !result.config.classes.names.empty();
  if (classes) out.classes = result.config.classes.names;
  const std::vector<bool> failed = failed_members(result);
  for (const long k : every(count, stride)) {
    if (failed[static_cast<size_t>(k)]) continue;
    const long long c =
        classes ? std::get<Indices>(result.table.column("class").values)[static_cast<size_t>(k)]
                : 0;
    if (c < 0) continue;
    out.members.push_back(k);
    if (classes) out.class_of.push_back(static_cast<long>(c));
  }
  for (const std::string& name : names) {
    const Numbers& values = numbers_of(result, name);
    ScatterMatrix::Column& column = out.columns.emplace_back(ScatterMatrix::Column{
        name, unit_of(result.table.column(name)), chosen(values, out.members)});
    for (const std::string& other : names)
      column.correlation.push_back(correlation(values, numbers_of(result, other)));
  }
  out.note = sampled(stride);
  const auto add = [&](const std::string& text) {
    out.note += (out.note.empty() ? "" : " ") + text;
  };
  add(fmt::format("Above the diagonal: Pearson's correlation over all members{}.",
                  result.failures.empty() ? "" : " that have not failed"));
  if (!more.empty()) add(fmt::format("Left out: {}.", fmt::join(more, ", ")));
  if (!constant.empty())
    add(fmt::format("The same in all members: {}.", fmt::join(constant, ", ")));
  page.section("Kept quantities in pairs");
  page.scatter(out);
}

}  // namespace hamel::tools
