// hamel ensemble: all members of a file, or a part of them, with a journal from which an
// interrupted one resumes.
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/ensemble/ensemble.hpp>
#include <hamel/framework/figures/figures.hpp>
#include <hamel/framework/io/note_lines.hpp>
#include <hamel/framework/pages/ensemble_page.hpp>
#include <hamel/framework/pages/run_page.hpp>
#include <hamel/systems/by_name.hpp>

#include "batch_command.hpp"
#include "commands.hpp"
#include "words/interrupt.hpp"
#include "words/screen.hpp"

namespace hamel::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// "skew = 0.3, start.omega3 = -1": what a member is varied by.
std::string varied_of(const EnsembleResult& result, long member) {
  std::string out;
  for (const TableColumn& column : result.table.columns)
    if (column.meaning.starts_with("varied"))
      out += fmt::format(
          "{}{} = {:.6g}", out.empty() ? "" : ", ", column.name,
          std::get<std::vector<double>>(column.values)[static_cast<size_t>(member - result.first)]);
  return out;
}

std::string summary(const EnsembleResult& result, Notes length) {
  std::string out = fmt::format("{}: {} members", result.config.run.system, result.members);
  if (result.resumed > 0) out += fmt::format(", {} were there", result.resumed);
  out += fmt::format("\n  failed                 {}\n", result.failures.size());
  constexpr size_t most = 5;
  for (size_t i = 0; i < std::min(result.failures.size(), most); ++i)
    out += fmt::format("    member {}: {} (t = {:.6g}; {})\n", result.failures[i].member,
                       result.failures[i].reason, result.failures[i].time,
                       varied_of(result, result.failures[i].member));
  if (result.failures.size() > most)
    out += fmt::format("    and {} more, in ensemble.json\n", result.failures.size() - most);
  size_t width = 22;
  for (const std::string& name : result.kept) width = std::max(width, name.size());
  for (const std::string& name : result.kept) {
    const Moments& m = result.moments.at(name);
    if (m.count == 0) {
      out += fmt::format("  {:<{}} no member has it\n", name, width);
      continue;
    }
    out += fmt::format("  {:<{}} mean {:.6g}, deviation {:.3g}, {:.6g} to {:.6g}", name, width,
                       m.mean, m.deviation(), m.least, m.most);
    if (m.count != result.members) out += fmt::format(", of {} members", m.count);
    out += '\n';
  }
  for (size_t i = 0; i < result.class_counts.size(); ++i)
    out +=
        fmt::format("  {:<{}} {}\n", result.config.classes.names[i], width, result.class_counts[i]);
  out += note_lines(result.notes, 25, length);
  return out + fmt::format("  time                   {:.2f} s on {} thread{}\n", result.seconds,
                           result.threads, result.threads == 1 ? "" : "s");
}

// The members that the file names as runs: their configurations and rows.
void write_trajectories(const Ensemble& ensemble, const std::string& folder) {
  for (const long k : ensemble.config().trajectories) {
    const Member member = ensemble.member(k);
    if (member.config.system.empty()) continue;  // it does not start: the table has the reason
    const std::string stem = (fs::path(folder) / fmt::format("member-{}", k)).string();
    write_file(stem + ".toml", member.config.to_toml());
    const std::string rows = stem + (hdf5_version().empty() ? ".csv" : ".h5");
    // Left by one that was interrupted here: this run writes them anew.
    std::error_code error;
    if (!locked(part_of(rows))) fs::remove(part_of(rows), error);
    pages::run_of(ensemble, member, &stop_when_asked(), rows);
  }
}

// Shows one member, as values and as a run with its page.
int one_member(const EnsembleOptions& options, const Ensemble& ensemble) {
  const Member member = ensemble.member(*options.member);
  std::string page;
  const bool is_run = !member.config.system.empty() && ensemble.config().feedback.inputs.empty();
  if (!options.directory.empty() && !is_run)
    complain("hamel: no page: {}\n",
             member.failed ? "this member does not start" : "a run has no feedback by formulas");
  if (!options.directory.empty() && is_run) {
    fs::create_directories(options.directory);
    const fs::path stem = fs::path(options.directory) / fmt::format("member-{}", member.index);
    write_file(stem.string() + ".toml", member.config.to_toml());
    if (!pages::report_page().empty()) {
      page = stem.string() + ".html";
      RunOptions running;
      running.config = member.config;
      running.report = page;
      running.quiet = true;
      run(running);
    }
  }
  const auto number = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
  Json out = {{"member", member.index}, {"failed", member.failed}};
  out["reason"] = member.failed ? Json(member.failure.reason) : Json(nullptr);
  out["values"] = out["kept"] = Json::object();
  for (const auto& [name, value] : member.varied) out["values"][name] = number(value);
  for (const auto& [name, value] : member.kept) out["kept"][name] = number(value);
  if (options.json) {
    say("{}\n", out.dump(2, ' ', false, Json::error_handler_t::replace));
  } else if (!options.quiet) {
    std::string text = fmt::format("member {}\n", member.index);
    for (const auto& [name, value] : member.varied)
      text += fmt::format("  {:<22} {:.10g}\n", name, value);
    if (member.failed)
      text += fmt::format("  failed                 {} (t = {:.6g})\n", member.failure.reason,
                          member.failure.time);
    for (const auto& [name, value] : member.kept)
      if (!member.failed) text += fmt::format("  {:<22} {:.10g}\n", name, value);
    if (!page.empty()) text += fmt::format("  page                   {}\n", page);
    say("{}", text);
  }
  return member.failed ? 1 : 0;
}

}  // namespace

int ensemble(const EnsembleOptions& options) {
  Ensemble ensemble(registry(), read_ensemble(options.file, registry()));
  ensemble.stop(&stop_when_asked());
  if (options.member) return one_member(options, ensemble);
  const BatchCommand command(options, "ensemble");
  return command.run(
      ensemble,
      [&](const EnsembleResult& result) {
        return command.show(
            result,
            {.files = fmt::format("{}ensemble.csv, ensemble.json",
                                  hdf5_version().empty() ? "" : "ensemble.h5, "),
             .write =
                 [&] {
                   result.write(command.folder());
                   write_trajectories(ensemble, command.folder());
                 },
             .page = [&] { return pages::ensemble_page(registry(), result, &stop_when_asked()); },
             .record = [&] { return result.record(); },
             .summary = [&] { return summary(result, Notes{options.verbose}); }});
      },
      [](const EnsembleResult& result) {
        return fmt::format("{} of {} members are finished", result.done, result.members);
      });
}

}  // namespace hamel::tools
