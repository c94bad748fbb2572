// How the time of a step grows with a parameter of a system: studies whose systems differ in one
// number.
#pragma once

#include "page.hpp"
#include "study_view.hpp"

namespace hamel::tools {

/// Time per step against the parameter in which at least three systems of one name differ, and in
/// nothing else of their parameters. Adds nothing when there are none.
void add_growth(Page& page, const StudyView& view);

}  // namespace hamel::tools
