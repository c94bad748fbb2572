// Events of a state by formulas. Not installed.
//
//   "x^2 + y^2 = radius^2"   where both sides are equal, in either direction
//   "theta > 1.5"            where the left one becomes larger;  "theta < 1.5", smaller
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/io/expression.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {

/// The value of a formula over t, the coordinates and the velocity, in this order.
inline auto value_of_state(Expression formula) {
  return [formula = std::move(formula), values = std::vector<double>()](
             double t, std::span<const double> g, std::span<const double> xi) mutable {
    values.assign(1, t);
    values.insert(values.end(), g.begin(), g.end());
    values.insert(values.end(), xi.begin(), xi.end());
    return formula(values);
  };
}

/// The event of a text with =, < or > between two formulas of t, the system's coordinates and
/// velocities (quantity_names.hpp), and its parameters (those of several numbers with the number
/// behind: inertia1). None where the text has no such sign, or where something is wrong with
/// it, which goes to mistakes.
std::optional<Event> event_of_formula(const SystemModel& system, const std::string& text,
                                      std::vector<std::string>& mistakes);

}  // namespace hamel
