// hamel study: all cells of a study file, with a journal from which an interrupted study resumes.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include <hamel/framework/batch/shards.hpp>
#include <hamel/framework/run/record/result.hpp>
#include <hamel/systems/by_name.hpp>

#include "commands.hpp"
#include "interrupt.hpp"
#include "ranks.hpp"
#include "screen.hpp"
#include "study_page.hpp"

namespace hamel::tools {
namespace {

// Without the marks of Markdown, which the page understands.
std::string plain(const std::string& text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '`') continue;
    if (text.compare(i, 2, "**") == 0) ++i;
    else out += text[i];
  }
  return out;
}

// A study of many cells states their number, since it may take long.
void announce(const Study& study, const std::string& folder, bool quiet) {
  constexpr long kMany = 1000;
  long cells = 0;
  double steps = 0;
  for (const StudyCell& cell : study.cells()) {
    if (!cell.runs()) continue;
    ++cells;
    steps += static_cast<double>(expected_steps(cell.config())) * (1 + study.config().repeats);
  }
  if (quiet || cells < kMany) return;
  complain(
      "hamel: {} cells, {:.1e} steps in all; each is kept in {} when it is finished, and "
      "the same command resumes there\n",
      cells, steps, folder);
}

constexpr size_t kRowsOnScreen = 20;  // of a table on the screen; the page has all

// The table under a verdict, its columns as wide as they need.
std::string table_of(const Verdict& verdict) {
  const auto text = [](const Cell& cell) {
    if (!cell.is_number) return cell.text;
    return std::isfinite(cell.number) ? fmt::format("{:.3g}", cell.number) : "-";
  };
  std::vector<size_t> widths;
  for (size_t k = 0; k < verdict.columns.size(); ++k) {
    widths.push_back(verdict.columns[k].size());
    for (const auto& row : verdict.rows) widths[k] = std::max(widths[k], text(row[k]).size());
  }
  std::string out;
  const auto add = [&](size_t k, const std::string& word) {
    const bool last = k + 1 == widths.size();
    out += (k == 0 ? "    " : "  ") + (last ? word : fmt::format("{:<{}}", word, widths[k]));
    if (last) out += '\n';
  };
  if (verdict.rows.empty()) return out;
  for (size_t k = 0; k < widths.size(); ++k) add(k, verdict.columns[k]);
  const size_t shown = std::min(verdict.rows.size(), kRowsOnScreen);
  for (size_t i = 0; i < shown; ++i)
    for (size_t k = 0; k < widths.size(); ++k) add(k, text(verdict.rows[i][k]));
  if (verdict.rows.size() > shown)
    out += fmt::format("    and {} more, on the page\n", verdict.rows.size() - shown);
  return out;
}

std::string summary(const StudyResult& result) {
  std::map<std::string, int> counts;
  const Table table = result.table();
  for (size_t i = 0; i < table.rows(); ++i) ++counts[table.column("status").text(i)];
  std::string out = result.config.title + "\n";
  std::string words;
  for (const auto& [status, count] : counts)
    words += fmt::format("{}{} {}", words.empty() ? "" : ", ", count, status);
  out += fmt::format("  cells                  {}{}\n", words,
                     result.resumed > 0 ? fmt::format("; {} were there", result.resumed) : "");
  for (size_t i = 0; i < result.references.size(); ++i) {
    const StudyReference& reference = result.references[i];
    if (reference.times.empty() || !result.config.reference) continue;
    out += fmt::format("  reference              {}: {}", result.config.systems[i].label,
                       reference.kind);
    if (reference.bound >= 0) out += fmt::format(", its error at most {:.1e}", reference.bound);
    out += '\n';
  }
  for (const std::string& note : result.notes)
    out += fmt::format("  note                   {}\n", note);
  for (const Verdict& verdict : study_verdicts(result))
    out += fmt::format("  [{}] {}\n{}", verdict.status, plain(verdict.text), table_of(verdict));
  return out + fmt::format("  time                   {:.1f} s on {} thread{}\n", result.seconds,
                           result.threads, result.threads == 1 ? "" : "s");
}

int finish(const StudyOptions& options, const std::string& folder, const StudyResult& result) {
  namespace fs = std::filesystem;
  if (result.shard.count > 1) {
    if (!options.quiet)
      say("  kept in                {}/: --merge joins the {} shards when all are there\n", folder,
          result.shard.count);
    return 0;
  }
  result.write(folder);
  if (report_page().empty()) {
    complain("hamel: no report.html: this program was built without node and npm\n");
  } else {
    study_page(result).write((fs::path(folder) / "report.html").string());
  }
  if (options.json) say("{}\n", result.record());
  else if (!options.quiet)
    say("{}  written to             {}/: cells.csv, {}record.json{}\n", summary(result), folder,
        hdf5_version().empty() ? "" : "cells.h5, ", report_page().empty() ? "" : ", report.html");
  return 0;
}

}  // namespace

int study(const StudyOptions& given) {
  namespace fs = std::filesystem;
  StudyOptions options = given;
  const std::string folder = options.directory.empty()
                                 ? fs::path(options.file).stem().string() + "-study"
                                 : options.directory;
  const std::optional<Rank> rank = take_part_as_rank(options);
  Study study(registry(), read_study(options.file, registry()));
  study.threads(options.threads).folder(folder).fresh(options.fresh).stop(&stop_when_asked());
  const auto merge = [&] {
    const MergeLock alone(folder, stop_when_asked());
    return finish(options, folder, study.merge());
  };
  if (options.merge) return merge();
  if (!options.shard.empty()) study.shard(shard_of(options.shard));
  announce(study, folder, options.quiet);
  StudyResult result;
  {
    Progress progress("study", options.quiet);
    result = study.progress([&](double fraction) { progress(fraction); }).run();
  }
  if (!result.complete) {
    size_t done = 0, all = 0;
    for (size_t i = 0; i < result.cells.size(); ++i) {
      all += result.runs(i);
      done += result.runs(i) && result.metrics[i].done;
    }
    complain(
        "hamel: interrupted: {} of {} cells are measured and kept in {}; the same command "
        "resumes there\n",
        done, all, folder);
    return 1;
  }
  if (!rank) return finish(options, folder, result);
  if (rank->index > 0) return 0;
  return merge_when_there(folder, merge);
}

}  // namespace hamel::tools
