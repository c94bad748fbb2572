// hamel study: all cells of a study file, with a journal from which an interrupted study resumes.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/io/note_lines.hpp>
#include <hamel/framework/pages/study_page.hpp>
#include <hamel/framework/run/record/result.hpp>
#include <hamel/systems/by_name.hpp>

#include "batch_command.hpp"
#include "commands.hpp"
#include "words/screen.hpp"

namespace hamel::tools {

using pages::Cell;
using pages::study_page;
using pages::study_verdicts;
using pages::Verdict;
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

std::string summary(const StudyResult& result, Notes length) {
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
  out += note_lines(result.notes, 25, length);
  for (const Verdict& verdict : study_verdicts(result))
    out += fmt::format("  [{}] {}\n{}", verdict.status, plain(verdict.text), table_of(verdict));
  return out + fmt::format("  time                   {:.1f} s on {} thread{}\n", result.seconds,
                           result.threads, result.threads == 1 ? "" : "s");
}

}  // namespace

int study(const PartOptions& options) {
  const BatchCommand command(options, "study");
  Study study(registry(), read_study(options.file, registry()));
  if (!options.merge) announce(study, command.folder(), command.options().quiet);
  return command.run(
      study,
      [&](const StudyResult& result) {
        return command.show(result,
                            {.files = fmt::format("cells.csv, {}record.json",
                                                  hdf5_version().empty() ? "" : "cells.h5, "),
                             .write = [&] { result.write(command.folder()); },
                             .page = [&] { return study_page(result); },
                             .record = [&] { return result.record(); },
                             .summary =  // verdicts are of the whole
                             [&] {
                               if (result.shard.count > 1) return std::string();
                               return summary(result, Notes{options.verbose});
                             }});
      },
      [](const StudyResult& result) {
        size_t done = 0, all = 0;
        for (size_t i = 0; i < result.cells.size(); ++i) {
          all += result.runs(i);
          done += result.runs(i) && result.metrics[i].done;
        }
        return fmt::format("{} of {} cells are measured", done, all);
      });
}

}  // namespace hamel::tools
