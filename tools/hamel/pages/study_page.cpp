#include "pages/study_page.hpp"

#include <fmt/format.h>

#include <hamel/framework/figures/figures.hpp>

#include "pages/study_tables.hpp"

namespace hamel::tools {

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
  page.section("Verdict");
  const std::vector<Verdict> verdicts = study_verdicts(result);
  for (const Verdict& verdict : verdicts) page.verdict(verdict.status, sentence(verdict.text));
  // Figures before long tables, which fill a phone.
  const std::vector<Figure> figures = figures::of_study(result);
  page.add_section(figures, "Work and precision");
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
  page.add_section(figures, "Growth");
  page.add_section(figures, "Heat maps");
  add_cells(page, view);
  add_skipped(page, result);
  page.section("Record");
  page.record(result.record());
  return page;
}

}  // namespace hamel::tools
