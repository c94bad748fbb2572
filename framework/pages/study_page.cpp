#include <hamel/framework/pages/study_page.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <hamel/framework/figures/figures.hpp>
#include <hamel/framework/pages/study_tables.hpp>

namespace hamel::pages {

namespace {

// The text of a verdict whose table stands elsewhere.
std::string sentence(std::string text) {
  if (text.ends_with(':')) text.back() = '.';
  return text;
}

}  // namespace

Page study_page(const StudyResult& result) {
  const StudyView view(result);
  Page page(result.config.title,
            fmt::format("{} cells to t = {} s; times are medians of {} rounds on {} thread{}",
                        view.run().size(), result.config.until, result.config.repeats,
                        result.threads, result.threads == 1 ? "" : "s"));
  // Figures before notes and long tables, which fill a phone: cells and failures alone come first.
  const std::vector<Verdict> verdicts = study_verdicts(result);
  const auto leads = [&](const Verdict& v) {
    return &v == verdicts.data() || v.status == "failed";
  };
  const auto add = [&](bool leading) {
    for (const Verdict& verdict : verdicts)
      if (leads(verdict) == leading) page.verdict(verdict.status, sentence(verdict.text));
  };
  page.section("Verdict");
  add(true);
  const std::vector<Figure> figures = figures::of_study(result);
  page.add_section(figures, "Work and precision");
  page.add_section(figures, "Growth");
  if (!result.config.reference || !std::ranges::all_of(verdicts, leads)) page.section("Notes");
  add(false);
  if (result.config.reference) page.section("What is compared");
  for (const Verdict& verdict : verdicts)
    if (!verdict.rows.empty())
      page.table("By " + verdict.columns.front(), verdict.columns, verdict.rows,
                 sentence(verdict.text));
  add_references(page, result);
  if (result.config.reference) {  // else no errors, and so no orders
    page.section("Orders");
    page.add(figures, "Orders");
    add_orders(page, view);
  }
  page.add_section(figures, "Heat maps");
  add_cells(page, view);
  add_skipped(page, result);
  page.section("Record");
  page.record(result.record());
  return page;
}

}  // namespace hamel::pages
