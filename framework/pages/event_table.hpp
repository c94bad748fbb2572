// Tables of a run's events on its page: states before and behind them, and what strikes and
// friction take.
#pragma once

#include <hamel/framework/pages/page.hpp>
#include <hamel/framework/run/record/result.hpp>

namespace hamel {
class Registry;
}

namespace hamel::pages {

/// The events, one a row: their velocities, "before -> behind" where an event changes them, and the
/// kinetic energy that it takes, J; of contacts, the sums of strikes and of friction up to the last
/// recorded state. Nothing where there are none.
void add_events(Page& page, const Registry& registry, const Result& r);

}  // namespace hamel::pages
