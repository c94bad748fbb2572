// The laws of contacts that slide, open and strike, measured along a run:
//   hamel::check_contacts(hamel::simulate(MySystem{}).slip().until(2))
// with the modes of the run, and rows and gaps of the system's own mechanics, at every node.
//
//   open    phi >= 0,  l = 0
//   rolls   phi = 0,   A_t xi - b_t = 0,     |l_t| <= mu l_n  (mu: static_friction where larger)
//   slides  phi = 0,   |s| l_t = -mu l_n s,  s = A_t xi - b_t
// with the load in place of l_n where there is no gap; the power of friction, l_t . s, is never
// positive, and the balance of energy holds. Gaps relative to the way of the contact, slips to its
// speed, reactions to the largest of the run. Bounds: 1e-9, as of a run at rtol 1e-10, which is
// that of the check where the run has none of its own.
#pragma once

#include <hamel/framework/check/laws.hpp>
#include <hamel/framework/run/run/simulation.hpp>

namespace hamel {

/// ConfigError where the run cannot be built. A run that fails has one law, which names the reason.
LawReport check_contacts(const Simulation& simulation);

}  // namespace hamel
