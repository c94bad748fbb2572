// What an analysis says, in words.
#pragma once

#include <string>

#include <hamel/framework/analysis/analysis.hpp>

namespace hamel::tools {

/// Is it nonholonomic? In a sentence.
std::string verdict(const Analysis& a);

}  // namespace hamel::tools
