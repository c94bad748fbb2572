// The page of one run.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/run/record/result.hpp>

#include "page.hpp"

namespace hamel::tools {

/// So many rows of a run are kept for its page at most.
constexpr size_t kRowsOfPage = 100'000;

/// Verdict, motion, physics, accuracy, and the record; events and inputs where the record has them.
Page run_page(const Result& result, const std::string& record);

/// Mistakes of the file of a page or of a figure, before anything runs.
std::vector<std::string> page_mistakes(const std::string& path,
                                       const std::vector<std::string>& formats = {".html"});

/// Column of a run against time, thinned; as magnitude, for a logarithmic axis, the largest over
/// windows.
Series curve(const Result& result, const std::string& name, const std::string& column,
             bool magnitude = true);

/// Description of the windows; "" where every recorded state is shown. Where the run has more
/// rows than are at hand this is stated, and the largest of all of each of these columns, as far
/// as a run measures it.
std::string windows_note(const Result& result, const std::vector<std::string>& columns);

/// Round-off in coordinates as large as those of this run.
double round_off(const Result& result);

/// Round-off of an error, a column of the run.
double floor_of(const Result& result, const std::string& column);

}  // namespace hamel::tools
