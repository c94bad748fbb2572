// Definitions that the sources of a study's verdicts share.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/figures/study_view.hpp>
#include <hamel/framework/pages/study_page.hpp>

namespace hamel::pages {

using figures::kShortOfClaim;
using figures::StudyView;

/// Adds comparisons of methods: the best at equal error, orders against
/// claims, which value of an axis is worse.
void compare_methods(const StudyView& view, std::vector<Verdict>& out);

/// "1 cell", "3 cells".
std::string plural(size_t count, const char* noun);

}  // namespace hamel::pages
