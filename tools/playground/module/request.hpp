// A request of the page, and the answer to it.
#pragma once

#include <exception>
#include <string>

#include <nlohmann/json.hpp>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/run/run/simulation.hpp>

namespace hamel::playground {

using Json = nlohmann::ordered_json;

/// The run of {"text", "origin", "options": {name: text}, "parameters": {name: number or list},
/// "inputs": {name: number}}. The text is the configuration of a run where it has the key `system`,
/// else a system by data or a mechanism; what stands beside it goes first. ConfigError with every
/// mistake of the text, file, line and column.
Simulation simulation_of(const Json& request);

/// The text, which lives until the next answer.
const char* answered(const Json& answer);

/// The answer f(request); {"ok": false, "mistakes": [...]} where it throws.
template <class F>
const char* answer(const char* request, F&& f) {
  try {
    return answered(f(Json::parse(request)));
  } catch (const ConfigError& error) {
    return answered({{"ok", false}, {"mistakes", error.mistakes()}});
  } catch (const std::exception& error) {
    return answered({{"ok", false}, {"mistakes", Json::array({error.what()})}});
  }
}

}  // namespace hamel::playground
