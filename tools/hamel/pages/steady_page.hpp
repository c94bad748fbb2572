// The page of steady motions along a parameter, and their texts.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/analysis/steady.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/pages/page.hpp>

namespace hamel::tools {

using pages::Cell;
using pages::Page;

/// A number with the decimals that are known of it.
std::string known_text(double x, double round_off);
/// Numbers of a start as an option has them, without the round-off of the largest.
std::string start_text(const std::vector<double>& values);
/// How many modes grow, or that the errors of the eigenvalues cover it.
std::string stability_text(const SteadyMotion& motion);
/// "steer.rate 1.00, w1 0.31".
std::string modes_text(const std::vector<ModePart>& parts);
/// "4.29238253634, a pair of complex eigenvalues crosses the imaginary axis (Hopf)".
std::string crossing_text(const SteadyCrossing& crossing);
/// "the branch ends at p = 0: it turns back (fold) and continues".
std::string end_text(const std::string& name, const SteadySweep& sweep, bool towards_last);

/// Prints both ends of a branch.
void print_ends(const std::string& name, const SteadySweep& sweep);

/// Prints where the branch begins that crosses this one.
void print_other(const std::string& name, const SteadyPlace& place);

/// Eigenvalues along a parameter; command: the line that it is from.
Page steady_page(const SystemModel& system, const SteadySweep& sweep, const std::string& command);

}  // namespace hamel::tools
