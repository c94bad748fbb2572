// hamel study: all cells of a study file, with a journal that an interrupted study goes on from.
#include <filesystem>

#include <fmt/format.h>

#include <hamel/framework/run/record/result.hpp>
#include <hamel/systems/by_name.hpp>

#include "commands.hpp"
#include "interrupt.hpp"
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

// A study of many cells says so, since it may take long.
void announce(const Study& study, const std::string& folder, bool quiet) {
  constexpr long kMany = 1000;
  long cells = 0;
  double steps = 0;
  for (const StudyCell& cell : study.cells()) {
    if (!cell.runs()) continue;
    ++cells;
    steps += static_cast<double>(expected_steps(cell.config)) * (1 + study.config().repeats);
  }
  if (quiet || cells < kMany) return;
  complain(
      "hamel: {} cells, {:.1e} steps in all; each is kept in {} when it is finished, and "
      "the same command goes on from there\n",
      cells, steps, folder);
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
    out += fmt::format("  [{}] {}\n", verdict.status, plain(verdict.text));
  return out + fmt::format("  time                   {:.1f} s on {} thread{}\n", result.seconds,
                           result.threads, result.threads == 1 ? "" : "s");
}

}  // namespace

int study(const StudyOptions& options) {
  namespace fs = std::filesystem;
  const std::string folder = options.directory.empty()
                                 ? fs::path(options.file).stem().string() + "-study"
                                 : options.directory;
  Study study(registry(), read_study(options.file, registry()));
  study.threads(options.threads).folder(folder).fresh(options.fresh).stop(&stop_when_asked());
  announce(study, folder, options.quiet);
  StudyResult result;
  {
    Progress progress("study", options.quiet);
    result = study.progress([&](double fraction) { progress(fraction); }).run();
  }
  if (!result.complete) {
    size_t done = 0, all = 0;
    for (size_t i = 0; i < result.cells.size(); ++i) {
      all += result.cells[i].runs();
      done += result.metrics[i].done;
    }
    complain(
        "hamel: interrupted: {} of {} cells are measured and kept in {}; the same command "
        "goes on from there\n",
        done, all, folder);
    return 1;
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

}  // namespace hamel::tools
