// A run as plain data: what the builder fills, the command line overrides, and a file keeps.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/mechanics/system.hpp>

namespace hamel {

struct Config {
  std::string system;
  Parameters parameters;
  Start start;
  std::string scheme = "lift";
  double s = 0.5;  // in [0, 1]
  std::string retraction = "cayley";
  std::string solver = "newton";
  double tolerance = 1e-13;         // on |F| / scale
  std::string on_failure = "stop";  // a failed step: stop, halve, or retry:<solver>
  std::string compose = "none";
  double step = 0.01;  // h, seconds, of either sign
  double until = 20;   // seconds, of the sign of step
  long every = 1;      // record every this many steps

  /// The number of whole steps: until / step rounded down, up to round-off.
  long steps() const;
  /// As TOML; reads back to an equal Config.
  std::string to_toml() const;
  /// Keys as on the command line. Throws ConfigError with line and column, or the nearest key.
  static Config from_toml(const std::string& text, const std::string& origin = "config");
  /// Everything wrong with the numbers themselves (names are the registry's business).
  std::vector<std::string> mistakes() const;
};

/// Reads a file with from_toml; ConfigError when it cannot be read.
Config read_config(const std::string& path);

}  // namespace hamel
