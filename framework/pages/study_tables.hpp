// The tables of a study's page.
#pragma once

#include <hamel/framework/figures/study_view.hpp>
#include <hamel/framework/pages/page.hpp>

namespace hamel::pages {

using figures::kUnused;
using figures::StudyView;

/// The references of the cells of each system.
void add_references(Page& page, const StudyResult& result);

/// The measured order of each method against its claim.
void add_orders(Page& page, const StudyView& view);

/// Every cell that was run, without the columns that are equal in all rows.
void add_cells(Page& page, const StudyView& view);

/// The combinations that were not run and why, one row for all steps of a kind.
void add_skipped(Page& page, const StudyResult& result);

}  // namespace hamel::pages
