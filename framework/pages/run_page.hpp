// The page of one run.
#pragma once

#include <string>

#include <hamel/framework/pages/page.hpp>
#include <hamel/framework/run/record/result.hpp>

namespace hamel {
class Registry;
}

namespace hamel::pages {

/// So many rows of a run are kept for its page at most.
constexpr size_t kRowsOfPage = 100'000;

/// Verdict, motion, physics, accuracy, and the record; events and inputs where the record has them.
Page run_page(const Registry& registry, const Result& result, const std::string& record);

}  // namespace hamel::pages
