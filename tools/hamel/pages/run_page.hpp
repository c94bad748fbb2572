// The page of one run.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/run/record/result.hpp>

#include "pages/page.hpp"

namespace hamel::tools {

/// So many rows of a run are kept for its page at most.
constexpr size_t kRowsOfPage = 100'000;

/// Verdict, motion, physics, accuracy, and the record; events and inputs where the record has them.
Page run_page(const Result& result, const std::string& record);

/// Mistakes of the file of a page or of a figure, before anything runs.
std::vector<std::string> page_mistakes(const std::string& path,
                                       const std::vector<std::string>& formats = {".html"});

}  // namespace hamel::tools
