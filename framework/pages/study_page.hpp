// The page of a study, and its verdicts.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/pages/page.hpp>
#include <hamel/framework/study/study.hpp>

namespace hamel::pages {

/// A sentence, and the numbers that it rests on as a table.
struct Verdict {
  std::string status;  // ok, failed or note
  std::string text;
  std::vector<std::string> columns = {};
  std::vector<std::vector<Cell>> rows = {};
};

/// Failures and where they lie, the best at equal error, orders against claims, which value of an
/// axis is worse and by how much: sentences computed from the cells.
std::vector<Verdict> study_verdicts(const StudyResult& result);

/// Verdicts, work-precision diagrams, order plots, heat maps over s and h, the table of all cells.
Page study_page(const StudyResult& result);

}  // namespace hamel::pages
