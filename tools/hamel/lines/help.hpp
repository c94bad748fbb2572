// How --help looks: at most 100 columns, options in groups.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace hamel::tools {

/// The lines of a text, broken behind spaces and commas where it is longer; a longer word stays
/// whole.
std::vector<std::string> wrapped(const std::string& text, size_t width);

/// --verbose, of a command that prints notes.
void add_verbose(CLI::App& app, bool& verbose);

/// For an app and its subcommands.
void set_help(CLI::App& app);

/// Puts these options, where the app has them, under a title; titles appear in the order of the
/// options.
void group_options(CLI::App& app, const std::string& title, const std::vector<std::string>& names);

}  // namespace hamel::tools
