// Mistakes of a configuration. Failures of a step are values instead (framework/loop/status.hpp).
//
//   ConfigError  the requested run is impossible: thrown before anything runs, all mistakes at once
//   Status       a numerical failure of a step: a value, never an exception
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <hamel/framework/io/built_with.hpp>
#include <hamel/framework/io/export.hpp>

namespace hamel {

/// Every mistake found in a configuration; what() is one line per mistake.
class HAMEL_API ConfigError : public std::invalid_argument {
 public:
  explicit ConfigError(std::vector<std::string> mistakes);
  const std::vector<std::string>& mistakes() const { return mistakes_; }

 private:
  std::vector<std::string> mistakes_;
};

/// "unknown scheme 'lfit': expected one of balance, boxed, lift; did you mean 'lift'?"
HAMEL_API std::string unknown_name(const std::string& kind, const std::string& value,
                                   const std::vector<std::string>& known);

/// The beginning of a text that is too long for a message.
HAMEL_API std::string shortened(const std::string& text);

/// Comma-separated, in the shortest form that reads back to the same double.
HAMEL_API std::string join(std::span<const double> values);
HAMEL_API std::string join(const std::vector<std::string>& words);

}  // namespace hamel
