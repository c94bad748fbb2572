// Definitions that the sources of a study's verdicts share.
#pragma once

#include <string>
#include <vector>

#include "study_page.hpp"
#include "study_view.hpp"

namespace hamel::tools {

/// Adds comparisons of methods: the best at equal error, orders against
/// claims, which value of an axis is worse.
void compare_methods(const StudyView& view, std::vector<Verdict>& out);

/// "1 cell", "3 cells".
std::string plural(size_t count, const char* noun);

}  // namespace hamel::tools
