#include <hamel/framework/pages/ensemble_page.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <hamel/framework/figures/curves.hpp>
#include <hamel/framework/figures/ensemble_dots.hpp>
#include <hamel/framework/figures/figures.hpp>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/pages/run_page.hpp>
#include <hamel/framework/run/run/simulation.hpp>

namespace hamel::pages {
namespace {

constexpr size_t kMostValues = 10'000;  // members with their values on the page
constexpr size_t kMostMotions = 6;      // on a page, where the file names members
constexpr size_t kMostClasses = 4;      // of which one member moves, where it names none

using Indices = std::vector<long long>;

// The word as a shell reads it.
std::string quoted(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_./+-,:@%").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!word.empty() && std::ranges::all_of(word, plain)) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

void add_members(Page& page, const EnsembleResult& result, const std::map<long, Page>& motions) {
  const size_t count = static_cast<size_t>(result.members);
  const size_t stride = count <= kMostValues ? 1 : figures::stride_of_dots(result);
  std::vector<long> index = figures::every(count, stride);
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
                    count, figures::ordinal(stride)));
  for (const TableColumn& column : result.table.columns) {
    const bool varied = column.meaning.starts_with("varied");
    if (!varied && std::ranges::find(result.kept, column.name) == result.kept.end()) continue;
    out.columns.push_back({column.name, figures::unit_of(result, column.name), varied,
                           figures::chosen(figures::numbers_of(result, column.name), index)});
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

void add_kept(Page& page, const EnsembleResult& result) {
  std::vector<std::string> columns = {"kept", "members", "mean", "deviation", "least", "most"};
  for (const double part : result.config.quantiles)
    columns.push_back(fmt::format("{:g} %", 100 * part));
  std::vector<std::vector<Cell>> rows;
  for (const std::string& name : result.kept) {
    const Moments& m = result.moments.at(name);
    std::vector<Cell>& row = rows.emplace_back(
        std::vector<Cell>{Cell(figures::with_unit(name, figures::unit_of(result, name))),
                          Cell(static_cast<double>(m.count)), Cell(m.mean), Cell(m.deviation()),
                          Cell(m.least), Cell(m.most)});
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

void add_failures(Page& page, const EnsembleResult& result) {
  if (result.failures.empty()) return;
  constexpr size_t most = 100;
  std::vector<std::vector<Cell>> rows;
  for (size_t i = 0; i < std::min(most, result.failures.size()); ++i)
    rows.push_back({Cell(static_cast<double>(result.failures[i].member)),
                    Cell(result.failures[i].time), Cell(result.failures[i].reason)});
  page.table("Failed members", {"member", "time [s]", "reason"}, rows,
             result.failures.size() > most ? "The first 100." : "");
}

// The members whose motion is on the page: those named in the file, else the first of each class,
// or of all, that has not failed.
std::vector<long> members_in_motion(const EnsembleResult& result) {
  std::vector<long> out = result.config.trajectories;
  if (!result.config.feedback.inputs.empty()) return {};
  if (!out.empty()) {
    out.resize(std::min(out.size(), kMostMotions));
    return out;
  }
  const std::vector<bool> failed = figures::failed_members(result);
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

std::map<long, Page> motions_of(const Registry& registry, const EnsembleResult& result,
                                const std::atomic<bool>* stop) {
  std::map<long, Page> out;
  const std::vector<long> moving = members_in_motion(result);
  if (moving.empty()) return out;
  const Ensemble ensemble(registry, result.config);
  for (const long k : moving) {
    const std::optional<Result> one = run_of(ensemble, ensemble.member(k), stop);
    if (!one || !one->status.ok) continue;
    Page page(fmt::format("Member {}", k), "");
    page.add_section(figures::motion_of_run(registry, *one), "Motion");
    if (!page.figures().empty()) out.emplace(k, std::move(page));
  }
  return out;
}

}  // namespace

std::optional<Result> run_of(const Ensemble& ensemble, const Member& member,
                             const std::atomic<bool>* stop, const std::string& output) {
  if (member.config.system.empty()) return std::nullopt;
  Simulation simulation = ensemble.simulation(member);
  simulation.keep_rows(kRowsOfPage);
  if (!output.empty()) simulation.record_to(output);
  simulation.progress([stop](double) {
    if (stop != nullptr && *stop) throw Unfinished("interrupted");
  });
  return simulation.run();
}

Page ensemble_page(const Registry& registry, const EnsembleResult& result,
                   const std::atomic<bool>* stop) {
  const std::map<long, Page> motions = motions_of(registry, result, stop);
  const std::string file = result.config.origin;
  Page page(result.config.run.system, fmt::format("{} members of {}", result.members, file));
  page.section("Members");
  page.verdict(
      result.failures.empty() ? "ok" : "note",
      fmt::format("{} of {} members have values.",
                  result.members - static_cast<long>(result.failures.size()), result.members));
  const std::vector<Figure> figures = figures::of_ensemble(result);
  // The first figures before long tables, which fill a phone.
  std::vector<std::string> sections = {"What is kept over what is varied",
                                       "Kept quantities in pairs", "Distributions",
                                       "Mean and deviation in time"};
  std::erase_if(sections, [&figures](const std::string& section) {
    return std::ranges::count(figures, section, &Figure::section) == 0;
  });
  if (!sections.empty()) page.add_section(figures, sections.front());
  page.section("Values");
  add_members(page, result, motions);
  add_kept(page, result);
  add_failures(page, result);
  for (size_t i = 1; i < sections.size(); ++i) page.add_section(figures, sections[i]);
  return page;
}

}  // namespace hamel::pages
