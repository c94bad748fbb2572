// The page of a study, and what its data say in words.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/study/study.hpp>

#include "page.hpp"

namespace hamel::tools {

struct Verdict {
  std::string status;  // ok, failed or note
  std::string text;
};

/// Failures and where they lie, the best at equal error, orders against claims, which value of an
/// axis is worse and by how much: sentences computed from the cells.
std::vector<Verdict> study_verdicts(const StudyResult& result);

/// Verdicts, work-precision diagrams, order plots, heat maps over s and h, the table of all cells.
Page study_page(const StudyResult& result);

}  // namespace hamel::tools
