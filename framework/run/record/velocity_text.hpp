// A body velocity as a line of text. Not installed.
#pragma once

#include <span>
#include <string>

#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {

/// "omega = 0.25, v1 = 1": by names, to six digits, but to none below round-off of the largest or
/// `unknown`.
std::string velocity_in_words(const SystemModel& system, std::span<const double> xi,
                              double unknown = 0);

}  // namespace hamel
