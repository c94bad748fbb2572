// Systems for a page: what there is, their texts, their parameters and inputs with ranges.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel::playground {

using Json = nlohmann::ordered_json;

/// [{name, summary, mechanism}] of all registered systems.
Json list_of_systems();

/// The text with which the page shows a registered system: a mechanism's own file, of others the
/// configuration of a run with every parameter. ConfigError with the nearest name where there is
/// none.
std::string text_of_system(const std::string& name);

/// [{name, unit, meaning, default, expected}] of the options of a run, with the names that those of
/// a scheme, a retraction and a composition may have.
Json list_of_options();

/// Parameters and inputs with units, meanings and ranges; speed: whether --speed is defined.
Json description_of(const SystemModel& model);

}  // namespace hamel::playground
