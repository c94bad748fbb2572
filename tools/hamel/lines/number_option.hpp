// Options that take a number, read as read_text reads it: CLI11 takes 1e-400 for 0.
#pragma once

#include <functional>
#include <string>
#include <type_traits>

#include <CLI/CLI.hpp>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/run/names/config.hpp>

namespace hamel::tools {

/// Value: double, optional double or long.
template <class Value>
CLI::Option* number_option(CLI::App& app, const std::string& flag,
                           const std::function<void(const Value&)>& give, const std::string& help) {
  const auto read = [flag, give](const std::string& text) {
    Value value{};
    try {
      read_text(flag, text, value);
    } catch (const ConfigError& error) {
      throw CLI::ValidationError(error.what());
    }
    give(value);
  };
  return app.add_option_function<std::string>(flag, read, help)
      ->type_name(std::is_same_v<Value, long> ? "INT" : "FLOAT");
}

/// Defines it for a variable that outlives the app.
template <class Value>
CLI::Option* number_option(CLI::App& app, const std::string& flag, Value& out,
                           const std::string& help) {
  return number_option<Value>(
      app, flag, [&out](const Value& value) { out = value; }, help);
}

}  // namespace hamel::tools
