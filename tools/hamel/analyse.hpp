// The text of an analysis.
#pragma once

#include <string>

#include <hamel/framework/analysis/analysis.hpp>

namespace hamel::tools {

/// Is it nonholonomic? In a sentence. undecided: its end, where the analysis could have looked
/// deeper.
std::string verdict(const Analysis& a, const char* undecided = "stopped there");

}  // namespace hamel::tools
